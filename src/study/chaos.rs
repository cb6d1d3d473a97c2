//! What chaos leaves of a prediction: how fast two motions that begin alike part, and for how long a
//! run can be taken at its word.
//!
//! The distance of two such motions, measured at the platform, grows like `e^{λt}` until it is as
//! large as the clearances allow; λ is the largest Lyapunov exponent, 1/λ the e-folding time.

use crate::engine::{self, Schedule, StepControl, TYPICAL_IMPACT_SPEED};
use crate::mechanism::{Bearing, Mechanism, Revolute};
use crate::simulate::radial_clearance;
use nalgebra::Vector2;
use std::f64::consts::TAU;

/// Time in s that is watched: at an e-folding time of 10 ms a distance grows from 1e-12 m to 0.5 mm.
pub const WINDOW: f64 = 0.2;

/// Distance in m between the starts of a pair: far above the rounding of positions (1e-17 m), and far
/// enough below the clearances for the growth to be seen over many powers of e.
pub const DISPLACEMENT: f64 = 1e-12;

/// Error in m of the platform's position up to which a prediction is said to hold: of the size of a
/// contact's give, and of what a tracker of a real machine resolves.
pub const HORIZON_ERROR: f64 = 1e-6;

/// Share of the smallest clearance from which on distances are no longer small.
const LARGE: f64 = 0.01;

/// Growth by this factor tells the start of the exponential range: before the first hit nothing grows.
const BEGUN: f64 = 10.0;

/// Time in s between two looks at the distance.
const INTERVAL: f64 = 1e-4;

/// Longest step in s for pairs.
const PAIR_STEP: f64 = 1e-5;

/// Distance over time: (s, m).
pub type Distances = Vec<(f64, f64)>;

/// Positions (m) of the output body over the rows of a schedule, or nothing if the run breaks down.
fn track(
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
) -> Option<Vec<(f64, Vector2<f64>)>> {
    let mut track = Vec::with_capacity(schedule.intervals() + 1);
    let done = engine::run(mechanism, control, schedule, &mut |instant| {
        track.push((instant.t, mechanism.output_state(instant.states).position));
    });
    done.ok().map(|_| track)
}

/// Distance over time of a mechanism from itself with its output body displaced by [`DISPLACEMENT`]
/// in a direction (share of a turn). Steps are fixed: steps chosen by error would differ between the
/// two, and part them by more than the displacement. `None` if no joint has clearance under a law, or a
/// run breaks down.
fn pair(mechanism: &Mechanism, duration: f64, direction: f64) -> Option<Distances> {
    let laws = |joint: &Revolute| matches!(joint.bearing, Bearing::Clearance(_));
    if !mechanism.revolutes.iter().any(laws) {
        return None;
    }
    let step = PAIR_STEP.min(0.5 * mechanism.longest_step(TYPICAL_IMPACT_SPEED)?);
    let control = StepControl::Fixed(step);
    let schedule = Schedule { duration, interval: INTERVAL };
    let (sin, cos) = (TAU * direction).sin_cos();
    let displaced = mechanism.displaced(Vector2::new(cos, sin) * DISPLACEMENT);
    let [a, b] = [mechanism, &displaced].map(|m| track(m, control, schedule));
    Some(a?.iter().zip(b?).map(|((t, p), (_, q))| (*t, (p - q).norm())).collect())
}

/// Growth rate in 1/s of a distance: the slope of its logarithm over the exponential range, which ends
/// where the distance is no longer small against the clearances. Without growth by a factor of ten,
/// over the second half of the time.
fn growth(mechanism: &Mechanism, distances: &Distances) -> Option<f64> {
    let clearances = mechanism.revolutes.iter().filter_map(|j| radial_clearance(&j.bearing));
    let large = LARGE * clearances.reduce(f64::min)?;
    let first = distances.iter().find(|(_, d)| *d > 0.0)?.1;
    let end = distances.iter().position(|(_, d)| *d > large).unwrap_or(distances.len());
    let begin =
        distances.iter().position(|(_, d)| *d > BEGUN * first).unwrap_or(distances.len() / 2);
    let points: Vec<(f64, f64)> = distances
        .get(begin..end)?
        .iter()
        .filter(|(_, d)| *d > 0.0)
        .map(|(t, d)| (*t, d.ln()))
        .collect();
    let n = points.len() as f64;
    let mean = points.iter().fold((0.0, 0.0), |s, p| (s.0 + p.0 / n, s.1 + p.1 / n));
    let (covariance, variance) = points.iter().fold((0.0, 0.0), |s, p| {
        let dt = p.0 - mean.0;
        (s.0 + dt * (p.1 - mean.1), s.1 + dt * dt)
    });
    // Fewer than ten points (1 ms) are no range.
    (points.len() >= 10).then_some(covariance / variance)
}

/// Largest Lyapunov exponent in 1/s of a mechanism, from one pair of runs of `duration` s that starts
/// displaced in a direction (share of a turn). `None` where there is nothing to see: no joint has
/// clearance under a law, a run breaks down, or the range of growth is too short.
pub fn exponent(mechanism: &Mechanism, duration: f64, direction: f64) -> Option<f64> {
    growth(mechanism, &pair(mechanism, duration, direction)?)
}

/// The first time in s at which a distance exceeds `size` m, if it does.
fn first_beyond(distances: &Distances, size: f64) -> Option<f64> {
    distances.iter().find(|(_, d)| *d > size).map(|(t, _)| *t)
}

/// How far a run is from the same run with a tenth of the error (a tenth of the tolerance; half the
/// step), in m over the time in s: its own numerical error, and what chaos makes of it.
///
/// `positions` are the run's own, at the rows of `schedule`; rows after [`WINDOW`] are not looked at.
/// It takes one more run of that length. `None` if the run breaks down.
fn own_error(
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
    positions: &[Vector2<f64>],
) -> Option<Distances> {
    let finer = match control {
        StepControl::Fixed(step) => StepControl::Fixed(0.5 * step),
        StepControl::Tolerance(tolerance) => StepControl::Tolerance(0.1 * tolerance),
    };
    let schedule = Schedule { duration: schedule.duration.min(WINDOW), ..schedule };
    let track = track(mechanism, finer, schedule)?;
    // A window that ends between two rows of the run has a row of its own there, which is left out.
    let own = track.iter().zip(positions).take(schedule.intervals());
    Some(own.map(|((t, p), q)| (*t, (p - q).norm())).collect())
}

/// What two short looks at a run say of chaos.
#[derive(Clone, Debug, PartialEq)]
pub struct Chaos {
    /// Largest Lyapunov exponent in 1/s, of one pair.
    pub lyapunov: Option<f64>,
    /// Distance of that pair.
    pub distances: Distances,
    /// Time in s until which the run's own error, with what chaos makes of it, stays below
    /// [`HORIZON_ERROR`]; none if it does so all through [`WINDOW`].
    pub horizon: Option<f64>,
}

/// Looks at the first [`WINDOW`] of a run whose positions there (m, at the rows of `schedule`) are
/// known. That takes three more runs of that length, two of them with fixed steps. `None` where no
/// joint has clearance under a law, or where a run breaks down.
pub fn look(
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
    positions: &[Vector2<f64>],
    direction: f64,
) -> Option<Chaos> {
    let distances = pair(mechanism, schedule.duration.min(WINDOW), direction)?;
    let own = own_error(mechanism, control, schedule, positions)?;
    Some(Chaos {
        lyapunov: growth(mechanism, &distances),
        distances,
        horizon: first_beyond(&own, HORIZON_ERROR),
    })
}
