//! What chaos leaves of a prediction: how fast two motions that begin alike part, and for how long a
//! run can be taken at its word.
//!
//! The distance of two such motions, measured at the platform, grows like `e^{λt}` until it is as
//! large as the clearances allow; λ is the largest Lyapunov exponent, 1/λ the e-folding time.

use crate::engine::{self, Instant, Schedule, StepControl, TYPICAL_IMPACT_SPEED};
use crate::mechanism::{Bearing, Mechanism, Revolute};
use crate::simulate::{OwnError, radial_clearance};
use nalgebra::Vector2;
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::atomic::AtomicBool;

/// Time in s that is watched: at an e-folding time of 10 ms a distance grows from 1e-12 m to 0.5 mm.
pub const WINDOW: f64 = 0.2;

/// Distance in m between the starts of a pair: far above the rounding of positions (1e-17 m), and far
/// enough below the clearances for the growth to be seen over many powers of e.
pub const DISPLACEMENT: f64 = 1e-12;

/// Error in m of the platform's position up to which a prediction is said to hold: of the size of a
/// contact's give, and of what a tracker of a real machine resolves.
pub const HORIZON_ERROR: f64 = 1e-6;

/// Whether small differences grow: by a factor of e at least while they are watched. The rate in 1/s of less than that is
/// what rounding and the scatter of the fitted slope make of a machine at rest.
pub fn chaotic(rate: f64, simulated_s: f64) -> bool {
    rate * simulated_s.min(WINDOW) > 1.0
}

/// Share of the smallest clearance from which on distances are no longer small.
const LARGE: f64 = 0.01;

/// Growth by this factor tells the start of the exponential range: before the first hit nothing grows.
const BEGUN: f64 = 10.0;

/// Time in s between two looks at the distance.
const INTERVAL: f64 = 1e-4;

/// Longest step in s for pairs.
const PAIR_STEP: f64 = 1e-5;

/// Shortest step in s for pairs: below, looking at a run would take longer than the run.
const SHORTEST_PAIR_STEP: f64 = 2e-7;

/// Distance over time: (s, m).
pub type Distances = Vec<(f64, f64)>;

/// What is compared of a row of two runs.
#[derive(Clone, Debug)]
pub struct ComparedRow {
    t: f64,
    /// Of the output body, in m.
    position: Vector2<f64>,
    /// Peak of the normal force in each revolute joint since the row before, in N.
    peaks: Vec<f64>,
    /// Hits since the start, in all joints.
    hits: u64,
}

impl ComparedRow {
    /// At a row.
    pub fn at(mechanism: &Mechanism, instant: &Instant) -> Self {
        Self {
            t: instant.t,
            position: mechanism.output_state(instant.states).position,
            peaks: instant.tallies.iter().map(|tally| tally.peak).collect(),
            hits: instant.tallies.iter().map(|tally| tally.impacts).sum(),
        }
    }

    fn distance(&self, other: &Self) -> f64 {
        (self.position - other.position).norm()
    }
}

/// Largest normal force in each joint over some rows, in N.
fn peaks<'a>(rows: impl Iterator<Item = &'a ComparedRow>) -> Vec<f64> {
    rows.fold(Vec::new(), |mut peaks, row| {
        peaks.resize(row.peaks.len(), 0.0);
        for (peak, now) in peaks.iter_mut().zip(&row.peaks) {
            *peak = peak.max(*now);
        }
        peaks
    })
}

/// The rows of a schedule, or nothing if the run breaks down or is told to stop.
fn track(
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
    stop: &AtomicBool,
) -> Option<Vec<ComparedRow>> {
    let mut track = Vec::with_capacity(schedule.intervals() + 1);
    let done = engine::run_while(mechanism, control, schedule, stop, &mut |instant| {
        track.push(ComparedRow::at(mechanism, instant));
        ControlFlow::Continue(())
    });
    done.ok().filter(|work| !work.stopped).map(|_| track)
}

/// Distance over time of a mechanism from itself with its output body displaced by [`DISPLACEMENT`]
/// in a direction (share of a turn). Steps are fixed: steps chosen by error would differ between the
/// two, and part them by more than the displacement. `None` if no joint has clearance under a law, if a
/// run breaks down, or if it takes steps that are too short.
fn pair(
    mechanism: &Mechanism,
    duration: f64,
    direction: f64,
    stop: &AtomicBool,
) -> Option<Distances> {
    if !has_law(mechanism) {
        return None;
    }
    let step = PAIR_STEP.min(0.5 * mechanism.longest_step(TYPICAL_IMPACT_SPEED)?);
    if step < SHORTEST_PAIR_STEP {
        return None;
    }
    let control = StepControl::Fixed(step);
    let schedule = Schedule { duration, interval: INTERVAL };
    let (sin, cos) = (TAU * direction).sin_cos();
    let displaced = mechanism.displaced(Vector2::new(cos, sin) * DISPLACEMENT);
    let [a, b] = [mechanism, &displaced].map(|m| track(m, control, schedule, stop));
    Some(a?.iter().zip(&b?).map(|(p, q)| (p.t, p.distance(q))).collect())
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
    let (span, rate) = (points.last()?.0 - points.first()?.0, covariance / variance);
    // Where a distance stays what it is, rounding is no growth.
    let rate = if (rate * span).abs() < 1e-9 { 0.0 } else { rate };
    // Fewer than ten points (1 ms) are no range.
    (points.len() >= 10).then_some(rate)
}

