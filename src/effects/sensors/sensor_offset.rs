//! An encoder with a wrong zero.

use crate::effects::kind::{defaults, linear};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Mechanism, ReadingError};
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "sensor-offset",
    summary: "an encoder with a wrong zero",
    equation: "true length = read length + offset; encoder and servo see the read length",
    source: "definition",
    trace: "measured pose against measured lengths: the same at all lengths and times",
    targets: Targets::Joint(JointKinds::DrivenPrismatic),
    parameters: &[Parameter {
        name: "offset_m",
        unit: "m",
        about: "true length less read length",
        bounds: [-0.05, 0.05],
        step: 1e-5,
        default: Some(0.0),
    }],
    variants: &[&["offset_m"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

#[derive(Debug)]
struct Offset(f64);

impl ReadingError for Offset {
    fn at(&self, _read: f64) -> [f64; 3] {
        [self.0, 0.0, 0.0]
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    for index in setting.drives(mechanism)? {
        let error = Arc::new(Offset(setting.number("offset_m")));
        mechanism.actuators[index].reading_errors.push(error);
    }
    Ok(())
}
