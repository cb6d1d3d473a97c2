//! A force or torque sensor with a wrong zero. Its test is that of the wrong scale.

use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Senses, Setting, Targets, Wrong};
use crate::mechanism::Mechanism;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "force-offset",
    summary: "a sensor of a drive's force or torque with a wrong zero",
    equation: "shows F + offset",
    source: "definition",
    trace: "that column: the same at all times; no other column has it",
    targets: Targets::Sensor(Senses::Effort),
    parameters: &[Parameter {
        name: "offset",
        unit: "N or N m",
        about: "what it shows less what is true",
        bounds: [-1e4, 1e4],
        step: 1e-3,
        default: Some(0.0),
    }],
    variants: &[&["offset"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for index in setting.sensors(mechanism)? {
        mechanism.sensors[index].offset += setting.number("offset");
    }
    Ok(())
}
