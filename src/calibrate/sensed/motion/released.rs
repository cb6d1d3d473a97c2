//! Where a machine was let go: one that drives hold rests at its first commands; where one that nothing holds began to
//! fall is fitted to what its sensors show.

use super::at_rest::let_go_at;
use super::simulate::{deviation, record, record_counting};
use super::start::{Closed, HeldJoint, LEAD, StartError, closed, placed, release, still};
use super::swinging::{OutputKicks, kicked, kicks_as_seen};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::values::least_squares::{Best, FitEffort, Free, least_squares};
use crate::calibrate::values::normal::inverse_normal;
use crate::effects::Setting;
use crate::engine::{Halt, StepControl};
use crate::mechanism::{Actuator, Drive, Mechanism};
use crate::scenario::Scenario;
use nalgebra::{DMatrix, DVector};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use std::sync::atomic::{AtomicU64, Ordering};

/// A machine that was let go.
#[derive(Clone, Debug)]
pub struct Released {
    /// The machine.
    pub machine: Mechanism,
    /// Coordinates in m or rad, at the first row, of the joints that its drives leave free and that held it there.
    pub coordinates: Vec<f64>,
    /// The same at rest shortly before the first row, where it is kicked from there on to swing as was recorded.
    pub at_rest: Option<Mechanism>,
    /// Their covariance, as far as the recording leaves them open; none where nothing was fitted.
    covariance: Option<DMatrix<f64>>,
    /// Steps of bodies that it took to find them.
    pub steps: u64,
}

impl Released {
    /// One from these coordinates, without a covariance.
    fn from(machine: Mechanism, coordinates: Vec<f64>) -> Self {
        Self { machine, coordinates, at_rest: None, covariance: None, steps: 0 }
    }

    /// The machine at rest under its first commands, shortly before the first row, without a swing; none of one that begins
    /// at the first row.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn still(&self, control: StepControl) -> Result<Option<Mechanism>, Halt> {
        match &self.at_rest {
            Some(machine) => Ok(Some(machine.clone())),
            None => still(&self.machine, control),
        }
    }

    /// The same with the swing that a recording shows, where it is another than that with which it is let go.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn swinging_as(self, recording: &Recording, control: StepControl) -> Result<Self, Halt> {
        let Some(still) = self.still(control)? else { return Ok(self) };
        let recorded = |machine: &Mechanism, like: &Recording| record(machine, control, like, 0);
        match kicks_as_seen(&self.machine, &still, recording, &recorded)? {
            Some(kicks) => self.with_kicks(&kicks, control),
            None => Ok(self),
        }
    }

    /// The same with a swing by these kicks, where it rests before the first row.
    ///
    /// # Errors
    /// A run that broke down.
    pub fn with_kicks(self, kicks: &OutputKicks, control: StepControl) -> Result<Self, Halt> {
        let Some(still) = self.still(control)? else { return Ok(self) };
        Ok(Self { machine: kicked(&still, kicks), at_rest: Some(still), ..self })
    }

    /// Whether where it was let go was fitted to a recording.
    pub fn is_fitted(&self) -> bool {
        self.covariance.is_some()
    }

    /// Coordinates as far from those that were fitted as nobody knows them, drawn by a number.
    pub fn drawn(&self, number: u64) -> Vec<f64> {
        let factor = self.covariance.clone().and_then(DMatrix::cholesky);
        let Some(factor) = factor else { return self.coordinates.clone() };
        let mut random = ChaCha8Rng::seed_from_u64(number);
        random.set_stream(STARTS);
        let away =
            DVector::from_fn(self.coordinates.len(), |_, _| StandardNormal.sample(&mut random));
        let away: DVector<f64> = factor.l() * away;
        self.coordinates.iter().zip(&away).map(|(value, away)| value + away).collect()
    }
}

/// Stream of random numbers that starts are drawn from, beside those of effects' values.
const STARTS: u64 = 1;

/// The machine of a rig with these effects as it was let go: a driven one at rest at its first commands, some
/// time before the first row, or, where a sampled controller holds it, where it was at the first row; one that drives
/// leave free after it was held there, at the first row.
///
/// # Errors
/// An effect that the machine cannot take, joints that do not close, a run that breaks down.
pub fn released(
    rig: &Scenario,
    effects: &[Setting],
    recording: &Recording,
    control: StepControl,
) -> Result<Released, StartError> {
    let Closed { mut mechanism, held } = closed(rig, effects, recording, None)?;
    if held.is_empty() {
        for body in &mut mechanism.bodies {
            body.start.twist.fill(0.0);
        }
        release(&mut mechanism, 0);
        let sampled = |drive: &Actuator| matches!(drive.drive, Drive::Sampled(_));
        if mechanism.actuators.iter().any(sampled) {
            placed(&mut mechanism, recording);
            mechanism.epoch = 0.0;
        } else {
            mechanism.epoch = -LEAD;
        }
        return Ok(Released::from(mechanism, Vec::new()));
    }
    let falling = Falling::of(rig, effects, recording, &held, control);
    let values = held.iter().map(|joint| joint.value).collect();
    let (values, covariance) = falling.fitted(values);
    falling.released(values, covariance)
}

