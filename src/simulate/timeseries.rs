//! `timeseries.csv`: one line a row, written as the run goes.

use crate::engine::Instant;
use crate::mechanism::Mechanism;
use crate::model::Layout;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Writes rows as CSV: pose, velocity and acceleration of each output, coordinate and effort of each
/// drive, and for each joint with a declared clearance the eccentricity |e|, the normal force, and its peak
/// since the previous row. Nothing but the present line is kept.
#[derive(Debug)]
pub struct TimeSeries<W> {
    out: W,
    line: String,
    bytes: u64,
    layout: Layout,
}

/// Pose of an output and its derivatives, each followed by the output's label.
const OUTPUT: [&str; 9] = ["x", "y", "phi", "vx", "vy", "omega", "ax", "ay", "alpha"];

impl<W: Write> TimeSeries<W> {
    /// Writes the header of the columns of `layout`.
    ///
    /// # Errors
    /// If `out` refuses.
    pub fn new(mut out: W, mechanism: &Mechanism, layout: &Layout) -> io::Result<Self> {
        let mut line = "t".to_owned();
        // Writing to a string cannot fail, here and below.
        for output in &layout.outputs {
            for quantity in OUTPUT {
                let _ = write!(line, ",{}", quoted(&format!("{quantity}{}", output.label)));
            }
        }
        for letter in ["q", "F"] {
            for label in &layout.drives {
                let _ = write!(line, ",{}", quoted(&format!("{letter}{label}")));
            }
        }
        for &joint in &layout.joints {
            let name = &mechanism.revolutes[joint].name;
            let columns =
                [format!("ecc_{name}"), format!("force_{name}"), format!("force_{name}_max")];
            for column in columns {
                let _ = write!(line, ",{}", quoted(&column));
            }
        }
        line.push('\n');
        out.write_all(line.as_bytes())?;
        Ok(Self { out, bytes: line.len() as u64, line, layout: layout.clone() })
    }

    /// Writes one row.
    ///
    /// # Errors
    /// If the file refuses.
    pub fn row(&mut self, mechanism: &Mechanism, instant: &Instant) -> io::Result<()> {
        let now = instant.evaluation;
        self.line.clear();
        let _ = write!(self.line, "{}", tidy(instant.t));
        for i in 0..self.layout.outputs.len() {
            let output = &self.layout.outputs[i];
            let reference = mechanism.bodies[output.body].reference;
            let state = output.state(instant.states, reference);
            let acceleration = output.acceleration(
                &instant.states[output.body],
                now.accelerations[output.body],
                reference,
            );
            let phi = instant.angles[output.body] + output.angle;
            self.numbers(state.position.iter());
            self.numbers([&phi]);
            self.numbers(state.twist.iter());
            self.numbers(acceleration.iter());
        }
        for (actuator, coordinate) in mechanism.actuators.iter().zip(&now.coordinates) {
            self.numbers([&actuator.read(*coordinate, 0.0)[0]]);
        }
        self.numbers(&now.drive_forces);
        for i in 0..self.layout.joints.len() {
            let joint = self.layout.joints[i];
            let contact = &now.contacts[joint];
            let peak = instant.tallies[joint].peak;
            self.numbers([&contact.eccentricity.norm(), &contact.normal_force, &peak]);
        }
        self.line.push('\n');
        self.bytes += self.line.len() as u64;
        self.out.write_all(self.line.as_bytes())
    }

    /// Size of everything so far.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Ten digits: 1e-11 m on a machine of less than 1 m, and no solver agrees on more.
    fn numbers<'a>(&mut self, values: impl IntoIterator<Item = &'a f64>) {
        for value in values {
            let _ = if *value == 0.0 {
                write!(self.line, ",0")
            } else {
                write!(self.line, ",{value:.9e}")
            };
        }
    }

    /// Hands the rest to the file.
    ///
    /// # Errors
    /// If the file refuses.
    pub fn finish(mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// A column's name as a CSV field.
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}

/// 0.3 for 0.30000000000000004: multiples of an interval read as what was meant.
fn tidy(t: f64) -> f64 {
    format!("{t:.12e}").parse().unwrap_or(t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_of_an_interval_read_as_meant() {
        assert_eq!(tidy(3.0 * 0.1).to_string(), "0.3");
        assert_eq!(tidy(1e-7).to_string(), "0.0000001");
    }
}
