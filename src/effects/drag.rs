//! Viscous drag on the platform.

use super::kind::{defaults, linear};
use super::{Joints, Kind, Parameter, Setting, Wrong};
use crate::mechanism::{Load, Mechanism, Situation};
use nalgebra::Vector3;
use std::sync::Arc;

pub(super) const KIND: Kind = Kind {
    name: "drag",
    summary: "viscous drag on the platform",
    equation: "force -c v at the platform's centre, torque -c_t omega",
    source: "linear drag",
    trace: "actuator forces: against the platform's velocity, all actuators together",
    joints: Joints::None,
    parameters: &[
        Parameter::size("force_Ns_m", "N s/m", "coefficient c", 1e4, 0.1),
        Parameter::size("torque_Nms", "N m s", "coefficient c_t", 1e3, 1e-3),
    ],
    variants: &[&["force_Ns_m", "torque_Nms"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

#[derive(Debug)]
struct Drag {
    force: f64,
    torque: f64,
}

impl Load for Drag {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let twist = at.mechanism.output_state(at.states).twist;
        at.push_output(-self.force * twist.xy(), -self.torque * twist.z, wrenches);
    }

    fn longest_step(&self, mechanism: &Mechanism) -> Option<f64> {
        let body = &mechanism.bodies[mechanism.output];
        let rate = (self.force / body.mass).max(self.torque / body.inertia);
        (rate > 0.0).then(|| 1.0 / rate)
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let [force, torque] = ["force_Ns_m", "torque_Nms"].map(|name| setting.number(name));
    mechanism.loads.push(Arc::new(Drag { force, torque }));
    Ok(())
}
