//! `timeseries.csv`: one line a row, written as the run goes.

use crate::engine::Instant;
use crate::mechanism::Mechanism;
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;
use std::io::{self, Write};

/// Writes rows as CSV: pose, velocity and acceleration of the output body, length and force of each
/// drive, and for each joint the eccentricity |e|, the normal force, and its peak since the previous
/// row. Nothing but the present line is kept.
#[derive(Debug)]
pub struct TimeSeries<W> {
    out: W,
    line: String,
    /// Angle of the output body at the row before, in rad, without jumps by whole turns.
    phi: f64,
}

impl<W: Write> TimeSeries<W> {
    /// Writes the header. `phi` is the output body's angle at t = 0 in rad: rotations do not tell
    /// whole turns apart, columns do.
    ///
    /// # Errors
    /// If `out` refuses.
    pub fn new(mut out: W, mechanism: &Mechanism, phi: f64) -> io::Result<Self> {
        let mut line = "t,x,y,phi,vx,vy,omega,ax,ay,alpha".to_owned();
        for letter in ["q", "F"] {
            for i in 1..=mechanism.actuators.len() {
                // Writing to a string cannot fail, here and below.
                let _ = write!(line, ",{letter}{i}");
            }
        }
        for joint in &mechanism.revolutes {
            let name = &joint.name;
            let _ = write!(line, ",ecc_{name},force_{name},force_{name}_max");
        }
        line.push('\n');
        out.write_all(line.as_bytes())?;
        Ok(Self { out, line, phi })
    }

    /// Writes one row.
    ///
    /// # Errors
    /// If the file refuses.
    pub fn row(&mut self, mechanism: &Mechanism, instant: &Instant) -> io::Result<()> {
        let state = mechanism.output_state(instant.states);
        let now = instant.evaluation;
        self.phi = unwrapped(state.rotation.angle(), self.phi);
        self.line.clear();
        let _ = write!(self.line, "{}", tidy(instant.t));
        self.numbers(state.position.iter());
        self.numbers([&self.phi.clone()]);
        self.numbers(state.twist.iter());
        self.numbers(mechanism.output_acceleration(instant.states, &now.accelerations).iter());
        for (actuator, coordinate) in mechanism.actuators.iter().zip(&now.coordinates) {
            self.numbers([&actuator.read(*coordinate, 0.0)[0]]);
        }
        self.numbers(&now.drive_forces);
        for (contact, tally) in now.contacts.iter().zip(instant.tallies) {
            self.numbers([&contact.eccentricity.norm(), &contact.normal_force, &tally.peak]);
        }
        self.line.push('\n');
        self.out.write_all(self.line.as_bytes())
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

/// The angle nearest to `before` among those that differ from `angle` by whole turns.
fn unwrapped(angle: f64, before: f64) -> f64 {
    before + (angle - before + PI).rem_euclid(TAU) - PI
}

/// 0.3 for 0.30000000000000004: multiples of an interval read as what was meant.
fn tidy(t: f64) -> f64 {
    format!("{t:.12e}").parse().unwrap_or(t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_go_on_past_half_a_turn() {
        assert!((unwrapped(-3.0, 3.0) - (TAU - 3.0)).abs() < 1e-15);
        assert!((unwrapped(3.0, -3.0) - (3.0 - TAU)).abs() < 1e-15);
        assert!((unwrapped(0.1, 4.0 * PI) - (4.0 * PI + 0.1)).abs() < 1e-14);
    }

    #[test]
    fn multiples_of_an_interval_read_as_meant() {
        assert_eq!(tidy(3.0 * 0.1).to_string(), "0.3");
        assert_eq!(tidy(1e-7).to_string(), "0.0000001");
    }
}
