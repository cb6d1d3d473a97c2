//! A start that a recording shows: nobody knows how a machine was let go, but its swing is measured.
//!
//! Where loads keep joints in contact, bodies swing in their play for seconds, and how far a journal leans, on
//! average too, depends on that swing. A machine at rest under its first commands whose bodies are all kicked twice,
//! a quarter of a swing apart, just before the first row, swings in every way that its joints leave it, and no
//! kick puts a journal where it cannot be. Most of these kicks do the same to what sensors see: few combinations
//! of them matter, found once for each recording, and how much of each there was by Gauss and Newton.

use super::recording::Recording;
use super::simulate::{deviation, record};
use super::start::SWING;
use super::thresholds::{MOST_WAYS, SHOWN, SLACK, SWING_CORNER, SWING_SEEN, TRACKED, WAY};
use crate::engine::{Halt, StepControl};
use crate::measure::filter::ZeroPhase;
use crate::mechanism::{Bearing, Load, Mechanism, Reads, Situation};
use nalgebra::{DMatrix, DVector, Vector3};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

/// Kicks of each body, and their length in s, half a sine's; the last ends with the first row. In between
/// lies a quarter of a swing: two of them make any amplitude and phase.
const PULSES: usize = 2;
const PULSE: f64 = 0.012;
const APART: f64 = 0.25 / SWING;

/// One kick as a share of a swing that crosses the whole play: small enough to be met by something linear.
const SIZE: f64 = 0.05;

/// Play of a machine without any, as a share of its size: what then swings are its drives.
const STIFF: f64 = 1e-4;

/// Steps of Gauss and Newton over the whole time, at most, and the share of the squares that one has to
/// promise to be tried, and to bring for another to be.
const STEPS: usize = 3;
const WORTH: f64 = 0.01;

/// What keeps kicks that do nothing at nothing, in squares of units of noise: far below what one does that is
/// seen.
const RIDGE: f64 = 1e-3;

/// Kicks of all bodies at once that matter, one a column: along x and y and about the centre of mass of each
/// body, pulse by pulse, as multiples of [`SIZE`].
type Ways = DMatrix<f64>;

/// How much of each way there was.
type Kicks = DVector<f64>;

#[derive(Debug)]
struct Kicked {
    /// Impulses over their times, N, N, N·m, pulse by pulse and body by body.
    forces: Vec<Vec<Vector3<f64>>>,
}

impl Load for Kicked {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        for (pulse, forces) in self.forces.iter().enumerate() {
            let phase = (at.t + PULSE + pulse as f64 * APART) / PULSE;
            if (0.0..1.0).contains(&phase) {
                for (wrench, force) in wrenches.iter_mut().zip(forces) {
                    *wrench += force * (PI * phase).sin();
                }
            }
        }
    }
}

/// Radial play in m of a machine's joints, their mean.
fn play(machine: &Mechanism) -> f64 {
    let plays: Vec<f64> = machine
        .revolutes
        .iter()
        .filter_map(|joint| match &joint.bearing {
            Bearing::Clearance(clearance) => Some(clearance.radial()),
            _ => None,
        })
        .collect();
    match plays.len() {
        0 => STIFF * machine.size(),
        count => plays.iter().sum::<f64>() / count as f64,
    }
}

/// A machine at rest with so much of each of these ways.
fn kicked(still: &Mechanism, ways: &Ways, kicks: &Kicks) -> Mechanism {
    let all = ways * kicks;
    let speed = SIZE * TAU * SWING * play(still);
    let of = |pulse: usize| {
        let bodies = still.bodies.iter().enumerate();
        bodies
            .map(|(i, body)| {
                let at = 3 * (pulse * still.bodies.len() + i);
                let part = Vector3::from_fn(|k, _| all.get(at + k).copied().unwrap_or(0.0));
                let turn = (body.inertia * body.mass).sqrt();
                // A half sine of height 1 has the mean 2/π.
                let unit = Vector3::new(body.mass, body.mass, turn) * (speed * FRAC_PI_2 / PULSE);
                unit.component_mul(&part)
            })
            .collect()
    };
    let mut machine = still.clone();
    machine.loads.push(Arc::new(Kicked { forces: (0..PULSES).map(of).collect() }));
    machine
}

/// How well starts meet the swing that a recording shows.
struct Judge {
    control: StepControl,
    recording: Recording,
}

impl Judge {
    fn new(recording: &Recording, control: StepControl, seconds: f64) -> Self {
        Self { control, recording: recording.first(seconds) }
    }

    /// What is not met of what sensors see above [`SWING_CORNER`], in units of their noise. Below it the model may
    /// be wrong for other reasons.
    fn look(&self, machine: &Mechanism) -> Result<DVector<f64>, Halt> {
        let simulated = record(machine, self.control, &self.recording, 0)?;
        let filter = ZeroPhase::butterworth(4, SWING_CORNER, self.recording.interval);
        let mut all = Vec::new();
        for (i, sensor) in machine.sensors.iter().enumerate() {
            let pair = self.recording.get(i).zip(simulated.get(i));
            let Some((measured, simulated)) = pair else { continue };
            if matches!(sensor.reads, Reads::Command(_)) {
                continue;
            }
            let unit = deviation(sensor, measured);
            let difference: Vec<f64> = measured.iter().zip(simulated).map(|(a, b)| a - b).collect();
            let slow = filter.apply(&difference);
            all.extend(difference.iter().zip(&slow).map(|(whole, slow)| (whole - slow) / unit));
        }
        Ok(DVector::from_vec(all))
    }

