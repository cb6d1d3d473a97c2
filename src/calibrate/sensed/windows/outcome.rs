//! The whole way of a calibration by windows: everything that may be wrong is fitted at once, what is not certain
//! is left out, and the rest is fitted again.

use super::bench::Bench;
use super::score::{Horizon, Score, score};
use super::sought::{Sought, sought};
use super::window::{Window, cut};
use crate::calibrate::outcome::Verdict;
use crate::calibrate::report::Fitted as Estimate;
use crate::calibrate::sensed::events::Event;
use crate::calibrate::sensed::recording::Recording;
use crate::calibrate::sensed::thresholds::{CERTAIN, COVERED, HORIZONS, MET, OWN, PHASE, WINDOWS};
use crate::effects::{Setting, Target, UNNAMED, named};
use crate::scenario::{Problem, Scenario};
use nalgebra::{DMatrix, DVector};

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
pub struct Judged {
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
pub struct Outcome {
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
    pub judged: Vec<Judged>,
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
) -> Result<(Bench, Outcome), Problem> {
    let all = Bench::new(rig, runs)?;
    let bench = Bench::new(rig, all.runs[..fits].to_vec())?;
    let mut names = bench.unknown_zeros();
    if without.contains(&"encoder-zero") {
        names.fill(0.0);
    }
    let mut search = Search {
        priors: vec![names.iter().map(|std| [0.0, *std]).collect(); fits],
        scales: bench.motion().iter().map(|motion| 1e-3 * motion).collect(),
        lengths: Vec::new(),
        zeros: Vec::new(),
        covariance: DMatrix::zeros(0, 0),
        bench: &bench,
        tell,
    };
    let everything = sought(&bench.mechanism, &bench.declared, &bench.runs, without);
    let first = search.stages(&everything, everything.start.clone(), &WINDOWS);
    let mut left_out = Vec::new();
    let mut effects = Vec::new();
    let mut model = bench.declared.clone();
    let fitted = first.is_some();
    if let Some(values) = first {
        let gains = search.eliminated(&everything, &values);
        let dropped: Vec<usize> = gains.iter().map(|(i, _)| *i).collect();
        let named = everything.settings(&values);
        left_out.extend(gains.iter().map(|&(i, gain)| LeftOut { effect: named[i].clone(), gain }));
        let rest = everything.without(&dropped, &values);
        let longest = search.lengths.last().copied().unwrap_or(WINDOWS[0]);
        let again =
            search.stages(&rest, rest.start.clone(), &[longest]).unwrap_or(rest.start.clone());
        model = rest.settings(&again);
        let gains = search.gains(&rest, &again);
        for (i, gain) in gains {
            let params = rest
                .names(i)
                .into_iter()
                .zip(rest.of(i))
                .map(|(name, k)| (name, Estimate::new(again[k], search.deviation(k))))
                .collect();
            effects.push(Certain { effect: model[i].clone(), params, gain });
        }
    }
    tell("finding the zeros of runs");
    let found = zeros_of_all(&all, &model, &names, &search.zeros_known());
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
    let held = |j: &&Judged| j.run >= fits || fits == calibrated.runs.len();
    let met = |score: &dyn Fn(&Judged) -> &Score| {
        judged.iter().filter(held).all(|j| {
            let s = score(j);
            s.errors.iter().zip(&s.floors).all(|(e, f)| *e <= MET * f)
        })
    };
    let verdict = match (met(&|j| &j.before), met(&|j| &j.after)) {
        (true, _) if events.is_empty() => Verdict::NothingMissing,
        (_, true) => Verdict::Explained,
        (_, false) => Verdict::Unexplained,
    };
    if verdict == Verdict::NothingMissing {
        effects.clear();
        model.clone_from(&bench.declared);
    }
    let lengths = search.lengths;
    let outcome =
        Outcome { verdict, effects, events, model, left_out, judged, zeros, lengths, fitted };
    Ok((calibrated, outcome))
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
fn judge(bench: &Bench, rig: &Scenario) -> Result<(Vec<Judged>, Zeros), Problem> {
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
            judged.push(Judged {
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

/// Fits of one bench.
struct Search<'a> {
    bench: &'a Bench,
    priors: Vec<Vec<[f64; 2]>>,
    scales: Vec<f64>,
    lengths: Vec<f64>,
    zeros: Vec<Vec<f64>>,
    covariance: DMatrix<f64>,
    tell: &'a (dyn Fn(&str) + Sync),
}

impl Search<'_> {
    fn windows(&self, length: f64) -> Vec<Window> {
        let total: f64 = self.bench.runs.iter().map(Recording::duration).sum();
        let step = length * (total / COVERED).max(1.0);
        let runs = self.bench.runs.iter().enumerate();
        runs.flat_map(|(i, run)| {
            cut(i, run, &self.bench.sensors, [length, step], [0.0, f64::INFINITY])
        })
        .collect()
    }

    /// Values that fit windows of these lengths, one after another, as long as the model keeps the phase.
    fn stages(
        &mut self,
        sought: &Sought,
        mut values: Vec<f64>,
        lengths: &[f64],
    ) -> Option<Vec<f64>> {
        let motion = self.bench.motion();
        let mut done = false;
        for &length in lengths {
            let windows = self.windows(length);
            if windows.is_empty() {
                break;
            }
            (self.tell)(&format!("fitting windows of {length} s"));
            let mut priors = self.priors.clone();
            for (run, zeros) in self.zeros.iter().enumerate() {
                for (prior, zero) in priors[run].iter_mut().zip(zeros) {
                    // Where it goes on from; its prior is as wide as before.
                    prior[0] = *zero;
                }
            }
            let machines = |values: &[f64]| self.bench.machines(&sought.settings(values));
            let head = (0.3 * length / windows[0].rows.interval) as usize;
            let fit = |values: Vec<f64>, scales: Vec<f64>| {
                self.bench.fit(&machines, &windows, &sought.values, values, &priors, scales, head)
            };
            let Some(fitted) = fit(values.clone(), self.scales.clone()) else { break };
            let rows: f64 = windows.iter().map(|w| (w.rows.count + 1) as f64).sum();
            let missed = (fitted.squares / (rows * motion.len() as f64)).sqrt();
            values = fitted.values;
            self.zeros = fitted.zeros;
            self.covariance = fitted.covariance;
            if lengths.len() > 1 {
                self.lengths.push(length);
            }
            done = true;
            let share = missed * self.scales[0] / motion[0];
            (self.tell)(&format!(
                "windows of {length} s: {:.2} % of the motion is missed",
                100.0 * share
            ));
            if length > WINDOWS[0] && share > PHASE {
                break;
            }
        }
        done.then_some(values)
    }

    /// Zeros of the runs that were fitted, and their standard deviations.
    fn zeros_known(&self) -> Vec<Vec<[f64; 2]>> {
        let n = self.bench.sensors.len();
        let first = self.covariance.nrows().saturating_sub(n * self.zeros.len());
        let zero = |run: usize, i: usize| [self.zeros[run][i], self.deviation(first + run * n + i)];
        (0..self.zeros.len()).map(|run| (0..n).map(|i| zero(run, i)).collect()).collect()
    }

    fn deviation(&self, k: usize) -> f64 {
        self.covariance[(k, k)].max(0.0).sqrt()
    }

    /// What each effect's change from what is declared takes off, as windows vary: `θᵀ C⁻¹ θ`.
    fn gains(&self, sought: &Sought, values: &[f64]) -> Vec<(usize, f64)> {
        let change = self.change(sought, values);
        let effects = (0..sought.effects.len()).filter(|&i| !sought.of(i).is_empty());
        effects.map(|i| (i, gain(&self.covariance, &change, &sought.of(i)))).collect()
    }

    /// By how much values differ from what is declared; zeros of runs are no change.
    fn change(&self, sought: &Sought, values: &[f64]) -> DVector<f64> {
        DVector::from_fn(self.covariance.nrows(), |k, _| {
            sought.values.get(k).map_or(0.0, |value| values[k] - value.prior[0])
        })
    }

    /// Effects that are not certain, the least certain first: each is taken back to what is declared, and the
    /// others become what they then are, `θ − C_d C_dd⁻¹ θ_d` with covariance `C − C_d C_dd⁻¹ C_dᵀ`.
    fn eliminated(&self, sought: &Sought, values: &[f64]) -> Vec<(usize, f64)> {
        let mut change = self.change(sought, values);
        let mut covariance = self.covariance.clone();
        let mut left: Vec<usize> =
            (0..sought.effects.len()).filter(|&i| !sought.of(i).is_empty()).collect();
        let mut out = Vec::new();
        while let Some((least, lost)) = left
            .iter()
            .map(|&i| (i, gain(&covariance, &change, &sought.of(i))))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .filter(|(_, gain)| *gain < CERTAIN)
        {
            out.push((least, lost));
            left.retain(|i| *i != least);
            let places = sought.of(least);
            let across = covariance.select_columns(&places);
            let block = across.select_rows(&places);
            let part = change.select_rows(&places);
            let Some(inverse) = inverse(&block) else { continue };
            change -= &across * (&inverse * part);
            covariance -= &across * inverse * across.transpose();
        }
        out
    }
}

/// Inverse of a covariance, in units of its deviations; values that are not known at all are left alone.
fn inverse(block: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale: Vec<f64> = (0..block.nrows()).map(|i| block[(i, i)].max(1e-300).sqrt()).collect();
    let unit = DMatrix::from_fn(block.nrows(), block.ncols(), |i, j| {
        block[(i, j)] / (scale[i] * scale[j]) + if i == j { 1e-9 } else { 0.0 }
    });
    let inverse = unit.try_inverse()?;
    Some(DMatrix::from_fn(block.nrows(), block.ncols(), |i, j| {
        inverse[(i, j)] / (scale[i] * scale[j])
    }))
}

/// `θᵀ C⁻¹ θ` of some places.
fn gain(covariance: &DMatrix<f64>, change: &DVector<f64>, places: &[usize]) -> f64 {
    let block = covariance.select_columns(places).select_rows(places);
    let part = change.select_rows(places);
    inverse(&block).map_or(0.0, |inverse| part.dot(&(inverse * &part)))
}
