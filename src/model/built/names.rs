//! The names of a description, and where they are in what was built of it.

use super::parts::Parts;
use super::shape;
use crate::mechanism::{
    Attachment, Axes, JointIndex, Mark, Mechanism, NamedPoint, Names, Reads, Use,
};
use crate::scenario::{self, Described, GROUND, Joint, MotionTarget, Scenario};
use nalgebra::Vector2;
use std::collections::BTreeMap;

/// The joint of that name.
pub(in crate::model) fn joint_named(mechanism: &Mechanism, name: &str) -> Option<JointIndex> {
    mechanism.joints().find(|(joint, _)| *joint == name).map(|(_, index)| index)
}

/// A point `body.point` that stays where it is in its body.
pub(super) fn mark(mechanism: &Mechanism, parts: &Parts, name: &str) -> Mark {
    steady(mechanism, parts.point(name).0)
}

/// The same point, given from the body's reference point.
fn steady(mechanism: &Mechanism, Attachment { body, point }: Attachment) -> Mark {
    let reference = body.map_or_else(Vector2::zeros, |i: usize| mechanism.bodies[i].reference);
    Mark { body, point: point - reference }
}

/// Names of a machine that was built but for these; `springs` are those between points, each with its
/// place among the loads.
pub(super) fn names(
    scenario: &Scenario,
    described: &Described,
    parts: &Parts,
    mechanism: &Mechanism,
    springs: &[(usize, [String; 2])],
) -> Names {
    let bodies = described.bodies.iter().map(|body| {
        let part = parts.part(&body.name);
        let at = |point| steady(mechanism, Attachment { body: part.body, point });
        let (_, _, centre) = shape::mass(body);
        let (origin, centre) = (at(part.origin), at(part.place(centre)));
        (body.name.clone(), Axes { origin, angle: part.angle, centre })
    });
    let of_bodies = described
        .bodies
        .iter()
        .flat_map(|body| body.points.keys().map(|point| format!("{}.{point}", body.name)));
    let of_ground = described.ground.points.keys().map(|point| format!("{GROUND}.{point}"));
    let mut points: BTreeMap<String, NamedPoint> = of_bodies
        .chain(of_ground)
        .map(|name| {
            let (attachment, angle) = parts.point(&name);
            let mark = steady(mechanism, attachment);
            (name, NamedPoint { mark, angle, uses: Vec::new() })
        })
        .collect();
    for (name, place) in uses(described, mechanism, springs) {
        if let Some(point) = points.get_mut(name) {
            point.uses.push(place);
        }
    }
    let main = match &scenario.target {
        Some(MotionTarget::Body(name) | MotionTarget::Point(name)) => Some(name.as_str()),
        None => described.outputs.first().map(scenario::Output::of),
    };
    let main = main.and_then(|name| name.split('.').next()).map(str::to_owned);
    let farthest = || mechanism.bodies.get(mechanism.output).map(|body| body.name.clone());
    Names { bodies: bodies.collect(), points, output: main.or_else(farthest) }
}

/// What is attached at which point.
fn uses<'a>(
    described: &'a Described,
    mechanism: &Mechanism,
    springs: &'a [(usize, [String; 2])],
) -> Vec<(&'a str, Use)> {
    let mut uses = Vec::new();
    for joint in &described.joints {
        let [(_, first), (_, second)] = joint.points();
        match (joint, joint_named(mechanism, joint.name())) {
            (Joint::Revolute(_), Some(JointIndex::Revolute(i))) => {
                uses.extend([(first, Use::Ring(i)), (second, Use::Journal(i))]);
            }
            (Joint::Prismatic(_), Some(JointIndex::Prismatic(i))) => {
                uses.extend([(first, Use::Base(i)), (second, Use::Slider(i))]);
            }
            _ => {}
        }
    }
    for (load, ends) in springs {
        let ends = ends.iter().enumerate();
        uses.extend(ends.map(|(end, name)| (name.as_str(), Use::Spring { load: *load, end })));
    }
    for (i, sensor) in mechanism.sensors.iter().enumerate() {
        let at_a_point =
            matches!(sensor.reads, Reads::X(_) | Reads::Y(_) | Reads::Acceleration(..));
        let described = described.sensors.iter().find(|s| s.column == sensor.column);
        let of = described.filter(|_| at_a_point).map(|sensor| sensor.of.as_str());
        uses.extend(of.map(|name| (name, Use::Sensor(i))));
    }
    uses
}
