//! Friction between rod and cylinder.

use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Load, Mechanism, Situation};
use nalgebra::Vector3;
use std::sync::Arc;

const fn coulomb(name: &'static str, about: &'static str, default: Option<f64>) -> Parameter {
    Parameter { name, unit: "N", about, bounds: [0.0, 1e4], step: 0.05, default }
}

const fn viscous(name: &'static str, about: &'static str, default: Option<f64>) -> Parameter {
    Parameter { name, unit: "N s/m", about, bounds: [0.0, 1e5], step: 0.2, default }
}

pub(in crate::effects) const KIND: Kind = Kind {
    name: "actuator-friction",
    summary: "friction between rod and cylinder, beside the drive's force",
    equation: "force on the rod -(F_c tanh(v/v_s) + F_v v) + offset, v the rod's speed; F_c and F_v \
               may differ between outward (v > 0) and inward motion",
    source: "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30 (1994) 1083-1138; tanh as a \
             smooth sign",
    trace: "the force of one actuator: with the direction and the speed of its own motion",
    targets: Targets::Joint(JointKinds::Prismatic),
    parameters: &[
        coulomb("coulomb_N", "Coulomb friction F_c in both directions", Some(0.0)),
        viscous("viscous_Ns_m", "viscous friction F_v in both directions", Some(0.0)),
        coulomb("coulomb_pos_N", "F_c outward; where not given, coulomb_N", None),
        coulomb("coulomb_neg_N", "F_c inward; where not given, coulomb_N", None),
        viscous("viscous_pos_Ns_m", "F_v outward; where not given, viscous_Ns_m", None),
        viscous("viscous_neg_Ns_m", "F_v inward; where not given, viscous_Ns_m", None),
        Parameter {
            name: "offset_N",
            unit: "N",
            about: "constant force on the rod",
            bounds: [-1e4, 1e4],
            step: 0.05,
            default: Some(0.0),
        },
        Parameter {
            name: "velocity_m_s",
            unit: "m/s",
            about: "speed v_s at which Coulomb friction is near its full value: slow against working speeds",
            // A film of oil gives way over more; steps through a steeper law grow short.
            bounds: [1e-4, 1.0],
            step: 2e-4,
            default: Some(1e-3),
        },
    ],
    variants: &[
        &["coulomb_N", "viscous_Ns_m"],
        &["offset_N"],
        &["coulomb_N", "viscous_Ns_m", "offset_N"],
        &["coulomb_pos_N", "coulomb_neg_N", "viscous_pos_Ns_m", "viscous_neg_Ns_m"],
        &["coulomb_pos_N", "coulomb_neg_N", "viscous_pos_Ns_m", "viscous_neg_Ns_m", "velocity_m_s"],
    ],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

/// The friction of one prismatic joint.
#[derive(Debug)]
struct RodFriction {
    joint: usize,
    /// F_c in N and F_v in N·s/m, inward and outward.
    inward: [f64; 2],
    outward: [f64; 2],
    offset: f64,
    velocity: f64,
}

impl Load for RodFriction {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let [_, rate] = at.length(self.joint);
        let [coulomb, viscous] = if rate < 0.0 { self.inward } else { self.outward };
        let force = self.offset - coulomb * (rate / self.velocity).tanh() - viscous * rate;
        at.push_rod(self.joint, force, wrenches);
    }

    fn longest_step(&self, mechanism: &Mechanism) -> Option<f64> {
        let steepest = |[coulomb, viscous]: [f64; 2]| coulomb / self.velocity + viscous;
        mechanism.rod_damper_step(self.joint, steepest(self.inward).max(steepest(self.outward)))
    }

    /// Steep around rest only: `dF/dq̇ = F_c/v_s sech²(q̇/v_s) + F_v`, taken v_s nearer to rest, which a
    /// step may bring.
    fn longest_step_at(&self, at: Situation) -> Option<f64> {
        let [_, rate] = at.length(self.joint);
        let [coulomb, viscous] = if rate < 0.0 { self.inward } else { self.outward };
        let near = (rate.abs() / self.velocity - 1.0).max(0.0);
        let slope = coulomb / self.velocity / near.cosh().powi(2) + viscous;
        at.mechanism.rod_damper_step(self.joint, slope)
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let pair = |coulomb: &str, viscous: &str| {
        [
            setting.value(coulomb).unwrap_or(setting.number("coulomb_N")),
            setting.value(viscous).unwrap_or(setting.number("viscous_Ns_m")),
        ]
    };
    for joint in setting.prismatics(mechanism)? {
        mechanism.loads.push(Arc::new(RodFriction {
            joint,
            inward: pair("coulomb_neg_N", "viscous_neg_Ns_m"),
            outward: pair("coulomb_pos_N", "viscous_pos_Ns_m"),
            offset: setting.number("offset_N"),
            velocity: setting.number("velocity_m_s"),
        }));
    }
    Ok(())
}
