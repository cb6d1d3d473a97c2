//! A sensor of a revolute joint whose disk is beside its axis.

use super::encoder::give;
use crate::effects::kind::defaults;
use crate::effects::{Kind, Parameter, Senses, Setting, Targets, Wrong};
use crate::mechanism::{LAST_STEP, Mechanism, ReadingError};
use std::f64::consts::TAU;
use std::sync::Arc;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "encoder-eccentricity",
    summary: "a sensor of a revolute joint whose disk is beside the axis; where a drive holds the joint it is \
              the drive's encoder, which the servo sees",
    equation: "reads q + amplitude sin(q + phase)",
    source: "an encoder disk e beside its axis, read at radius R: amplitude e/R, first order in e/R",
    trace: "measured coordinates against each other: once a turn",
    targets: Targets::Sensor(Senses::Angle),
    parameters: &[
        Parameter::size(
            "amplitude",
            "rad",
            "amplitude e/R: 0.01 is 0.2 mm on a disk of 20 mm",
            // From 1 on a reading belongs to more than one angle.
            0.3,
            1e-4,
        ),
        Parameter {
            name: "phase_rad",
            unit: "rad",
            about: "phase at angle 0",
            bounds: [-1e3, 1e3],
            step: 1e-2,
            default: Some(0.0),
        },
    ],
    variants: &[&["amplitude", "phase_rad"]],
    neutral: defaults,
    // Half a degree, in eight directions.
    starts: |_, _| (0..8).map(|k| vec![0.01, TAU * f64::from(k) / 8.0]).collect(),
    scan: None,
    apply,
};

#[derive(Debug)]
struct Eccentric {
    amplitude: f64,
    phase: f64,
}

impl ReadingError for Eccentric {
    /// With q from `q + a sin(q + φ) = read` by Newton's method: `q − read`, `dq/dread − 1` and
    /// `d²q/dread² = a sin(q + φ) (dq/dread)³`, where `dq/dread = 1/(1 + a cos(q + φ))`.
    fn at(&self, read: f64) -> [f64; 3] {
        let mut q = read - self.amplitude * (read + self.phase).sin();
        for _ in 0..8 {
            let (sin, cos) = (q + self.phase).sin_cos();
            let step = (q + self.amplitude * sin - read) / (1.0 + self.amplitude * cos);
            q -= step;
            if step.abs() < LAST_STEP {
                break;
            }
        }
        let (sin, cos) = (q + self.phase).sin_cos();
        let slope = 1.0 / (1.0 + self.amplitude * cos);
        [-self.amplitude * sin, slope - 1.0, self.amplitude * sin * slope.powi(3)]
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let [amplitude, phase] = ["amplitude", "phase_rad"].map(|name| setting.number(name));
    let error: Arc<dyn ReadingError> = Arc::new(Eccentric { amplitude, phase });
    give(setting, mechanism, &error, |sensor| sensor.waves.push([amplitude, phase]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::rigs::{SLIDER_CRANK, TURNTABLE, closed};

    #[test]
    fn the_reading_waves_once_a_turn() {
        let keys = |sensor| {
            format!(
                "[[effect]]\nkind = \"encoder-eccentricity\"\nsensor = \"{sensor}\"\namplitude = 0.05\n\
                 phase_rad = 0.3\n"
            )
        };
        let wave = |q: f64| q + 0.05 * (q + 0.3).sin();
        let machine = closed(&format!("{TURNTABLE}{}", keys("q_O")));
        assert!((wave(machine.angle("O")) - 0.5).abs() < 1e-12, "{}", machine.angle("O"));
        assert!((machine.shows("q_O") - 0.5).abs() < 1e-12);
        let machine = closed(&format!("{SLIDER_CRANK}{}", keys("q_A")));
        assert!((machine.shows("q_A") - wave(machine.angle("A"))).abs() < 1e-12);
    }

    #[test]
    fn slopes_are_those_of_the_error() {
        let error = Eccentric { amplitude: 0.2, phase: 0.3 };
        let h = 1e-5;
        for read in [-2.0, 0.1, 1.0, 7.0] {
            let [before, now, after] = [read - h, read, read + h].map(|read| error.at(read));
            assert!(((after[0] - before[0]) / (2.0 * h) - now[1]).abs() < 1e-8);
            assert!(((after[1] - before[1]) / (2.0 * h) - now[2]).abs() < 1e-8);
        }
    }
}
