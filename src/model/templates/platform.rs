//! What the machines with a platform on three legs share.

use super::parts::{body, described, ground, plain_output};
use crate::model::motion;
use crate::scenario::{
    Body, Described, Joint, JointDrive, MotionTarget, Problem, Scenario, Sensor,
};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Corners in m of an equilateral triangle about the origin, at angles 7π/6 + 2π/3·i.
pub(super) fn triangle(side: f64) -> [[f64; 2]; 3] {
    [0.0, 1.0, 2.0].map(|i| {
        let angle = 7.0 * PI / 6.0 + 2.0 * PI / 3.0 * i;
        let radius = side / 3f64.sqrt();
        [angle.cos() * radius, angle.sin() * radius]
    })
}

/// A triangular platform where its motion begins.
pub(super) struct Platform {
    corners: [[f64; 2]; 3],
    pose: Vector3<f64>,
}

impl Platform {
    /// A platform of `side` m at the start of the scenario's motion.
    pub fn new(scenario: &Scenario, side: f64) -> Result<Self, Problem> {
        Ok(Self { corners: triangle(side), pose: motion::path(scenario)?.at(0.0).pose })
    }

    /// Where corner `leg` is in the world, in m.
    pub fn corner(&self, leg: usize) -> [f64; 2] {
        let ([x, y], (sin, cos)) = (self.corners[leg], self.pose.z.sin_cos());
        [self.pose.x + cos * x - sin * y, self.pose.y + sin * x + cos * y]
    }

    /// The body "platform" of a mass (kg) and an inertia (kg·m²), with its corners C1 C2 C3.
    pub fn body(&self, masses: (f64, f64)) -> Body {
        let named: Vec<_> = ["C1", "C2", "C3"].into_iter().zip(self.corners).collect();
        body("platform", masses, &named, self.pose.into())
    }
}

/// The scenario about a machine that moves its platform, its legs anchored at these points of the ground, with
/// its drives and the sensors that look at it.
pub(super) fn on_three_legs(
    scenario: &Scenario,
    anchors: [(&str, [f64; 2]); 3],
    bodies: Vec<Body>,
    joints: Vec<Joint>,
    (drives, sensors): (Vec<JointDrive>, Vec<Sensor>),
) -> Scenario {
    let ground = ground(&anchors);
    let outputs = plain_output("platform");
    let machine =
        Described { ground, bodies, joints, drives, outputs, sensors, ..Described::default() };
    let target = Some(MotionTarget::Body("platform".to_owned()));
    described(scenario, machine, scenario.motion.clone(), target)
}
