//! A blow: a body is hit once.

use super::load_change::{at_s, component};
use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Setting, Targets, Wrong};
use crate::mechanism::{Axes, Load, Mark, Mechanism, Situation};
use nalgebra::{Vector2, Vector3};
use std::f64::consts::PI;
use std::sync::Arc;

/// How long a blow lasts in s: a hit by hand or by a soft hammer takes 2 to 10 ms. It is short against
/// motions of machines, so that the impulse alone counts, and long against the steps of a simulation.
const LASTS: f64 = 5e-3;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "impulse",
    summary: "a blow on a body (the output body, where none is named) at an instant, 5 ms long",
    equation: "force (ix, iy) and torque iphi times pi/(2 T) sin(pi (t - at)/T) at the body's centre of mass as \
               declared, from at to at + T, T = 5 ms",
    source: "half-sine pulse, IEC 60068-2-27",
    trace: "all columns: nothing before, a jump of the rates at one instant, what swings on after it",
    targets: Targets::Body,
    parameters: &[
        at_s("when it begins, from the first row of a recording on"),
        component("ix_Ns", "N s", "impulse along the world's x", 1e-4),
        component("iy_Ns", "N s", "impulse along the world's y", 1e-4),
        component("iphi_Nms", "N m s", "angular impulse", 1e-5),
    ],
    variants: &[
        &["at_s", "ix_Ns", "iy_Ns"],
        &["at_s", "iphi_Nms"],
        &["at_s", "ix_Ns", "iy_Ns", "iphi_Nms"],
    ],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

#[derive(Debug)]
struct Blow {
    at: f64,
    centre: Mark,
    impulse: Vector3<f64>,
}

impl Load for Blow {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let share = (at.t - self.at) / LASTS;
        if (0.0..=1.0).contains(&share) {
            let push = self.impulse * (PI / (2.0 * LASTS) * (PI * share).sin());
            at.push_point(self.centre, push.xy(), push.z, wrenches);
        }
    }

    /// A tenth of the pulse sees its shape.
    fn longest_step(&self, _: &Mechanism) -> Option<f64> {
        Some(LASTS / 10.0)
    }

    /// Up to the pulse, through it in small steps, then whatever else allows.
    fn longest_step_at(&self, at: Situation) -> Option<f64> {
        let until = self.at - at.t;
        (until > -LASTS).then(|| until.max(LASTS / 20.0))
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let (_, Axes { centre, .. }) = setting.body(mechanism)?;
    let [at, x, y, phi] = ["at_s", "ix_Ns", "iy_Ns", "iphi_Nms"].map(|name| setting.number(name));
    let impulse = Vector2::new(x, y).push(phi);
    mechanism.loads.push(Arc::new(Blow { at, centre, impulse }));
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{WHEEL_AND_SLIDE, ended};

    /// Inertia 0.02 kg m², mass 2 kg; 5 rad/s, 0.5 m/s before.
    #[test]
    fn a_blow_changes_rates_by_impulse_over_inertia() {
        let blow = |body: &str, keys: &str| {
            format!("[[effect]]\nkind = \"impulse\"\nbody = \"{body}\"\nat_s = 0.043\n{keys}\n")
        };
        let blows = blow("wheel", "iphi_Nms = 0.03") + &blow("slide", "ix_Ns = -0.4\niy_Ns = 3.0");
        let text = format!("{WHEEL_AND_SLIDE}{blows}");
        let [wheel, slide] = ended(&text, 0.04);
        assert!((wheel.twist.z - 5.0).abs() < 1e-9 && (slide.twist.x - 0.5).abs() < 1e-9);
        let [wheel, slide] = ended(&text, 0.1);
        assert!((wheel.twist.z - (5.0 + 0.03 / 0.02)).abs() < 1e-6, "{}", wheel.twist.z);
        assert!((slide.twist.x - (0.5 - 0.4 / 2.0)).abs() < 1e-6, "{}", slide.twist.x);
    }
}
