//! The 3-RPR as a [`Mechanism`].

use super::{Geometry, InverseKinematics, JOINTS};
use crate::mechanism::motion::PathPoint;
use crate::mechanism::{
    Actuator, Attachment, Bearing, Body, BodyState, Drive, JointIndex, Mechanism, Prismatic,
    Revolute,
};
use nalgebra::{Rotation2, UnitComplex, Vector2, Vector3};
use std::f64::consts::PI;
use std::sync::Arc;

/// The two bars of a leg: solid round bars, coaxial, centre of mass in the middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegBars {
    /// Density in kg/m³.
    pub density: f64,
    /// Length and diameter of the cylinder, which starts at the base joint, in m.
    pub cylinder: [f64; 2],
    /// Length and diameter of the rod, which ends at the platform joint, in m.
    pub rod: [f64; 2],
}

impl LegBars {
    /// Mass in kg and inertia about the middle in kg·m²: `m L²/12 + m r²/4`.
    fn inertia(&self, [length, diameter]: [f64; 2]) -> (f64, f64) {
        let radius = 0.5 * diameter;
        let mass = self.density * PI * radius * radius * length;
        (mass, mass * (length * length / 12.0 + radius * radius / 4.0))
    }
}

/// The six revolute joints, in the order of [`JOINTS`].
pub type JointSet = [Bearing; 6];

/// Builds the machine in the pose and motion of its commands at t = 0, journals centred.
///
/// `platform` is mass (kg) and inertia about C (kg·m²). The bodies are the cylinder and the rod of
/// each leg in turn, then the platform.
pub fn build(
    kinematics: InverseKinematics,
    platform: (f64, f64),
    bars: LegBars,
    joints: JointSet,
    drive: Drive,
    gravity: Vector2<f64>,
) -> Mechanism {
    let geometry = kinematics.geometry;
    let states = ideal_states(&geometry, &bars, &kinematics.motion.at(0.0));
    let inertias = [bars.inertia(bars.cylinder), bars.inertia(bars.rod)];
    let mut bodies = Vec::with_capacity(7);
    let mut prismatics: Vec<Prismatic> = Vec::with_capacity(3);
    let mut actuators = Vec::with_capacity(3);
    let half = [0.5 * bars.cylinder[0], 0.5 * bars.rod[0]];
    let at = |body, x| Attachment { body: Some(body), point: Vector2::new(x, 0.0) };
    for leg in 0..3 {
        for (part, name) in ["cylinder", "rod"].iter().enumerate() {
            let (mass, inertia) = inertias[part];
            let name = format!("{name} {}", leg + 1);
            bodies.push(Body::new(&name, mass, inertia, states[2 * leg + part]));
        }
        prismatics.push(Prismatic {
            name: format!("P{}", leg + 1),
            base: at(2 * leg, -half[0]),
            slider: at(2 * leg + 1, half[1]),
            axes: [UnitComplex::identity(); 2],
        });
        let joint = JointIndex::Prismatic(leg);
        actuators.push(Actuator::new(&prismatics[leg].name, joint, drive));
    }
    let (mass, inertia) = platform;
    let angle = kinematics.motion.at(0.0).pose.z;
    bodies.push(Body { angle, ..Body::new("platform", mass, inertia, states[6]) });
    let revolutes = joints
        .into_iter()
        .enumerate()
        .map(|(i, bearing)| {
            let leg = i % 3;
            let (ring, journal) = if i < 3 {
                (Attachment { body: None, point: geometry.anchor(leg) }, at(2 * leg, -half[0]))
            } else {
                let ring = Attachment { body: Some(6), point: geometry.corner(leg) };
                (ring, at(2 * leg + 1, half[1]))
            };
            Revolute { name: JOINTS[i].into(), ring, journal, bearing, out_of_round: None }
        })
        .collect();
    Mechanism {
        revolutes,
        prismatics,
        actuators,
        commands: Arc::new(kinematics),
        gravity,
        ..Mechanism::free(bodies)
    }
}

/// States of the seven bodies of the machine without clearance, at one point of a motion. With
/// u the leg's direction: the cylinder's centre stands at A + u L_c/2, the rod's at C − u L_r/2;
/// the leg turns at `(d × ḋ)/q²`.
pub fn ideal_states(geometry: &Geometry, bars: &LegBars, point: &PathPoint) -> Vec<BodyState> {
    let turned = |v: Vector2<f64>| Vector2::new(-v.y, v.x);
    let rotation = Rotation2::new(point.pose.z);
    let mut states = Vec::with_capacity(7);
    for leg in 0..3 {
        let arm = rotation * geometry.corner(leg);
        let d = geometry.leg(point.pose, leg);
        let end = point.pose.xy() + arm;
        let end_rate = point.rate.xy() + turned(arm) * point.rate.z;
        let u = d.normalize();
        let spin = d.perp(&end_rate) / d.norm_squared();
        let mut push = |position: Vector2<f64>, velocity: Vector2<f64>| {
            states.push(BodyState {
                position,
                rotation: UnitComplex::from_cos_sin_unchecked(u.x, u.y),
                twist: Vector3::new(velocity.x, velocity.y, spin),
            });
        };
        let (to_cylinder, to_rod) = (u * (0.5 * bars.cylinder[0]), u * (-0.5 * bars.rod[0]));
        push(geometry.anchor(leg) + to_cylinder, turned(to_cylinder) * spin);
        push(end + to_rod, end_rate + turned(to_rod) * spin);
    }
    states.push(BodyState {
        position: point.pose.xy(),
        rotation: UnitComplex::new(point.pose.z),
        twist: point.rate,
    });
    states
}
