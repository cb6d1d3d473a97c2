//! A cable or hose that pulls at a body.

use crate::effects::kind::defaults;
use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
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