    /// What a unit of each way changes of what is not met.
    fn response(
        &self,
        still: &Mechanism,
        ways: &Ways,
        kicks: &Kicks,
        base: &DVector<f64>,
    ) -> Result<DMatrix<f64>, Halt> {
        let columns = (0..ways.ncols()).into_par_iter().map(|i| {
            let mut beside = kicks.clone();
            beside[i] += 1.0;
            Ok(self.look(&kicked(still, ways, &beside))? - base)
        });
        Ok(DMatrix::from_columns(&columns.collect::<Result<Vec<_>, Halt>>()?))
    }
}

/// The swing that a recording begins with.
#[derive(Clone, Debug)]
pub struct Swing {
    ways: Ways,
    kicks: Kicks,
}

impl Swing {
    /// That of a recording; none where the machine swings so as it was `released`, where it was not at rest (`still`)
    /// before, or where no kicks show the recorded swing.
    ///
    /// # Errors
    /// A run that broke down, but for a kick that the machine does not stand: that is not what was recorded.
    pub fn of(
        released: &Mechanism,
        still: Option<&Mechanism>,
        recording: &Recording,
        control: StepControl,
    ) -> Result<Option<Self>, Halt> {
        let Some(still) = still else { return Ok(None) };
        let ways = ways(still, recording, control)?;
        let seen = as_seen(released, still, &ways, recording, control);
        Ok(seen.ok().flatten().map(|kicks| Self { ways, kicks }))
    }

    /// A machine at rest that is kicked so that it swings like this.
    pub fn given_to(&self, still: &Mechanism) -> Mechanism {
        kicked(still, &self.ways, &self.kicks)
    }
}

/// The ways in which kicks change what sensors see of a machine at rest, those that matter alone.
///
/// # Errors
/// A run that broke down.
fn ways(still: &Mechanism, recording: &Recording, control: StepControl) -> Result<Ways, Halt> {
    let judge = Judge::new(recording, control, SWING_SEEN[1]);
    let count = 3 * PULSES * still.bodies.len();
    let every = DMatrix::identity(count, count);
    let none = DVector::zeros(count);
    let base = judge.look(still)?;
    let response = judge.response(still, &every, &none, &base)?;
    let normal = response.transpose() * response;
    if normal.iter().any(|value| !value.is_finite()) {
        return Ok(DMatrix::zeros(count, 0));
    }
    let eigen = normal.symmetric_eigen();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let largest = order.first().map_or(0.0, |&first| eigen.eigenvalues[first]);
    // An eigenvalue is a square; what changes readings by less than one unit of noise in all is not seen.
    let matters = |k: &usize| eigen.eigenvalues[*k] > (WAY * WAY * largest).max(1.0);
    let kept: Vec<usize> = order.into_iter().filter(matters).take(MOST_WAYS).collect();
    Ok(eigen.eigenvectors.select_columns(&kept))
}

/// The step of Gauss and Newton.
fn step(response: &DMatrix<f64>, left: &DVector<f64>) -> Kicks {
    let count = response.ncols();
    let normal = response.transpose() * response + DMatrix::identity(count, count) * RIDGE;
    let solved = normal.cholesky().map(|factor| -factor.solve(&(response.transpose() * left)));
    solved.unwrap_or_else(|| DVector::zeros(count))
}

/// The kicks that a recording shows; none where the machine swings as it was let go, or no kicks show the recorded
/// swing.
///
/// # Errors
/// A run that broke down.
fn as_seen(
    released: &Mechanism,
    still: &Mechanism,
    ways: &Ways,
    recording: &Recording,
    control: StepControl,
) -> Result<Option<Kicks>, Halt> {
    let [.., whole] = SWING_SEEN;
    let judge = Judge::new(recording, control, whole);
    let left = judge.look(released)?;
    let let_go = left.norm_squared();
    if ways.ncols() == 0 || let_go <= SHOWN * left.len() as f64 {
        return Ok(None);
    }
    let mut kicks = DVector::zeros(ways.ncols());
    for seconds in SWING_SEEN {
        let judge = Judge::new(recording, control, seconds);
        let quiet = judge.look(still)?.norm_squared();
        let mut left = judge.look(&kicked(still, ways, &kicks))?;
        let response = judge.response(still, ways, &kicks, &left)?;
        let last = seconds == whole;
        for _ in 0..if last { STEPS } else { 1 } {
            let change = step(&response, &left);
            let promised = (&left + &response * &change).norm_squared();
            if promised > (1.0 - WORTH) * left.norm_squared() {
                break;
            }
            let there = judge.look(&kicked(still, ways, &(&kicks + &change)))?;
            let gain = 1.0 - there.norm_squared() / left.norm_squared();
            if gain > 0.0 {
                (left, kicks) = (there, kicks + change);
            }
            if gain < WORTH {
                break;
            }
        }
        let square = left.norm_squared();
        let noise = left.len() as f64;
        let tracked = square - noise < TRACKED * (quiet - noise);
        if !tracked || last && square > SLACK * let_go {
            return Ok(None);
        }
    }
    Ok(Some(kicks))
}
