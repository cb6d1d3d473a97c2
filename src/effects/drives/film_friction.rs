//! Friction between rod and cylinder that builds up with speed.

use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Load, Mechanism, Situation};
use nalgebra::Vector3;
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "film-friction",
    summary: "friction between rod and cylinder that builds up with speed and then stays: the opposite of \
              a Stribeck fall",
    equation: "force on the rod -F sign(v) (1 - exp(-|v|/v_f)), v the rod's speed: viscous F/v_f near rest",
    source: "a smooth curve from nothing to F; measured on the drive of the EMPS recordings (freeplay study emps)",
    trace: "the force of one actuator: less than its dry friction says where its motion is slow",
    targets: Targets::Joint(JointKinds::Prismatic),
    parameters: &[
        Parameter::size("force_N", "N", "force F at speed", 1e4, 0.05),
        Parameter {
            name: "speed_m_s",
            unit: "m/s",
            about: "speed v_f at which it has 63 % of F: a tenth of working speeds",
            bounds: [1e-6, 10.0],
            step: 1e-3,
            default: Some(1e-2),
        },
    ],
    variants: &[],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

#[derive(Debug)]
struct FilmFriction {
    joint: usize,
    force: f64,
    speed: f64,
}

impl Load for FilmFriction {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let [_, rate] = at.length(self.joint);
        let built_up = -(-rate.abs() / self.speed).exp_m1();
        at.push_rod(self.joint, -self.force * built_up.copysign(rate), wrenches);
    }

    fn longest_step(&self, mechanism: &Mechanism) -> Option<f64> {
        mechanism.rod_damper_step(self.joint, self.force / self.speed)
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for joint in setting.prismatics(mechanism)? {
        mechanism.loads.push(Arc::new(FilmFriction {
            joint,
            force: setting.number("force_N"),
            speed: setting.number("speed_m_s"),
        }));
    }
    Ok(())
}
