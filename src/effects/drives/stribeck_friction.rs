//! Friction between rod and cylinder that is larger near rest.

use crate::effects::kind::defaults;
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Load, Mechanism, Situation};
use nalgebra::Vector3;
use std::sync::Arc;

const fn speed(name: &'static str, about: &'static str, least: f64, default: f64) -> Parameter {
    Parameter { name, unit: "m/s", about, bounds: [least, 1.0], step: 1e-3, default: Some(default) }
}

pub(in crate::effects) const KIND: Kind = Kind {
    name: "stribeck-friction",
    summary: "friction between rod and cylinder that is larger near rest than in motion: stick-slip",
    equation: "force on the rod -([F_c + (F_s - F_c) exp(-(v/v_s)^2)] tanh(v/v_0) + F_v v), v the rod's speed",
    source: "Stribeck; Bo and Pavelescu, Wear 82 (1982) 277-289; Armstrong-Helouvry, Dupont, Canudas de \
             Wit, Automatica 30 (1994) 1083-1138",
    trace: "the force of one actuator: with the direction of its own motion, most where it turns round",
    targets: Targets::Joint(JointKinds::Prismatic),
    parameters: &[
        Parameter::size("coulomb_N", "N", "friction F_c in motion", 1e4, 0.05),
        Parameter {
            name: "static_N",
            unit: "N",
            about: "friction F_s near rest; where not given, coulomb_N",
            bounds: [0.0, 1e4],
            step: 0.05,
            default: None,
        },
        Parameter::size("viscous_Ns_m", "N s/m", "viscous friction F_v", 1e5, 0.2),
        speed(
            "stribeck_m_s",
            "speed v_s over which F_s falls to F_c: a tenth of working speeds",
            // Below the default of v_0 nothing falls, and steps grow short.
            1e-3,
            0.02,
        ),
        speed(
            "velocity_m_s",
            "speed v_0 at which friction is near its full value: slow against v_s",
            1e-5,
            1e-3,
        ),
    ],
    variants: &[
        &["coulomb_N", "static_N", "stribeck_m_s"],
        &["coulomb_N", "static_N", "stribeck_m_s", "viscous_Ns_m"],
    ],
    neutral: defaults,
    // A fall over the slowest tenth of the motion, and over most of it.
    starts: |_, setting| {
        [0.01, 0.1]
            .map(|fall| {
                let value = |(name, _): (&str, f64)| match name {
                    "coulomb_N" => 0.1,
                    "static_N" => 0.2,
                    "stribeck_m_s" => fall,
                    _ => 0.0,
                };
                setting.values().map(value).collect()
            })
            .into()
    },
    scan: None,
    apply,
};

/// The friction of one prismatic joint.
#[derive(Debug)]
struct StribeckFriction {
    joint: usize,
    coulomb: f64,
    static_friction: f64,
    viscous: f64,
    stribeck: f64,
    velocity: f64,
}

impl Load for StribeckFriction {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let [_, rate] = at.length(self.joint);
        let near_rest = (-(rate / self.stribeck).powi(2)).exp();
        let dry = self.coulomb + (self.static_friction - self.coulomb) * near_rest;
        let force = -dry * (rate / self.velocity).tanh() - self.viscous * rate;
        at.push_rod(self.joint, force, wrenches);
    }

    fn longest_step(&self, mechanism: &Mechanism) -> Option<f64> {
        let steepest = self.coulomb.max(self.static_friction) / self.velocity + self.viscous;
        mechanism.rod_damper_step(self.joint, steepest)
    }

    /// Steep around rest: as of actuator friction, and what Stribeck's curve adds at most.
    fn longest_step_at(&self, at: Situation) -> Option<f64> {
        let [_, rate] = at.length(self.joint);
        let near = (rate.abs() / self.velocity - 1.0).max(0.0);
        let most = self.coulomb.max(self.static_friction);
        let falling = (self.static_friction - self.coulomb).abs() / self.stribeck;
        let slope = most / self.velocity / near.cosh().powi(2) + falling + self.viscous;
        at.mechanism.rod_damper_step(self.joint, slope)
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let coulomb = setting.number("coulomb_N");
    for joint in setting.prismatics(mechanism)? {
        mechanism.loads.push(Arc::new(StribeckFriction {
            joint,
            coulomb,
            static_friction: setting.value("static_N").unwrap_or(coulomb),
            viscous: setting.number("viscous_Ns_m"),
            stribeck: setting.number("stribeck_m_s"),
            velocity: setting.number("velocity_m_s"),
        }));
    }
    Ok(())
}
