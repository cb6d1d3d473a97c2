//! `timeseries.csv`: one line a row, written as the run goes.

use crate::engine::Instant;
use crate::mechanism::Mechanism;
use crate::model::Layout;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Which numbers a row has: time, pose, velocity and acceleration of each output, coordinate and effort of each
/// drive, and for each joint with a declared clearance the eccentricity |e|, the normal force, and its peak
/// since the previous row.
#[derive(Clone, Debug)]
pub struct RowColumns {
    layout: Layout,
}

/// Pose of an output and its derivatives, each followed by the output's label.
const OUTPUT: [&str; 9] = ["x", "y", "phi", "vx", "vy", "omega", "ax", "ay", "alpha"];

impl RowColumns {
    /// The columns of a machine with this layout.
    pub fn new(layout: &Layout) -> Self {
        Self { layout: layout.clone() }
    }

    /// Their names.
    pub fn names(&self, mechanism: &Mechanism) -> Vec<String> {
        let layout = &self.layout;
        let outputs = layout.outputs.iter();
        let outputs = outputs.flat_map(|o| OUTPUT.map(|quantity| format!("{quantity}{}", o.label)));
        let drives = ["q", "F"].into_iter();
        let drives = drives.flat_map(|c| layout.drives.iter().map(move |d| format!("{c}{d}")));
        let joints = layout.joints.iter().flat_map(|&joint| {
            let name = &mechanism.revolutes[joint].name;
            [format!("ecc_{name}"), format!("force_{name}"), format!("force_{name}_max")]
        });
        ["t".to_owned()].into_iter().chain(outputs).chain(drives).chain(joints).collect()
    }

    /// Adds the numbers of one row to `row`, in SI units.
    pub fn values(&self, mechanism: &Mechanism, instant: &Instant, row: &mut Vec<f64>) {
        let now = instant.evaluation;
        row.push(tidy(instant.t));
        for output in &self.layout.outputs {
            let reference = mechanism.bodies[output.body].reference;
            let state = output.state(instant.states, reference);
            let acceleration = output.acceleration(
                &instant.states[output.body],
                now.accelerations[output.body],
                reference,
            );
            row.extend(state.position.iter());
            row.push(instant.angles[output.body] + output.angle);
            row.extend(state.twist.iter());
            row.extend(acceleration.iter());
        }
        for (actuator, coordinate) in mechanism.actuators.iter().zip(&now.coordinates) {
            row.push(actuator.read(*coordinate, 0.0)[0]);
        }
        row.extend(&now.drive_forces);
        for &joint in &self.layout.joints {
            let contact = &now.contacts[joint];
            let peak = instant.tallies[joint].peak;
            row.extend([contact.eccentricity.norm(), contact.normal_force, peak]);
        }
    }
}

/// Writes rows as CSV. Nothing but the present line is kept.
///
/// ```
/// use freeplay::prelude::*;
/// use freeplay::simulate::TimeSeries;
///
/// let machine = assemble(&Scenario::load(None, &["simulation.duration=0.002".to_owned()])?)?;
/// let mut text = Vec::new();
/// let mut series = TimeSeries::new(&mut text, &machine.mechanism, &machine.layout)?;
/// let mut written = Ok(());
/// run(&machine.mechanism, machine.control, machine.schedule, &mut |instant| {
///     written = series.row(&machine.mechanism, instant);
/// })?;
/// written?;
/// series.finish()?;
/// assert_eq!(String::from_utf8(text)?.lines().count(), machine.schedule.intervals() + 2, "a header and rows");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct TimeSeries<W> {
    out: W,
    line: String,
    row: Vec<f64>,
    bytes: u64,
    columns: RowColumns,
}

impl<W: Write> TimeSeries<W> {
    /// Writes the header of the columns of `layout`.
    ///
    /// # Errors
    /// If `out` refuses.
    pub fn new(mut out: W, mechanism: &Mechanism, layout: &Layout) -> io::Result<Self> {
        let columns = RowColumns::new(layout);
        let names: Vec<String> = columns.names(mechanism).iter().map(|name| quoted(name)).collect();
        let line = names.join(",") + "\n";
        out.write_all(line.as_bytes())?;
        Ok(Self { out, bytes: line.len() as u64, line, row: Vec::new(), columns })
    }

    /// Writes one row.
    ///
    /// # Errors
    /// If the file refuses.
    pub fn row(&mut self, mechanism: &Mechanism, instant: &Instant) -> io::Result<()> {
        self.line.clear();
        self.row.clear();
        self.columns.values(mechanism, instant, &mut self.row);
        for (i, value) in self.row.iter().enumerate() {
            // Writing to a string cannot fail. Ten digits: 1e-11 m on a machine of less than 1 m, and no solver
            // agrees on more; the time as it is meant.
            let _ = match (i, *value) {
                (0, t) => write!(self.line, "{t}"),
                (_, 0.0) => write!(self.line, ",0"),
                (_, value) => write!(self.line, ",{value:.9e}"),
            };
        }
        self.line.push('\n');
        self.bytes += self.line.len() as u64;
        self.out.write_all(self.line.as_bytes())
    }

    /// Size of everything so far.
    pub fn bytes(&self) -> u64 {
        self.bytes
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
