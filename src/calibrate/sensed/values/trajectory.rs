//! Values from whole simulations: what residuals are wrong by depends on all values, and how bodies swing in
//! their play on some of them more sharply than any force shows. Where they rattle nobody can follow that swing, and what
//! the mean of several simulations predicts is held against the recording in its place.

use super::errors::{floors_of, in_floors};
use super::whole::Whole;
use crate::calibrate::sensed::motion::simulate::apart;
use crate::calibrate::sensed::residuals::baseline::Baseline;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Segment, Stopped};
use crate::calibrate::sensed::thresholds::{ALIKE, NOISE};
use crate::calibrate::values::least_squares::{FitEffort, least_squares};
use crate::calibrate::values::least_squares::{free, values, with_values};
use crate::effects::Setting;
use nalgebra::DVector;
use rayon::prelude::*;

/// Lengths in s over which values are fitted, one after another: a swing whose frequency is off by a hundredth
/// keeps its phase for so long at first. The whole follows.
const LENGTHS: [f64; 2] = [0.5, 1.2];

/// Steps of Gauss and Newton on each length, at most: where journals lift off a residual is rough, and
/// four end on its way down. And the drop of Σ of squares that is none: a look costs a simulation.
const EFFORT: FitEffort = FitEffort { steps: 10, enough: 2.0, secant: true };

/// The lengths of these runs, one after another, over which values of a model with these effects are fitted to one simulation
/// of it: as long as its replicas keep together, at least the first. What nothing holds falls for a while before they part,
/// and as far as that goes its start is known: the longest is all there.
///
/// # Errors
/// A machine that cannot be simulated.
pub fn followed(
    problem: &RigProblem,
    effects: &[Setting],
    on: &[Segment],
) -> Result<Vec<Option<f64>>, Stopped> {
    let mut lengths: Vec<Option<f64>> = LENGTHS.map(Some).into_iter().chain([None]).collect();
    let falls = problem.falls(effects)?;
    if problem.replicas == 1 && !falls {
        return Ok(lengths);
    }
    let logs = match problem.let_go(effects).and_then(|starts| problem.simulated(&starts, 2)) {
        Ok(logs) => logs,
        // One that breaks down beside another that does not is followed no further than any that rattles.
        Err(_) if !effects.is_empty() => return Ok(lengths.into_iter().take(1).collect()),
        Err(stopped) => return Err(stopped),
    };
    let alike = |length: &Option<f64>| {
        on.iter().all(|segment| {
            let [first, other] = [0, 1].map(|k| {
                let log = &logs[segment.run][k];
                log.first(length.unwrap_or(log.duration()))
            });
            apart(&problem.declared.sensors, &first, &other) < ALIKE
        })
    };
    let last = lengths.iter().rposition(alike).unwrap_or(0);
    lengths.truncate(last + 1);
    Ok(if falls { lengths.split_off(last) } else { lengths })
}

/// How far values are fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Far {
    /// Over the first of the lengths that can be [followed].
    First,
    /// Over all of them, unless more than [noise](NOISE) is left over one: a model that lacks something else besides gets no
    /// better by longer ones.
    Promising,
    /// Over all of them.
    All,
}

/// The effects at values that simulations of these runs agree with, from values near them on.
///
/// # Errors
/// A machine that cannot be simulated.
pub fn fitted(
    problem: &RigProblem,
    effects: &[Setting],
    on: &[Segment],
    far: Far,
) -> Result<Vec<Setting>, Stopped> {
    let mut effects = effects.to_vec();
    let mut reached = 0.0;
    loop {
        // Better values are followed further.
        let beyond = |length: &Option<f64>| length.unwrap_or(f64::INFINITY) > reached;
        let lengths: Vec<Option<f64>> =
            followed(problem, &effects, on)?.into_iter().filter(beyond).collect();
        let Some(last) = lengths.last() else { return Ok(effects) };
        reached = last.unwrap_or(f64::INFINITY);
        for length in lengths {
            let part: Vec<Segment> =
                on.iter().map(|segment| shorter(problem, segment, length)).collect();
            let baseline = || Baseline::of(problem, &effects, &[], &part);
            let whole = Whole::of(problem, &effects, &part, baseline)?;
            let mut left = f64::INFINITY;
            if let Some(fitted) = whole.fitted(&effects, EFFORT) {
                (effects, left) = fitted;
            }
            if far == Far::First || (far == Far::Promising && left > NOISE[1]) {
                return Ok(effects);
            }
        }
    }
}