/// The same machine from near `coordinates`, which something else than its start told, where from there it does more of what
/// was recorded than `known`.
///
/// # Errors
/// As of [`released`].
pub fn released_near(
    rig: &Scenario,
    effects: &[Setting],
    recording: &Recording,
    (known, coordinates): (Released, &[f64]),
    control: StepControl,
) -> Result<Released, StartError> {
    let held = closed(rig, effects, recording, None)?.held;
    let falling = Falling::of(rig, effects, recording, &held, control);
    let best = falling.best(coordinates, recording.duration());
    let before = falling.missed(&known.coordinates, recording.duration());
    let (Some(best), Some(before)) = (best, before) else { return Ok(known) };
    if best.residual.norm_squared() >= before.norm_squared() {
        return Ok(known);
    }
    let covariance = uncertainty(&best);
    falling.released(best.values, covariance)
}

/// A machine with these effects that nothing holds where a recording begins.
struct Falling<'a> {
    rig: &'a Scenario,
    effects: &'a [Setting],
    recording: &'a Recording,
    /// Sensors that show where it was let go.
    sensors: Vec<usize>,
    control: StepControl,
    /// Steps of bodies so far.
    steps: AtomicU64,
}

impl<'a> Falling<'a> {
    fn of(
        rig: &'a Scenario,
        effects: &'a [Setting],
        recording: &'a Recording,
        held: &[HeldJoint],
        control: StepControl,
    ) -> Self {
        let sensors = held.iter().map(|joint| joint.sensor).collect();
        Self { rig, effects, recording, sensors, control, steps: AtomicU64::new(0) }
    }

    fn let_go(&self, values: &[f64]) -> Result<Mechanism, StartError> {
        let held = let_go_at(self.rig, self.effects, self.recording, values, self.control)?;
        self.steps.fetch_add(held.steps(), Ordering::Relaxed);
        Ok(held.machine)
    }

    /// The machine let go at these coordinates, of this covariance.
    fn released(
        self,
        coordinates: Vec<f64>,
        covariance: Option<DMatrix<f64>>,
    ) -> Result<Released, StartError> {
        let machine = self.let_go(&coordinates)?;
        let steps = self.steps.into_inner();
        Ok(Released { covariance, steps, ..Released::from(machine, coordinates) })
    }

    /// Coordinates near these that do most of what is recorded, over as long as the model shows that, and their covariance.
    fn fitted(&self, coordinates: Vec<f64>) -> (Vec<f64>, Option<DMatrix<f64>>) {
        let lengths = lengths(self.recording.duration());
        let mut known = (coordinates, None);
        // The length that was shown last from what a shorter one told.
        let mut passed = None;
        for (k, &seconds) in lengths.iter().enumerate() {
            let (first, last) = (k == 0, k + 1 == lengths.len());
            let shows = |left: DVector<f64>| mean_square(&left) <= KEPT;
            if !(first || last) && self.missed(&known.0, seconds).is_some_and(shows) {
                passed = Some(seconds);
                continue;
            }
            let told = |best: Best| (uncertainty(&best), best.values);
            let best = self.best(&known.0, seconds);
            // What a model does not show is no reason to have started elsewhere.
            let shown = best.as_ref().is_some_and(|best| mean_square(&best.residual) <= KEPT);
            let best = match passed.take() {
                Some(seconds) if !shown => self.best(&known.0, seconds),
                _ => best.filter(|_| shown || first),
            };
            if let Some((covariance, coordinates)) = best.map(told) {
                known = (coordinates, covariance);
            }
            if !shown {
                break;
            }
        }
        known
    }

    /// Coordinates near these that do most of what the first `seconds` show.
    fn best(&self, coordinates: &[f64], seconds: f64) -> Option<Best> {
        let look = |coordinates: &[f64]| self.missed(coordinates, seconds);
        let free = vec![Free { step: SMALL, bounds: [-f64::MAX, f64::MAX] }; coordinates.len()];
        least_squares(&look, &free, coordinates.to_vec(), EFFORT, None)
    }

