//! What the encoder of a driven joint reads, against its true coordinate.

use super::{Actuator, Command, Evaluation, Mechanism};

/// Newton's method ends after a step of this size, in m or rad: what is left is half its square times the curvature of the
/// errors, which is less than rounding up to 1e3 per m.
pub(crate) const LAST_STEP: f64 = 1e-10;

impl Actuator {
    /// True length in m at a read length, and its first and second derivative by it.
    fn true_length(&self, read: f64) -> [f64; 3] {
        self.reading_errors.iter().fold([read, 1.0, 0.0], |sum, error| {
            let term = error.at(read);
            [sum[0] + term[0], sum[1] + term[1], sum[2] + term[2]]
        })
    }

    /// Length (m) and rate (m/s) that the encoder reads, by Newton's method on
    /// `read + error(read) = length`.
    pub fn read(&self, length: f64, rate: f64) -> [f64; 2] {
        if self.reading_errors.is_empty() {
            return [length, rate];
        }
        let mut read = length;
        let mut slope = 1.0;
        // Errors are small against what they vary over: three or four steps reach the last digit.
        for _ in 0..8 {
            let [value, first, _] = self.true_length(read);
            slope = first;
            let step = (value - length) / slope;
            read -= step;
            if step.abs() < LAST_STEP {
                break;
            }
        }
        [read, rate / slope]
    }

    /// The motion of the true length that a motion of the read length means.
    pub(crate) fn true_command(&self, read: Command) -> Command {
        let [length, first, second] = self.true_length(read.position);
        Command {
            position: length,
            rate: first * read.rate,
            acceleration: first * read.acceleration + second * read.rate * read.rate,
        }
    }
}

impl Mechanism {
    /// Length in m that the encoder of drive `index` shows at an instant. It sits at the
    /// drive's end of the [`Transmission`](super::Transmission): play and give show there, beside the
    /// errors of the encoder itself.
    pub fn encoder(&self, index: usize, now: &Evaluation) -> f64 {
        let actuator = &self.actuators[index];
        let [read, _] = actuator.read(now.coordinates[index], 0.0);
        let error = now.commands[index].position - read;
        let force = now.drive_forces[index];
        read + actuator.transmission.map_or(0.0, |link| link.ahead(error, force))
    }
}
