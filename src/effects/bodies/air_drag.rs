//! Drag of the air on a body.

use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Axes, Load, Mark, Mechanism, Situation};
use nalgebra::Vector3;
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "air-drag",
    summary: "drag that grows with the square of the speed, as of a body in air",
    equation: "force -c |v| v at the body's centre of mass, torque -c_t |w| w",
    source: "Batchelor, An Introduction to Fluid Dynamics (1967), section 5.11",
    trace: "forces against the body's velocity, in fast motion only; free swings: large ones die \
            down faster than by a constant share",
    targets: Targets::Body,
    parameters: &[
        Parameter::size("force_Ns2_m2", "N s^2/m^2", "coefficient c", 1e4, 1e-2),
        Parameter::size("torque_Nms2", "N m s^2", "coefficient c_t", 1e3, 1e-6),
    ],
    variants: &[],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

#[derive(Debug)]
struct AirDrag {
    centre: Mark,
    force: f64,
    torque: f64,
}

impl Load for AirDrag {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let twist = at.point(self.centre).twist;
        let (v, omega) = (twist.xy(), twist.z);
        at.push_point(
            self.centre,
            -self.force * v.norm() * v,
            -self.torque * omega.abs() * omega,
            wrenches,
        );
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let [force, torque] = ["force_Ns2_m2", "torque_Nms2"].map(|name| setting.number(name));
    let (_, Axes { centre, .. }) = setting.body(mechanism)?;
    mechanism.loads.push(Arc::new(AirDrag { centre, force, torque }));
    Ok(())
}
