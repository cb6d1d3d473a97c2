//! Viscous drag on a body.

use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Axes, Load, Mark, Mechanism, Situation};
use nalgebra::Vector3;
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "drag",
    summary: "viscous drag on a body: the platform, where none is named",
    equation: "force -c v at the body's centre of mass, torque -c_t omega",
    source: "linear drag",
    trace: "actuator forces: against the body's velocity, all actuators together",
    targets: Targets::Body,
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
struct ViscousDrag {
    centre: Mark,
    force: f64,
    torque: f64,
}

impl Load for ViscousDrag {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let twist = at.point(self.centre).twist;
        at.push_point(self.centre, -self.force * twist.xy(), -self.torque * twist.z, wrenches);
    }

    fn longest_step(&self, mechanism: &Mechanism) -> Option<f64> {
        let body = &mechanism.bodies[self.centre.body?];
        let rate = (self.force / body.mass).max(self.torque / body.inertia);
        (rate > 0.0).then(|| 1.0 / rate)
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let [force, torque] = ["force_Ns_m", "torque_Nms"].map(|name| setting.number(name));
    let (_, Axes { centre, .. }) = setting.body(mechanism)?;
    mechanism.loads.push(Arc::new(ViscousDrag { centre, force, torque }));
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{WHEEL_AND_SLIDE, ended};

    /// Inertia 0.02 kg m², mass 2 kg; 5 rad/s, 0.5 m/s before.
    #[test]
    fn each_body_is_slowed_by_its_own_drag() {
        let drag = |body: &str, keys: &str| {
            format!("[[effect]]\nkind = \"drag\"\nbody = \"{body}\"\n{keys}\n")
        };
        let drags = drag("wheel", "torque_Nms = 0.05") + &drag("slide", "force_Ns_m = 3.0");
        let [wheel, slide] = ended(&format!("{WHEEL_AND_SLIDE}{drags}"), 0.1);
        assert!((wheel.twist.z - 5.0 * (-0.05f64 / 0.02 * 0.1).exp()).abs() < 1e-6);
        assert!((slide.twist.x - 0.5 * (-3.0f64 / 2.0 * 0.1).exp()).abs() < 1e-6);
    }
}