/// The effects at values whose predictions of these runs, means of replicas that rattle, miss them least, from values
/// near them on; in as many steps as the work that is left to the problem allows for.
///
/// # Errors
/// A machine that cannot be simulated.
pub fn predicted(
    problem: &RigProblem,
    effects: &[Setting],
    on: &[Segment],
) -> Result<Vec<Setting>, Stopped> {
    let replicas = |effects: &[Setting], segment: &Segment| {
        let one = |replica| problem.one(effects, segment.run, segment.rows.end, replica);
        (0..problem.replicas as u64).into_par_iter().map(one).collect::<Result<Vec<_>, _>>()
    };
    let machine = &problem.declared;
    let before = problem.work();
    let floors: Vec<Vec<Option<f64>>> = on
        .iter()
        .map(|segment| Ok(floors_of(machine, &replicas(effects, segment)?)))
        .collect::<Result<_, Stopped>>()?;
    let look = |values: &[f64]| {
        let there = with_values(effects, values);
        let mut all = Vec::new();
        for (segment, floors) in on.iter().zip(&floors) {
            let simulated = replicas(&there, segment).ok()?;
            let seconds = simulated[0].interval * simulated[0].samples.saturating_sub(1) as f64;
            let recording = problem.runs[segment.run].recording.first(seconds);
            all.extend(in_floors(machine, &recording, &simulated, floors));
        }
        Some(DVector::from_vec(all))
    };
    let free = free(effects);
    // A free machine is let go anew with each value.
    let starts = problem.let_go(effects)?;
    let starts: u64 = on.iter().map(|segment| starts[segment.run].steps()).sum();
    let step = (problem.work() - before + starts) * (free.len() as u64 + 1);
    let effort =
        FitEffort { steps: EFFORT.steps.min((problem.left() / step.max(1)) as usize), ..EFFORT };
    let best = least_squares(&look, &free, values(effects), effort, None);
    Ok(best.map_or_else(|| effects.to_vec(), |best| with_values(effects, &best.values)))
}

/// The first so many seconds of a segment.
pub fn shorter(problem: &RigProblem, segment: &Segment, length: Option<f64>) -> Segment {
    let view = &problem.runs[segment.run].view;
    let Some(length) = length else { return segment.clone() };
    let rows = (length / (view.interval * view.stride as f64)) as usize;
    let rows = crate::calibrate::values::spectrum::fast_length(rows.max(1)) * view.stride;
    let end = segment.rows.end.min(segment.rows.start + rows);
    Segment { run: segment.run, rows: segment.rows.start..end }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Target, named};

    /// Predictions of a machine whose rod is not dragged take a drag away, unless no work is left for that.
    #[test]
    fn predictions_are_fitted_with_what_work_is_left() {
        let target = Target::Body("rod".to_owned());
        let start = [("force_Ns_m", 5.0), ("torque_Nms", 0.0)];
        let drag = vec![Setting::on(named("drag").unwrap(), target, &start)];
        let found = |problem: RigProblem| {
            let on: Vec<Segment> = problem
                .split()
                .on
                .iter()
                .map(|whole| shorter(&problem, whole, Some(0.3)))
                .collect();
            values(&predicted(&problem, &drag, &on).unwrap())
        };
        let fresh = || RigProblem::planar("planar-1");
        assert_eq!(found(fresh().worn_out()), [5.0, 0.0]);
        assert!(found(fresh())[0] < 2.5, "{:?}", found(fresh()));
    }
}
