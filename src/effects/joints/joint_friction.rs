//! Friction in any joint.

use crate::effects::kind::defaults;
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{JointIndex, Load, Mechanism, Situation};
use nalgebra::Vector3;
use std::sync::Arc;

/// Rates at which Coulomb friction is near its full value where none is given: slow against working speeds
/// of a slide (m/s), and of a pin some centimetres across that slides as slowly (rad/s).
const NEAR_REST: [f64; 2] = [1e-3, 1e-2];

/// Rates v_s in m/s or rad/s from which a search for it starts: dry metal to a slow film of grease, in steps
/// that least squares bridge.
const RATES: [f64; 4] = [3e-3, 1e-2, 3e-2, 1e-1];

pub(in crate::effects) const KIND: Kind = Kind {
    name: "joint-friction",
    summary: "friction in a joint, revolute or prismatic, driven or not, beside what its drive gives; it does \
              not ask for the joint's load (journal-friction does)",
    equation: "effort -(F_c tanh(v/v_s) + F_v v) on the slider or the journal's body, v the joint's rate",
    source: "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994) 1083-1138; tanh as a smooth sign",
    trace: "the effort of drives: with direction and speed of that joint; free swings die",
    targets: Targets::Joint(JointKinds::Any),
    parameters: &[
        Parameter::size("coulomb", "N or N m", "Coulomb friction F_c", 1e4, 1e-3),
        Parameter::size("viscous", "N s/m or N m s/rad", "viscous friction F_v", 1e5, 1e-4),
        Parameter {
            name: "velocity",
            unit: "m/s or rad/s",
            about: "rate v_s at which Coulomb friction is near its full value; where not given, 0.001 m/s or \
                    0.01 rad/s",
            // Steps through a steeper law grow short; a flatter one is viscous.
            bounds: [1e-5, 10.0],
            step: 2e-4,
            default: None,
        },
    ],
    variants: &[
        &["coulomb"],
        &["viscous"],
        &["coulomb", "viscous"],
        &["coulomb", "viscous", "velocity"],
    ],
    neutral: |mechanism, setting| {
        let mut values = defaults(mechanism, setting);
        // Any rate does where there is no friction; none is not one.
        if let Some(velocity) = values.get_mut(2) {
            *velocity = NEAR_REST[1];
        }
        values
    },
    starts: |_, setting| match setting.values().count() {
        3 => RATES.map(|velocity| vec![1e-3, 0.0, velocity]).to_vec(),
        _ => Vec::new(),
    },
    scan: None,
    apply,
};

/// The friction of one joint.
#[derive(Debug)]
struct JointFriction {
    joint: JointIndex,
    coulomb: f64,
    viscous: f64,
    velocity: f64,
}

impl Load for JointFriction {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let [_, rate] = at.coordinate(self.joint, 0.0);
        let effort = -self.coulomb * (rate / self.velocity).tanh() - self.viscous * rate;
        at.push_joint(self.joint, effort, wrenches);
    }

    fn longest_step(&self, mechanism: &Mechanism) -> Option<f64> {
        mechanism.joint_damper_step(self.joint, self.coulomb / self.velocity + self.viscous)
    }

    /// Steep around rest only: `dF/dq̇ = F_c/v_s sech²(q̇/v_s) + F_v`, taken v_s nearer to rest, which a
    /// step may bring.
    fn longest_step_at(&self, at: Situation) -> Option<f64> {
        let [_, rate] = at.coordinate(self.joint, 0.0);
        let near = (rate.abs() / self.velocity - 1.0).max(0.0);
        let slope = self.coulomb / self.velocity / near.cosh().powi(2) + self.viscous;
        at.mechanism.joint_damper_step(self.joint, slope)
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let [coulomb, viscous] = ["coulomb", "viscous"].map(|name| setting.number(name));
    for joint in setting.joints(mechanism)? {
        let [linear, angular] = NEAR_REST;
        let slow = if matches!(joint, JointIndex::Prismatic(_)) { linear } else { angular };
        let velocity = setting.value("velocity").unwrap_or(slow);
        mechanism.loads.push(Arc::new(JointFriction { joint, coulomb, viscous, velocity }));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{WHEEL_AND_SLIDE, ended};

    /// Dry friction takes the same rate in equal times, viscous friction the same share.
    #[test]
    fn dry_friction_slows_a_wheel_and_a_slide_linearly_and_viscous_friction_by_shares() {
        // Inertia 0.02 kg m², mass 2 kg; 5 rad/s, 0.5 m/s; 0.1 s.
        let effect = |joint: &str, keys: &str| {
            format!("[[effect]]\nkind = \"joint-friction\"\njoint = \"{joint}\"\n{keys}\n")
        };
        let dry = effect("O", "coulomb = 0.3") + &effect("S", "coulomb = 4.0");
        let [wheel, slide] = ended(&format!("{WHEEL_AND_SLIDE}{dry}"), 0.1);
        assert!((wheel.twist.z - (5.0 - 0.3 / 0.02 * 0.1)).abs() < 1e-6, "{}", wheel.twist.z);
        assert!((slide.twist.x - (0.5 - 4.0 / 2.0 * 0.1)).abs() < 1e-6, "{}", slide.twist.x);
        let viscous = effect("O", "viscous = 0.1") + &effect("S", "viscous = 7.0");
        let [wheel, slide] = ended(&format!("{WHEEL_AND_SLIDE}{viscous}"), 0.1);
        assert!((wheel.twist.z - 5.0 * (-0.1f64 / 0.02 * 0.1).exp()).abs() < 1e-6);
        assert!((slide.twist.x - 0.5 * (-7.0f64 / 2.0 * 0.1).exp()).abs() < 1e-6);
    }

    /// One cause in two joints is one effect.
    #[test]
    fn a_list_of_joints_has_the_friction_in_each() {
        let both = "[[effect]]\nkind = \"joint-friction\"\njoint = [\"O\", \"S\"]\ncoulomb = 0.3\n";
        let [wheel, slide] = ended(&format!("{WHEEL_AND_SLIDE}{both}"), 0.1);
        assert!((wheel.twist.z - (5.0 - 0.3 / 0.02 * 0.1)).abs() < 1e-6, "{}", wheel.twist.z);
        assert!((slide.twist.x - (0.5 - 0.3 / 2.0 * 0.1)).abs() < 1e-6, "{}", slide.twist.x);
    }
}
