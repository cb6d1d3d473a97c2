//! A sensor of a joint with a wrong scale.

use super::encoder::give;
use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Senses, Setting, Targets, Wrong};
use crate::mechanism::{Mechanism, ReadingError};
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "encoder-scale",
    summary: "a sensor of a joint with a wrong scale; where a drive holds the joint it is the drive's encoder, \
              which the servo sees",
    equation: "reads q (1 + relative)",
    source: "definition",
    trace: "measured coordinates against each other: with the coordinate itself, turn after turn",
    targets: Targets::Sensor(Senses::Coordinate),
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
struct EncoderScale {
    relative: f64,
}

impl ReadingError for EncoderScale {
    /// `q − read = −read · relative/(1 + relative)`.
    fn at(&self, read: f64) -> [f64; 3] {
        let slope = -self.relative / (1.0 + self.relative);
        [slope * read, slope, 0.0]
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let relative = setting.number("relative");
    let error: Arc<dyn ReadingError> = Arc::new(EncoderScale { relative });
    give(setting, mechanism, &error, |sensor| sensor.scale *= 1.0 + relative)
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{SLIDER_CRANK, TURNTABLE, closed};

    #[test]
    fn a_servo_goes_to_the_command_over_its_encoders_scale() {
        let effect = |sensor: &str| {
            format!(
                "[[effect]]\nkind = \"encoder-scale\"\nsensor = \"{sensor}\"\nrelative = 0.03\n"
            )
        };
        let machine = closed(&format!("{TURNTABLE}{}", effect("q_O")));
        assert!((machine.angle("O") - 0.5 / 1.03).abs() < 1e-12, "{}", machine.angle("O"));
        assert!((machine.shows("q_O") - 0.5).abs() < 1e-12);
        assert!(machine.effort(0).abs() < 1e-9);
        let machine = closed(&format!("{SLIDER_CRANK}{}", effect("q_A")));
        assert!((machine.shows("q_A") - 1.03 * machine.angle("A")).abs() < 1e-12);
    }
}
