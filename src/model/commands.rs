//! Commands of drives, each from a source of its own.

use crate::measure::spline::CubicSpline;
use crate::mechanism::motion::{rest_to_rest, sine};
use crate::mechanism::{Command, Commands};

/// A number over time, and its first and second derivative.
#[derive(Clone, Debug)]
pub(super) enum NumberSource {
    /// It holds.
    Hold(f64),
    /// start + velocity · t.
    Line { start: f64, velocity: f64 },
    /// From rest to rest ([`rest_to_rest`]).
    Quintic { from: f64, to: f64, time: f64 },
    /// center + Σ amplitude · sin(2π frequency t + phase).
    Sines { center: f64, terms: Vec<[f64; 3]> },
    /// Through the samples of a table.
    Spline(CubicSpline),
    /// The sum of two.
    Sum(Box<[NumberSource; 2]>),
}

impl NumberSource {
    /// Value, first and second derivative at time `t` (s).
    pub fn at(&self, t: f64) -> [f64; 3] {
        match self {
            NumberSource::Hold(value) => [*value, 0.0, 0.0],
            NumberSource::Line { start, velocity } => [start + velocity * t, *velocity, 0.0],
            NumberSource::Quintic { from, to, time } => {
                let way = to - from;
                let [s, ds, dds] = rest_to_rest(t, *time);
                [from + way * s, way * ds, way * dds]
            }
            NumberSource::Sines { center, terms } => {
                let mut sum = [*center, 0.0, 0.0];
                for [amplitude, frequency, phase] in terms {
                    for (sum, term) in sum.iter_mut().zip(sine(t, *frequency, *phase)) {
                        *sum += amplitude * term;
                    }
                }
                sum
            }
            NumberSource::Spline(spline) => spline.at(t),
            NumberSource::Sum(parts) => {
                let [a, b] = parts.each_ref().map(|part| part.at(t));
                [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
            }
        }
    }

    /// Time in s up to which somebody has said what to do.
    pub fn known_until(&self) -> f64 {
        match self {
            NumberSource::Spline(spline) => spline.end(),
            NumberSource::Sum(parts) => parts[0].known_until().min(parts[1].known_until()),
            _ => f64::INFINITY,
        }
    }
}

/// Commands with a source for each drive.
#[derive(Clone, Debug)]
pub(super) struct Each(pub Vec<NumberSource>);

impl Commands for Each {
    fn at(&self, t: f64, commands: &mut [Command]) {
        for (command, source) in commands.iter_mut().zip(&self.0) {
            let [position, rate, acceleration] = source.at(t);
            *command = Command { position, rate, acceleration };
        }
    }
}

/// Commands through exact samples of coordinate, rate and acceleration at equal intervals, by polynomials
/// of degree five that meet all three at both ends; at rest before the first and after the last.
#[derive(Clone, Debug)]
pub(super) struct Tabulated {
    /// Interval in s.
    pub interval: f64,
    /// Number of drives.
    pub drives: usize,
    /// Commands of all drives at each sample, one sample after another.
    pub samples: Vec<Command>,
    /// Largest error in m or rad that was found halfway between two samples.
    pub error: f64,
}

impl Tabulated {
    /// Commands of all drives at a sample.
    fn sample(&self, index: usize) -> &[Command] {
        &self.samples[index * self.drives..(index + 1) * self.drives]
    }

    /// Command of a drive at the share `s` of the way from a sample to the next.
    pub fn between(&self, index: usize, drive: usize, s: f64) -> Command {
        let [a, b] = [index, index + 1].map(|index| &self.sample(index)[drive]);
        quintic(a, b, s, self.interval)
    }
}

impl Commands for Tabulated {
    fn at(&self, t: f64, commands: &mut [Command]) {
        let last = self.samples.len() / self.drives - 1;
        let place = t / self.interval;
        let resting =
            |command: &Command| Command { position: command.position, ..Command::default() };
        if place <= 0.0 || place >= last as f64 {
            // At either end itself the motion goes on; beyond, it rests.
            let (end, at_end) =
                if place <= 0.0 { (0, place == 0.0) } else { (last, place == last as f64) };
            for (command, sample) in commands.iter_mut().zip(self.sample(end)) {
                *command = if at_end { *sample } else { resting(sample) };
            }
            return;
        }
        let i = (place as usize).min(last - 1);
        let s = place - i as f64;
        for (drive, command) in commands.iter_mut().enumerate() {
            *command = self.between(i, drive, s);
        }
    }
}

/// The polynomial of degree five through two commands `h` s apart, at the share `s` of the way.
fn quintic(a: &Command, b: &Command, s: f64, h: f64) -> Command {
    let (v0, v1) = (a.rate * h, b.rate * h);
    let (c0, c1) = (a.acceleration * h * h, b.acceleration * h * h);
    let d = b.position - a.position;
    let p3 = 10.0 * d - 6.0 * v0 - 4.0 * v1 - 1.5 * c0 + 0.5 * c1;
    let p4 = -15.0 * d + 8.0 * v0 + 7.0 * v1 + 1.5 * c0 - c1;
    let p5 = 6.0 * d - 3.0 * (v0 + v1) - 0.5 * (c0 - c1);
    let s2 = s * s;
    let position = a.position + s * (v0 + s * (0.5 * c0 + s * (p3 + s * (p4 + s * p5))));
    let rate = v0 + s * (c0 + s * (3.0 * p3 + s * (4.0 * p4 + s * 5.0 * p5)));
    let acceleration = c0 + s * (6.0 * p3 + 12.0 * p4 * s + 20.0 * p5 * s2);
    Command { position, rate: rate / h, acceleration: acceleration / (h * h) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_belong_to_the_value() {
        let samples = (0..20).map(|k| {
            let (sin, cos) = (3.0 * f64::from(k) * 0.05).sin_cos();
            Command { position: sin, rate: 3.0 * cos, acceleration: -9.0 * sin }
        });
        let samples = samples.collect();
        let table = Tabulated { interval: 0.05, drives: 1, samples, error: 2e-9 };
        let mut command = [Command::default()];
        for t in [0.0, 0.012, 0.3333, 0.61] {
            table.at(t, &mut command);
            let (sin, cos) = (3.0 * t).sin_cos();
            assert!((command[0].position - sin).abs() < 2e-9, "{t}");
            assert!((command[0].rate - 3.0 * cos).abs() < 3e-7, "{t}");
            assert!((command[0].acceleration + 9.0 * sin).abs() < 1e-4, "{t}");
        }
        let line = NumberSource::Line { start: 1.0, velocity: 2.0 };
        let sines = NumberSource::Sines { center: 0.1, terms: vec![[0.3, 2.0, 0.4]] };
        let quintic = NumberSource::Quintic { from: 0.2, to: 1.0, time: 1.1 };
        let sum = NumberSource::Sum(Box::new([sines.clone(), line.clone()]));
        for source in [line, sines, quintic, sum] {
            let h = 1e-5;
            let [before, now, after] = [0.3 - h, 0.3, 0.3 + h].map(|t| source.at(t));
            assert!(((after[0] - before[0]) / (2.0 * h) - now[1]).abs() < 1e-7, "{source:?}");
            assert!(((after[1] - before[1]) / (2.0 * h) - now[2]).abs() < 1e-6, "{source:?}");
        }
    }
}
