//! A sensor of a joint with a wrong zero.

use super::encoder::give;
use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Senses, Setting, Targets, Wrong};
use crate::mechanism::{Mechanism, ReadingError};
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "encoder-zero",
    summary: "a sensor of a joint with a wrong zero; where a drive holds the joint it is the drive's encoder, \
              which the servo sees",
    equation: "reads q + offset",
    source: "definition",
    trace: "measured coordinates against each other: the same at all times",
    targets: Targets::Sensor(Senses::Zeroed),
    parameters: &[
        Parameter {
            name: "offset",
            unit: "m or rad",
            about: "what it reads less what is true",
            // More would be seen with the eye.
            bounds: [-0.5, 0.5],
            step: 1e-5,
            default: Some(0.0),
        },
        Parameter {
            name: "run_std",
            unit: "m or rad",
            about: "how much the zero differs from run to run, as where an operator sets it: predict finds that of a \
                run from its first seconds",
            bounds: [0.0, 0.5],
            step: 1e-5,
            default: Some(0.0),
        },
    ],
    variants: &[&["offset"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

#[derive(Debug)]
struct Zero(f64);

impl ReadingError for Zero {
    fn at(&self, _read: f64) -> [f64; 3] {
        [-self.0, 0.0, 0.0]
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let offset = setting.number("offset");
    let error: Arc<dyn ReadingError> = Arc::new(Zero(offset));
    give(setting, mechanism, &error, |sensor| sensor.offset += offset)
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{SLIDER_CRANK, TURNTABLE, closed};

    #[test]
    fn a_servo_goes_to_what_its_encoder_calls_the_command_and_other_sensors_are_off() {
        let effect = |sensor: &str| {
            format!("[[effect]]\nkind = \"encoder-zero\"\nsensor = \"{sensor}\"\noffset = 0.02\n")
        };
        let machine = closed(&format!("{TURNTABLE}{}", effect("q_O")));
        assert!((machine.angle("O") - (0.5 - 0.02)).abs() < 1e-12, "{}", machine.angle("O"));
        assert!((machine.shows("q_O") - 0.5).abs() < 1e-12);
        assert!(machine.effort(0).abs() < 1e-9);
        // The rod's joint has no drive.
        let machine = closed(&format!("{SLIDER_CRANK}{}", effect("q_A")));
        assert!((machine.angle("O") - 0.5).abs() < 1e-12);
        assert!((machine.shows("q_A") - machine.angle("A") - 0.02).abs() < 1e-12);
    }
}
