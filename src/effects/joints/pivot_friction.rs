//! Friction torque in a pivot.

use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Load, Mechanism, Situation};
use nalgebra::Vector3;
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "pivot-friction",
    summary: "a torque against the turning of a revolute joint that does not ask for its load: a preloaded \
              or sealed bearing; an arm that stops creeps on (bristle-friction: stays)",
    equation: "torque -(T_c tanh(w/w_s) + k w) between the two bodies, w the rate at which the joint turns",
    source: "Coulomb, with tanh as a smooth sign; viscous friction",
    trace: "free swings: the amplitude falls by the same angle each time (T_c) or by the same share (k)",
    targets: Targets::JointOrAll(JointKinds::Revolute),
    parameters: &[
        Parameter::size("coulomb_Nm", "N m", "dry friction torque T_c", 1e3, 1e-4),
        Parameter::size("viscous_Nms", "N m s", "viscous friction k", 1e3, 1e-5),
        Parameter {
            name: "velocity_rad_s",
            unit: "rad/s",
            about: "rate w_s at which dry friction is near its full value: an arm that stops creeps no \
                    faster",
            bounds: [1e-6, 10.0],
            step: 1e-3,
            default: Some(1e-3),
        },
    ],
    variants: &[],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

/// The friction of one revolute joint.
#[derive(Debug)]
struct PivotFriction {
    joint: usize,
    coulomb: f64,
    viscous: f64,
    velocity: f64,
}

impl Load for PivotFriction {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let rate = at.turning(self.joint);
        let torque = self.coulomb * (rate / self.velocity).tanh() + self.viscous * rate;
        at.push_turn(self.joint, -torque, wrenches);
    }

    /// A torque `c ω` on the inertia J that the lighter side has about the joint: `h ≤ J/c`.
    fn longest_step(&self, mechanism: &Mechanism) -> Option<f64> {
        let steepest = self.coulomb / self.velocity + self.viscous;
        let rate = steepest * mechanism.joint_lightness(self.joint);
        (rate > 0.0).then(|| 1.0 / rate)
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for joint in setting.revolutes(mechanism)? {
        mechanism.loads.push(Arc::new(PivotFriction {
            joint,
            coulomb: setting.number("coulomb_Nm"),
            viscous: setting.number("viscous_Nms"),
            velocity: setting.number("velocity_rad_s"),
        }));
    }
    Ok(())
}
