//! The whole way of a calibration by windows: everything that may be wrong is fitted at once, what is not certain
//! is left out, and the rest is fitted again.

use super::fitting::bench::Bench;
use super::fitting::eliminate::{KeptValues, eliminated, is_nothing};
use super::fitting::fits::WindowFits;
use super::fitting::sought::sought;
use super::score::{Horizon, Score, score};
use crate::calibrate::results::report::Fitted as Estimate;
use crate::calibrate::results::verdict::Verdict;
use crate::calibrate::sensed::events::Event;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::thresholds::{CERTAIN, HORIZONS, MET, OWN, WINDOWS};
use crate::effects::{Setting, Target, UNNAMED, named};
use crate::scenario::{Problem, Scenario};

/// An effect, estimates of its values, and what it takes off Σ of squares as windows vary.
#[derive(Clone, Debug)]
pub struct Certain {
    /// The effect.
    pub effect: Setting,
    /// Its values that were fitted.
    pub params: Vec<(&'static str, Estimate)>,
    /// `θᵀ C⁻¹ θ`.
    pub gain: f64,
}

/// An effect that was fitted and left out.
#[derive(Clone, Debug)]
pub struct LeftOut {
    /// The effect.
    pub effect: Setting,
    /// As of [`Certain`].
    pub gain: f64,
}

/// One run under the declared and the calibrated model.
#[derive(Clone, Debug)]
pub struct JudgedRun {
    /// Index of the run.
    pub run: usize,
    /// Windows.
    pub horizon: Horizon,
    /// Declared.
    pub before: Score,
    /// Calibrated.
    pub after: Score,
}

/// A calibration.
#[derive(Debug)]
pub struct WindowsOutcome {
    /// What it comes to.
    pub verdict: Verdict,
    /// What was found.
    pub effects: Vec<Certain>,
    /// What does not last.
    pub events: Vec<Event>,
    /// All effects of the calibrated model, declared ones among them.
    pub model: Vec<Setting>,
    /// What was fitted in vain.
    pub left_out: Vec<LeftOut>,
    /// Runs by horizons.
    pub judged: Vec<JudgedRun>,
    /// Zeros of each run's sensors by its first seconds, beside what the model says, with their deviations.
    pub zeros: Vec<Vec<[f64; 2]>>,
    /// Lengths in s of the windows that were fitted.
    pub lengths: Vec<f64>,
    /// Whether values could be told at all.
    pub fitted: bool,
}

/// Calibrates on the first `fits` runs.
///
/// # Errors
/// A rig that cannot be put together.
pub fn calibrate(
    rig: &Scenario,
    runs: Vec<Recording>,
    fits: usize,
    without: &[&str],
    tell: &(dyn Fn(&str) + Sync),
) -> Result<(Bench, WindowsOutcome), Problem> {
    let all = Bench::new(rig, runs)?;
    let bench = Bench::new(rig, all.runs[..fits].to_vec())?;
    let mut names = bench.unknown_zeros();
    if without.contains(&"encoder-zero") {
        names.fill(0.0);
    }
    let priors = vec![names.iter().map(|std| [0.0, *std]).collect(); fits];
    let mut search = WindowFits::new(&bench, priors, tell);
    let Fits { mut effects, mut model, left_out, known, fitted } =
        fit_and_leave_out(&bench, &mut search, without);
    tell("finding the zeros of runs");
    let found = zeros_of_all(&all, &model, &names, &known);
    effects.extend(found.iter().cloned());
    model.extend(found.into_iter().map(|certain| certain.effect));
    let mut calibrated = Bench::new(&with(rig, &model), all.runs)?;
    let events = match without.contains(&UNNAMED) {
        true => Vec::new(),
        false => {
            tell("looking for what does not last");
            calibrated.events()
        }
    };
    tell("predicting");
    if !events.is_empty() {
        model.extend(events.iter().map(Event::setting));
        calibrated = Bench::new(&with(rig, &model), calibrated.runs)?;
    }
    let (judged, zeros) = judge(&calibrated, rig)?;
    let held = |j: &&JudgedRun| j.run >= fits || fits == calibrated.runs.len();
    let held: Vec<&JudgedRun> = judged.iter().filter(held).collect();
    let verdict = verdict(&held, &events);
    if verdict == Verdict::NothingMissing {
        effects.clear();
        model.clone_from(&bench.declared);
    }
    let lengths = search.lengths;
    let outcome = WindowsOutcome {
        verdict,
        effects,
        events,
        model,
        left_out,
        judged,
        zeros,
        lengths,
        fitted,
    };
    Ok((calibrated, outcome))
}

/// What fits come to.
struct Fits {
    effects: Vec<Certain>,
    model: Vec<Setting>,
    left_out: Vec<LeftOut>,
    /// Zeros of the runs.
    known: Zeros,
    /// Whether values could be told at all.
    fitted: bool,
}

/// Fits everything that may be wrong at once, leaves out what is not certain, and fits the rest again.
fn fit_and_leave_out(bench: &Bench, search: &mut WindowFits, without: &[&str]) -> Fits {
    let everything = sought(&bench.mechanism, &bench.declared, &bench.runs, without);
    let first = search.stages(&everything, everything.start.clone(), &WINDOWS);
    let mut fits = Fits {
        effects: Vec::new(),
        model: bench.declared.clone(),
        left_out: Vec::new(),
        known: Vec::new(),
        fitted: first.is_some(),
    };
    let Some(values) = first else { return fits };
    let WindowFits { covariance, information, .. } = &*search;
    let KeptValues { fixed, values, gains } =
        eliminated(&everything, values, covariance.clone(), information);
    let named = everything.settings(&values);
    fits.left_out.extend(gains.iter().map(|&(i, gain)| LeftOut { effect: named[i].clone(), gain }));
    let rest = everything.with_fixed(&fixed, &values);
    let longest = search.lengths.last().copied().unwrap_or(WINDOWS[0]);
    let mut again =
        search.stages(&rest, rest.start.clone(), &[longest]).unwrap_or(rest.start.clone());
    fits.known = search.zeros_known();
    if search.lengths.len() == WINDOWS.len() {
        // A model that keeps its phase is judged by predictions, and fitted to them.
        search.predicts = true;
        again = search.stages(&rest, again.clone(), &[longest]).unwrap_or(again);
    }
    let (rest, again) = search.held_or_sliding(rest, again, longest, without);
    fits.model = rest.settings(&again);
    let gains = search.gains(&rest, &again);
    for (i, gain) in gains {
        let params = rest
            .names(i)
            .into_iter()
            .zip(rest.of(i))
            .map(|(name, k)| (name, Estimate::new(again[k], search.deviation(k))))
            .collect();
        fits.effects.push(Certain { effect: fits.model[i].clone(), params, gain });
    }
    fits.model.retain(|effect| !is_nothing(effect));
    fits
}

/// What runs that count say of the declared model and the calibrated one.
fn verdict(held: &[&JudgedRun], events: &[Event]) -> Verdict {
    let met = |score: &dyn Fn(&JudgedRun) -> &Score| {
        held.iter().all(|j| {
            let s = score(j);
            s.errors.iter().zip(&s.floors).all(|(e, f)| *e <= MET * f)
        })
    };
    match (met(&|j| &j.before), met(&|j| &j.after)) {
        (true, _) if events.is_empty() => Verdict::NothingMissing,
        (_, true) => Verdict::Explained,
        (_, false) => Verdict::Unexplained,
    }
}

/// Zeros of each run's sensors, with their standard deviations.
type Zeros = Vec<Vec<[f64; 2]>>;

/// A rig with other effects.
pub fn with(rig: &Scenario, effects: &[Setting]) -> Scenario {
    let mut rig = rig.clone();
    rig.effects = effects.to_vec();
    rig
}

/// Horizons that a bench's runs are judged by: where zeros belong to runs, from the seconds on that they are not
/// taken from.
pub fn horizons(bench: &Bench) -> Vec<Horizon> {
    let own = bench.zeros_of_runs().iter().any(|std| *std > 0.0);
    let from_s = if own { OWN } else { 0.0 };
    HORIZONS.iter().map(|&[window_s, fit_s]| Horizon { window_s, fit_s, from_s }).collect()
}

/// All runs under the model of a bench and under the rig as declared, and the zeros of runs.
fn judge(bench: &Bench, rig: &Scenario) -> Result<(Vec<JudgedRun>, Zeros), Problem> {
    let problem =
        || rig.problem("mechanism", "cannot be rolled along its runs", "check its masses");
    let zeros = bench.own_zeros(&bench.declared, &bench.zeros_of_runs()).ok_or_else(problem)?;
    let declared = Bench::new(rig, bench.runs.clone())?;
    let [before, after] = [&declared, bench].map(|bench| bench.machines(&bench.declared));
    let (before, after) = (before.ok_or_else(problem)?, after.ok_or_else(problem)?);
    let none = vec![0.0; bench.sensors.len()];
    let mut judged = Vec::new();
    for run in 0..bench.runs.len() {
        let own: Vec<f64> = zeros[run].iter().map(|[zero, _]| *zero).collect();
        for horizon in horizons(bench) {
            judged.push(JudgedRun {
                run,
                horizon,
                before: score(&declared, &before[run], &none, run, horizon),
                after: score(bench, &after[run], &own, run, horizon),
            });
        }
    }
    Ok((judged, zeros))
}

/// Zeros that are certainly off, as effects; `known` are those of the first runs, by all of them. Where they differ from run to run by more than they are known by,
/// with how much.
fn zeros_of_all(
    all: &Bench,
    model: &[Setting],
    stds: &[f64],
    known: &[Vec<[f64; 2]>],
) -> Vec<Certain> {
    /// Standard deviations of few runs' zeros are known to some tens of per cent.
    const FEW: f64 = 1.5;
    let Some(mut zeros) = all.own_zeros(model, stds) else { return Vec::new() };
    for (zeros, known) in zeros.iter_mut().zip(known) {
        // Whole runs say more than their first seconds.
        zeros.clone_from(known);
    }
    let Some(kind) = named("encoder-zero") else { return Vec::new() };
    let count = zeros.len() as f64;
    let mut found = Vec::new();
    for (i, sensor) in all.sensors.iter().enumerate() {
        if stds[i] == 0.0 {
            continue;
        }
        let column: Vec<[f64; 2]> = zeros.iter().map(|run| run[i]).collect();
        let gain: f64 = column.iter().map(|[zero, std]| (zero / std).powi(2)).sum();
        if !gain.is_finite() || gain < CERTAIN {
            continue;
        }
        let mean = column.iter().map(|[zero, _]| zero).sum::<f64>() / count;
        let own = (column.iter().map(|[_, std]| std * std).sum::<f64>() / count).sqrt();
        let spread = (column.iter().map(|[zero, _]| (zero - mean).powi(2)).sum::<f64>()
            / (count - 1.0).max(1.0))
        .sqrt();
        let run_std = if spread > 2.0 * own { FEW * spread } else { 0.0 };
        let target = Target::Sensors(vec![all.mechanism.sensors[*sensor].column.clone()]);
        let values = [("offset", mean), ("run_std", run_std)];
        let std = own.max(spread) / count.sqrt();
        found.push(Certain {
            effect: Setting::on(kind, target, &values),
            params: vec![
                ("offset", Estimate::new(mean, std)),
                ("run_std", Estimate::new(run_std, run_std / (2.0 * count).sqrt())),
            ],
            gain,
        });
    }
    found
}
