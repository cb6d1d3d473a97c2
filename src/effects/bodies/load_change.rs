//! A load that comes and stays: a weight that is put down on a body, a hose that catches.

use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Axes, Load, Mark, Mechanism, Situation};
use nalgebra::{Vector2, Vector3};
use std::sync::Arc;

/// Steps in s no shorter than this lead up to the instant: what a force that jumps does within one is far
/// below what any sensor sees.
const JUMP: f64 = 1e-5;

/// When an effect that does not last begins: within any recording.
pub(super) const fn at_s(about: &'static str) -> Parameter {
    Parameter {
        name: "at_s",
        unit: "s",
        about,
        bounds: [-1e4, 1e4],
        step: 1e-3,
        default: Some(0.0),
    }
}

/// A component of a push, of either sign.
pub(super) const fn component(
    name: &'static str,
    unit: &'static str,
    about: &'static str,
    step: f64,
) -> Parameter {
    Parameter { name, unit, about, bounds: [-1e4, 1e4], step, default: Some(0.0) }
}

pub(in crate::effects) const KIND: Kind = Kind {
    name: "load-change",
    summary: "a constant force and torque on a body (the output body, where none is named) from an instant on",
    equation: "force (fx, fy) and torque at the body's centre of mass as declared, from at on",
    source: "definition",
    trace: "efforts of drives, or accelerations: nothing before, a level more after",
    targets: Targets::Body,
    parameters: &[
        at_s("when it begins, from the first row of a recording on"),
        component("fx_N", "N", "force along the world's x", 1e-2),
        component("fy_N", "N", "force along the world's y", 1e-2),
        component("torque_Nm", "N m", "torque", 1e-3),
    ],
    variants: &[
        &["at_s", "fx_N", "fy_N"],
        &["at_s", "torque_Nm"],
        &["at_s", "fx_N", "fy_N", "torque_Nm"],
    ],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

#[derive(Debug)]
struct Push {
    from: f64,
    centre: Mark,
    force: Vector2<f64>,
    torque: f64,
}

impl Load for Push {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        if at.t >= self.from {
            at.push_point(self.centre, self.force, self.torque, wrenches);
        }
    }

    /// Steps lead up to the instant, so that none goes far beyond it with the force of before.
    fn longest_step_at(&self, at: Situation) -> Option<f64> {
        let until = self.from - at.t;
        (until > 0.0).then(|| until.max(JUMP))
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let (_, Axes { centre, .. }) = setting.body(mechanism)?;
    mechanism.loads.push(Arc::new(Push {
        from: setting.number("at_s"),
        centre,
        force: Vector2::new(setting.number("fx_N"), setting.number("fy_N")),
        torque: setting.number("torque_Nm"),
    }));
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{WHEEL_AND_SLIDE, ended};

    /// Inertia 0.02 kg m², mass 2 kg; 5 rad/s, 0.5 m/s before.
    #[test]
    fn a_load_accelerates_from_its_instant_on() {
        let load = |body: &str, keys: &str| {
            format!("[[effect]]\nkind = \"load-change\"\nbody = \"{body}\"\nat_s = 0.037\n{keys}\n")
        };
        let loads = load("wheel", "torque_Nm = 0.3") + &load("slide", "fx_N = -4.0");
        let [wheel, slide] = ended(&format!("{WHEEL_AND_SLIDE}{loads}"), 0.1);
        let (spin, speed) = (5.0 + 0.3 / 0.02 * 0.063, 0.5 - 4.0 / 2.0 * 0.063);
        // Half a step of 10 µs is left open.
        assert!((wheel.twist.z - spin).abs() < 1e-5 * 15.0, "{} {spin}", wheel.twist.z);
        assert!((slide.twist.x - speed).abs() < 1e-5 * 2.0, "{} {speed}", slide.twist.x);
    }
}
