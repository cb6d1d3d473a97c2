//! An encoder with a wrong scale.

use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Mechanism, ReadingError};
use std::sync::Arc;

/// Length in m at which a scaled encoder reads right: near the middle of the stroke.
const RIGHT_AT: f64 = 0.32;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "actuator-scale",
    summary: "an encoder with a wrong scale",
    equation: "true length = read length + relative (read length - 0.32 m); encoder and servo see the read length",
    source: "definition",
    trace: "measured pose against measured lengths: with the length itself",
    targets: Targets::Joint(JointKinds::DrivenPrismatic),
    parameters: &[Parameter {
        name: "relative",
        unit: "",
        about: "relative error of the scale",
        bounds: [-0.2, 0.2],
        step: 1e-4,
        default: Some(0.0),
    }],
    variants: &[&["relative"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

#[derive(Debug)]
struct ActuatorScale {
    relative: f64,
}

impl ReadingError for ActuatorScale {
    fn at(&self, read: f64) -> [f64; 3] {
        [self.relative * (read - RIGHT_AT), self.relative, 0.0]
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for index in setting.drives(mechanism)? {
        let relative = setting.number("relative");
        mechanism.actuators[index].reading_errors.push(Arc::new(ActuatorScale { relative }));
    }
    Ok(())
}
