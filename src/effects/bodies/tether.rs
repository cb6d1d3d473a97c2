//! A cable or hose that pulls at a body.

use crate::effects::kind::defaults;
use crate::effects::{FittedBy, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Axes, Load, Mark, Mechanism, Situation};
use nalgebra::{Vector2, Vector3};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Farthest anchor in m along an axis, and longest cable: what hangs in a hall.
const FAR: f64 = 15.0;

const fn anchor(name: &'static str, about: &'static str) -> Parameter {
    Parameter { name, unit: "m", about, bounds: [-FAR, FAR], step: 1e-3, default: Some(0.0) }
}

pub(in crate::effects) const KIND: Kind = Kind {
    name: "tether",
    summary: "a spring that only pulls, from a fixed anchor to the centre of mass of a body (the platform, where none \
              is named): a cable, a hose",
    equation: "k max(0, |a - C| - rest length) towards the anchor a, C the centre of mass as declared",
    source: "Hooke",
    trace: "actuator forces: a pull that grows with the distance from one point",
    targets: Targets::Body,
    parameters: &[
        Parameter::size("stiffness_N_m", "N/m", "stiffness k", 1e5, 0.2),
        anchor("anchor_x_m", "anchor along x"),
        anchor("anchor_y_m", "anchor along y"),
        Parameter::size("rest_length_m", "m", "length at which it does not pull yet", FAR, 1e-3),
    ],
    variants: &[&["stiffness_N_m", "anchor_x_m", "anchor_y_m", "rest_length_m"]],
    neutral: defaults,
    starts,
    scan: None,
    fitted_by: Some(FittedBy { numbers, values }),
    apply,
};

/// Anchors around the machine, near and far by its own size, taut and slack for a part of the motion.
fn starts(mechanism: &Mechanism, _: &Setting) -> Vec<Vec<f64>> {
    let bodies = &mechanism.bodies;
    let middle = bodies.iter().map(|body| body.start.position).sum::<Vector2<f64>>();
    let (middle, size) = (middle / bodies.len().max(1) as f64, mechanism.size());
    let ring = |share: f64| (0..8).map(move |k| (share * size, TAU * f64::from(k) / 8.0));
    let around = [0.25, 0.5, 1.25].into_iter().flat_map(ring);
    let slack = |(r, angle): (f64, f64)| {
        let anchor = middle + Vector2::new(angle.cos(), angle.sin()) * r;
        [0.5, 0.9, 1.0].map(|slack| vec![20.0, anchor.x, anchor.y, slack * r])
    };
    around.flat_map(slack).collect()
}

/// What pulls at a point that hardly moves: with how much force T, in which direction θ, by how much more for each metre along
/// that, k, and how sharply the direction turns, 1/d, with the anchor d away. Of a small motion δ the force is
/// T u + k (u·δ) u + T/d (1 − u uᵀ) δ towards the anchor: each number shows by itself, where another anchor and another length
/// make up for a stiffness almost entirely.
fn numbers(mechanism: &Mechanism, setting: &Setting) -> Option<Vec<[f64; 2]>> {
    let [stiffness, x, y, rest_length] =
        setting.values().map(|(_, value)| value).collect::<Vec<_>>()[..]
    else {
        return None;
    };
    let pull = Vector2::new(x, y) - middle(mechanism, setting)?;
    let length = pull.norm();
    let told = stiffness > 0.0 && length > 0.0;
    told.then(|| {
        let force = stiffness * (length - rest_length);
        vec![
            [force, SHARE * stiffness * length],
            [pull.y.atan2(pull.x), SHARE],
            [stiffness, SHARE * stiffness],
            [1.0 / length, SHARE / length],
        ]
    })
}

/// How far from a machine an anchor is looked for, in sizes of it: farther ones pull alike.
const REACH: f64 = 1.5;

/// Change of the numbers that a tether is fitted by, as a share of each, by which derivatives are taken: what bends is hardly bent over it.
const SHARE: f64 = 0.01;

/// The values of a tether that such numbers stand for; a rest length that would be less than nothing is none, with the anchor farther off.
fn values(mechanism: &Mechanism, setting: &Setting, numbers: &[f64]) -> Vec<f64> {
    let own = || setting.values().map(|(_, value)| value).collect();
    let (&[force, angle, stiffness, bend], Some(middle)) = (numbers, middle(mechanism, setting))
    else {
        return own();
    };
    let stiffness = stiffness.max(force / FAR).max(f64::MIN_POSITIVE);
    let stretched = force / stiffness;
    let length = (1.0 / bend.max(1.0 / (REACH * mechanism.size()))).max(stretched);
    let anchor = middle + Vector2::new(angle.cos(), angle.sin()) * length;
    let rest_length = (length - stretched).clamp(0.0, FAR);
    vec![stiffness.min(1e5), anchor.x.clamp(-FAR, FAR), anchor.y.clamp(-FAR, FAR), rest_length]
}

/// Where the body that it pulls at begins, in m.
fn middle(mechanism: &Mechanism, setting: &Setting) -> Option<Vector2<f64>> {
    let (body, Axes { centre, .. }) = setting.body(mechanism).ok()?;
    let start = &mechanism.bodies[body].start;
    let from = mechanism.bodies[body].reference + centre.point;
    Some(start.position + start.rotation * from)
}

#[derive(Debug)]
struct Tether {
    centre: Mark,
    stiffness: f64,
    anchor: Vector2<f64>,
    rest_length: f64,
}

impl Load for Tether {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let pull = self.anchor - at.point(self.centre).position;
        let length = pull.norm();
        if length > self.rest_length {
            let force = pull * (self.stiffness * (length - self.rest_length) / length);
            at.push_point(self.centre, force, 0.0, wrenches);
        }
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let anchor = Vector2::new(setting.number("anchor_x_m"), setting.number("anchor_y_m"));
    let (_, Axes { centre, .. }) = setting.body(mechanism)?;
    mechanism.loads.push(Arc::new(Tether {
        centre,
        stiffness: setting.number("stiffness_N_m"),
        anchor,
        rest_length: setting.number("rest_length_m"),
    }));
    Ok(())
}