    /// By how much it misses what the first `seconds` of the recording show of that, in units of noise, let go at
    /// these coordinates; none where there is no such machine.
    fn missed(&self, values: &[f64], seconds: f64) -> Option<DVector<f64>> {
        let part = self.recording.first(seconds);
        let machine = self.let_go(values).ok()?;
        let (simulated, steps) =
            record_counting(&machine, self.control, &part, 0, u64::MAX).ok()?;
        self.steps.fetch_add(steps, Ordering::Relaxed);
        let mut left = Vec::new();
        for &sensor in &self.sensors {
            let pair = part.get(sensor).zip(simulated.get(sensor));
            let Some((measured, simulated)) = pair else { continue };
            let unit = deviation(&machine.sensors[sensor], measured);
            left.extend(measured.iter().zip(simulated).map(|(a, b)| (a - b) / unit));
        }
        Some(DVector::from_vec(left))
    }
}

/// The covariance of coordinates that were fitted.
fn uncertainty(best: &Best) -> Option<DMatrix<f64>> {
    let inverse = best.jacobian.as_ref().and_then(inverse_normal);
    inverse.map(|inverse| inverse * mean_square(&best.residual).max(1.0))
}

fn mean_square(left: &DVector<f64>) -> f64 {
    left.norm_squared() / left.len().max(1) as f64
}

/// Time in s from the first row over which the start of a free machine is fitted first: a start that is wrong by fifty
/// steps of an encoder then shows as such, and once journals have hit their rings some times no longer, which those of a small
/// machine do within 0.05 s. [Longer](LONGER) ones follow, again and again, while the model shows that: many rows average a
/// sensor's steps.
const SEEN: f64 = 0.0125;

/// How much longer each of these is than the one before, at most: what a start is off by at its end grows with it, and is still
/// small beside a swing. Fits over twice as long each time take half as long again.
const LONGER: f64 = 4.0;

/// Lengths in s over which a start is fitted, one after another, up to the whole of a recording.
fn lengths(whole: f64) -> Vec<f64> {
    let count = (whole / SEEN).max(1.0).log(LONGER).ceil();
    let left = |k: usize| if count > 0.0 { 1.0 - k as f64 / count } else { 0.0 };
    (0..=count as usize).map(|k| whole * (SEEN / whole).powf(left(k))).collect()
}

/// Mean square in units of noise up to which it does: a model that lacks an effect of the size of noise may be
/// right about the start.
const KEPT: f64 = 4.0;

/// Steps of that fit on each length, at most, and the drop of Σ of squares in units of noise that is none: a slow error
/// of a third of a sensor's steps shows only in many rows together, so that their mean square does not tell.
const EFFORT: FitEffort = FitEffort { steps: 6, enough: 1.0, secant: true };

/// A small change of a coordinate in m or rad: far above rounding, far below a swing.
pub const SMALL: f64 = 1e-4;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::parts_of;

    #[test]
    fn lengths_grow_fourfold_at_most_up_to_the_whole() {
        let all = lengths(4.0);
        assert!((all[0] - SEEN).abs() < 1e-12 && all.last() == Some(&4.0), "{all:?}");
        assert!(all.windows(2).all(|pair| pair[1] / pair[0] <= LONGER), "{all:?}");
        assert_eq!(lengths(0.01), [0.01]);
    }

    /// Starts are drawn as far apart as their covariance says, and where they were fitted without one.
    #[test]
    fn starts_are_drawn_as_far_apart_as_they_are_open() {
        let covariance = DMatrix::from_row_slice(2, 2, &[4.0, 1.0, 1.0, 1.0]);
        let rig = include_str!("../../../../assets/rigs-planar/planar-4/rig.toml");
        let machine = parts_of(&Scenario::from_text(rig, "rig", &[]).unwrap()).unwrap();
        let mut released =
            Released { covariance: Some(covariance), ..Released::from(machine, vec![5.0, -7.0]) };
        let drawn: Vec<Vec<f64>> = (0..4000).map(|number| released.drawn(number)).collect();
        let product = |i: usize, j: usize| {
            let of =
                |d: &Vec<f64>| (d[i] - released.coordinates[i]) * (d[j] - released.coordinates[j]);
            drawn.iter().map(of).sum::<f64>() / drawn.len() as f64
        };
        assert!((product(0, 0) - 4.0).abs() < 0.4, "{}", product(0, 0));
        assert!((product(0, 1) - 1.0).abs() < 0.2, "{}", product(0, 1));
        assert!((product(1, 1) - 1.0).abs() < 0.1, "{}", product(1, 1));
        released.covariance = None;
        assert_eq!(released.drawn(3), released.coordinates);
    }
}