/// Largest Lyapunov exponent in 1/s of a mechanism, from one pair of runs of `duration` s that starts
/// displaced in a direction (share of a turn). `None` where there is nothing to see: no joint has
/// clearance under a law, a run breaks down, or the range of growth is too short.
///
/// ```
/// use freeplay::prelude::*;
/// use freeplay::study::chaos::exponent;
///
/// let ideal = assemble(&Scenario::load(None, &["contact.law=\"ideal\"".to_owned()])?)?.mechanism;
/// // Without clearance neighbouring motions do not part exponentially.
/// assert!(exponent(&ideal, 0.05, 0.0).is_none_or(|rate| rate < 50.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn exponent(mechanism: &Mechanism, duration: f64, direction: f64) -> Option<f64> {
    growth(mechanism, &pair(mechanism, duration, direction, &AtomicBool::new(false))?)
}

/// How far a run is from the same run with a tenth of the error (a tenth of the tolerance; half the
/// step), as long as that is less than [`HORIZON_ERROR`]: its own numerical error, and what chaos makes
/// of it.
///
/// `rows` are the run's own; those after [`WINDOW`] are not looked at. It takes one more run of that
/// length. `None` if no joint has clearance under a law, if that run breaks down, and once `stop` is true.
pub fn own_error(
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
    rows: &[ComparedRow],
    stop: &AtomicBool,
) -> Option<OwnError> {
    if !has_law(mechanism) {
        return None;
    }
    let finer = match control {
        StepControl::Fixed(step) => StepControl::Fixed(0.5 * step),
        other => other.with_tolerance_times(0.1),
    };
    let schedule = Schedule { duration: schedule.duration.min(WINDOW), ..schedule };
    let track = track(mechanism, finer, schedule, stop)?;
    Some(apart(&track, rows, schedule))
}

/// How far a run of the physics engine is from one of the equations of motion integrated directly, both at this
/// `tolerance` (m/s), as long as that is less than [`HORIZON_ERROR`] and at most over [`WINDOW`]. `None` where one
/// of them breaks down.
pub fn engines_apart(
    mechanism: &Mechanism,
    tolerance: f64,
    schedule: Schedule,
) -> Option<OwnError> {
    let schedule = Schedule { duration: schedule.duration.min(WINDOW), ..schedule };
    let controls = [StepControl::Direct(tolerance), StepControl::Tolerance(tolerance)];
    let [direct, rapier] =
        controls.map(|control| track(mechanism, control, schedule, &AtomicBool::new(false)));
    Some(apart(&direct?, &rapier?, schedule))
}

/// How far `rows` of a run are from those of another, as long as that is less than [`HORIZON_ERROR`].
fn apart(track: &[ComparedRow], rows: &[ComparedRow], schedule: Schedule) -> OwnError {
    // A window that ends between two rows of the run has a row of its own there, which is left out.
    let pairs: Vec<_> = track.iter().zip(rows).take(schedule.intervals()).collect();
    let apart = pairs.iter().position(|(p, q)| p.distance(q) > HORIZON_ERROR);
    let good = &pairs[..apart.unwrap_or(pairs.len())];
    let [finer, own] = [peaks(good.iter().map(|(p, _)| *p)), peaks(good.iter().map(|(_, q)| *q))];
    let differences = finer.iter().zip(&own).map(|(a, b)| (a - b).abs());
    let end = apart.or(pairs.len().checked_sub(1));
    OwnError {
        until_s: end.map_or(0.0, |row| pairs[row].1.t),
        to_the_end: apart.is_none(),
        position_m: good.iter().map(|(p, q)| p.distance(q)).fold(0.0, f64::max),
        contact_force: differences.fold(0.0, f64::max),
        largest_contact_force: own.iter().copied().fold(0.0, f64::max),
        // Up to the same row: where rows are few and far between, all hits before it may be in its interval.
        hits: end.map_or(0, |row| pairs[row].1.hits),
    }
}

fn has_law(mechanism: &Mechanism) -> bool {
    let law = |joint: &Revolute| matches!(joint.bearing, Bearing::Clearance(_));
    mechanism.revolutes.iter().any(law)
}

/// What two short looks at a run say of chaos.
#[derive(Clone, Debug, PartialEq)]
pub struct Chaos {
    /// Largest Lyapunov exponent in 1/s, of one pair.
    pub lyapunov: Option<f64>,
    /// Distance of that pair.
    pub distances: Distances,
    /// How far the run is from one with a tenth of the error.
    pub own: OwnError,
}

impl Chaos {
    /// Looks at a pair beside a run whose own error is known.
    pub fn of(
        mechanism: &Mechanism,
        schedule: Schedule,
        own: OwnError,
        direction: f64,
        stop: &AtomicBool,
    ) -> Option<Self> {
        let distances = pair(mechanism, schedule.duration.min(WINDOW), direction, stop)?;
        Some(Self { lyapunov: growth(mechanism, &distances), distances, own })
    }

    /// Time in s until which the run's own error, with what chaos makes of it, stays below
    /// [`HORIZON_ERROR`]; none if it does so all through [`WINDOW`].
    pub fn horizon(&self) -> Option<f64> {
        (!self.own.to_the_end).then_some(self.own.until_s)
    }
}

/// Looks at the first [`WINDOW`] of a run whose rows there are known. That takes three more runs of that
/// length, two of them with fixed steps. `None` where no joint has clearance under a law, or where a run
/// breaks down.
pub fn look(
    mechanism: &Mechanism,
    control: StepControl,
    schedule: Schedule,
    rows: &[ComparedRow],
    direction: f64,
) -> Option<Chaos> {
    let never = AtomicBool::new(false);
    let own = own_error(mechanism, control, schedule, rows, &never)?;
    Chaos::of(mechanism, schedule, own, direction, &never)
}
