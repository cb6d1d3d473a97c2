//! Servos whose gains are not the declared ones.

use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Drive, Mechanism};

const fn relative(name: &'static str, about: &'static str) -> Parameter {
    Parameter { name, unit: "", about, bounds: [-0.9, 9.0], step: 1e-3, default: Some(0.0) }
}

pub(in crate::effects) const KIND: Kind = Kind {
    name: "servo-gain",
    summary: "a servo stiffer or softer than declared; a prescribed drive has no gains and stays what it is",
    equation: "k_p = declared k_p (1 + stiffness_relative), k_d = declared k_d (1 + damping_relative)",
    source: "definition",
    trace: "measured forces against the servo's own law: with the error of the length, and with its rate",
    targets: Targets::JointOrAll(JointKinds::Driven),
    parameters: &[
        relative("stiffness_relative", "relative error of the stiffness k_p"),
        relative("damping_relative", "relative error of the damping k_d"),
    ],
    variants: &[&["stiffness_relative"], &["stiffness_relative", "damping_relative"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for index in setting.drives(mechanism)? {
        if let Drive::Servo { stiffness, damping } = &mut mechanism.actuators[index].drive {
            *stiffness *= 1.0 + setting.number("stiffness_relative");
            *damping *= 1.0 + setting.number("damping_relative");
        }
    }
    Ok(())
}
