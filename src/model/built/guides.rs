//! Sliders with clearance: a block whose four corners hit two guides.

use super::material::material;
use crate::contact::laws::Given;
use crate::contact::{Clearance, RingShape, StiffnessForm, corner_stiffness};
use crate::mechanism::{Attachment, Bearing, Prismatic, Revolute};
use crate::scenario::{self, Scenario};
use nalgebra::Vector2;

/// Radius in m of a slider's corners where nothing is written: a broken edge.
const CORNER_RADIUS: f64 = 1e-3;

/// Whether a joint has clearance, and a law acts in it.
pub(super) fn has_play(scenario: &Scenario, joint: &scenario::Prismatic) -> bool {
    let law = joint.law.unwrap_or(scenario.contact.law);
    joint.play().is_some() && law.kind().is_some()
}

/// The corners of a slider, counterclockwise from the one behind and below as the axis points: each is a joint of its own,
/// with the guide that it can reach for a ring. They are called after the joint, with `.1` to `.4`.
pub(super) fn corners(
    scenario: &Scenario,
    joint: &scenario::Prismatic,
    built: &Prismatic,
) -> Vec<Revolute> {
    let law = joint.law.unwrap_or(scenario.contact.law);
    let (Some(gap), Some(kind)) = (joint.play(), law.kind()) else { return Vec::new() };
    let contact = &scenario.contact;
    let half =
        Vector2::new(joint.length.unwrap_or_default(), joint.height.unwrap_or_default()) * 0.5;
    let radius = joint.corner_radius.unwrap_or(CORNER_RADIUS);
    let material = material(scenario);
    let given = Given {
        bearing_radius: radius + gap,
        journal_radius: radius,
        material,
        stiffness_form: StiffnessForm::Printed,
        stiffness: joint
            .stiffness
            .or(contact.stiffness)
            .or_else(|| Some(corner_stiffness(material, radius))),
        exponent: contact.exponent,
        length: contact.length,
        restitution: joint.restitution.or(contact.restitution),
        damping: joint.damping.or(contact.damping),
        c_max: contact.c_max,
        d_max: contact.d_max,
        clip: contact.clip,
    };
    let law = (kind.build)(&given);
    let friction = joint.friction.filter(|friction| *friction > 0.0);
    let friction = friction.map(|friction| contact.friction(friction));
    let [base, slider] = built.axes;
    let sides = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let corner = |(i, (along, across)): (usize, (f64, f64))| {
        // From the middle of the guide that it can reach, which the gap begins short of.
        let guide = base * Vector2::new(0.0, across * half.y);
        let corner = slider * Vector2::new(along * half.x, across * half.y);
        Revolute {
            name: format!("{}.{}", joint.name, i + 1),
            ring: Attachment { body: built.base.body, point: built.base.point + guide },
            journal: Attachment { body: built.slider.body, point: built.slider.point + corner },
            bearing: Bearing::Clearance(Clearance {
                bearing_radius: given.bearing_radius,
                journal_radius: radius,
                law: law.clone(),
                friction,
            }),
            out_of_round: Some(RingShape::Guide(base * Vector2::new(0.0, across))),
        }
    };
    sides.into_iter().enumerate().map(corner).collect()
}
