//! The first hit of a motion: the one place where digits of different steps and laws can be compared
//! before chaos has its say.

use super::plan::SAMPLE_INTERVAL;
use super::plan::{ComparePlan, CompareRow, machine, tolerance};
use super::statistics::{Mean, line};
use crate::engine::{self, Schedule, StepControl};
use crate::mechanism::Mechanism;
use crate::scenario::{Law, Problem, Scenario};
use serde::Serialize;

/// Time in s within which a first hit is waited for.
const PATIENCE: f64 = 0.1;

/// Time in s that a hit is given to pass its peak: twice what it lasts in the paper's machine.
const HIT: f64 = 6e-4;

/// Share of the tolerance with which the exact peak is computed.
const EXACT: f64 = 1e-4;

/// Peak force of the first hit, over the steps.
#[derive(Clone, Debug, Serialize)]
pub struct FirstHits {
    /// When the first hits come, mean of all starts, in s.
    pub time_s: f64,
    /// Their peak force under the law, from a run with a ten-thousandth of the tolerance, in N.
    #[serde(rename = "exact_peak_force_N")]
    pub exact: Mean,
    /// The law's error over the steps that resolve its hits: power of the step, which is the order of
    /// convergence, with its standard error.
    pub law_order: Option<[f64; 2]>,
    /// The same power of the native peak force itself: −1 where it grows as 1/step.
    pub native_power: Option<[f64; 2]>,
    /// Step by step.
    pub rows: Vec<FirstHit>,
}

/// First hits at one step.
#[derive(Clone, Debug, Serialize)]
pub struct FirstHit {
    /// The law.
    pub law: Law,
    /// Step in s.
    pub step_s: f64,
    /// Whether it resolves the law's hits.
    pub resolved: bool,
    /// Peak force, mean over the starts, in N.
    #[serde(rename = "peak_force_N")]
    pub peak: Mean,
    /// Relative error against the exact one, root mean square over the starts.
    pub relative_error: f64,
}

/// Looks at the first hit of every start. `None` where journals do not hit, or have not within 0.1 s.
///
/// # Errors
/// A motion table that cannot be read.
pub fn first_hits(scenario: &Scenario, plan: &ComparePlan) -> Result<Option<FirstHits>, Problem> {
    let rows: Vec<&CompareRow> = plan
        .rows
        .iter()
        .filter(|row| row.law != Law::Ideal && row.control.step().is_some())
        .collect();
    let mut times = Vec::new();
    let mut exact = Vec::new();
    let mut peaks = vec![Vec::new(); rows.len()];
    for start in 0..plan.starts {
        let fine = tolerance(scenario).with_tolerance_times(EXACT);
        let law = machine(scenario, Law::HertzStep, fine, start, plan.starts)?.mechanism;
        let patience = PATIENCE.min(scenario.simulation.duration);
        let Some(begin) = peak(&law, fine, patience).0 else { continue };
        times.push(begin);
        exact.push(peak(&law, fine, begin + HIT).1);
        let native = machine(scenario, Law::Native, fine, start, plan.starts)?.mechanism;
        for (row, peaks) in rows.iter().zip(&mut peaks) {
            let mechanism = if row.law == Law::Native { &native } else { &law };
            peaks.push(peak(mechanism, row.control, begin + HIT).1);
        }
    }
    if times.is_empty() {
        return Ok(None);
    }
    let rows: Vec<FirstHit> = rows
        .iter()
        .zip(&peaks)
        .filter_map(|(row, peaks)| {
            let error = |(peak, exact): (&f64, &f64)| (peak / exact - 1.0).powi(2);
            let squares = Mean::of(peaks.iter().zip(&exact).map(error)).mean;
            Some(FirstHit {
                law: row.law,
                step_s: row.control.step()?,
                resolved: row.resolved,
                peak: Mean::of(peaks.iter().copied()),
                relative_error: squares.sqrt(),
            })
        })
        .collect();
    let power = |law: Law, y: &dyn Fn(&FirstHit) -> f64| {
        let data: Vec<_> = rows
            .iter()
            .filter(|row| row.law == law && row.resolved && y(row) > 0.0)
            // Errors over a handful of starts are known to about a third.
            .map(|row| (row.step_s.ln(), y(row).ln(), 0.3))
            .collect();
        (data.len() > 1).then(|| line(&data)).map(|line| [line.slope, line.slope_std])
    };
    Ok(Some(FirstHits {
        time_s: Mean::of(times.into_iter()).mean,
        exact: Mean::of(exact.into_iter()),
        law_order: power(Law::HertzStep, &|row| row.relative_error),
        native_power: power(Law::Native, &|row| row.peak.mean),
        rows,
    }))
}

/// When a journal first touches (s), and the largest contact force (N) up to `until` s.
fn peak(mechanism: &Mechanism, control: StepControl, until: f64) -> (Option<f64>, f64) {
    let schedule = Schedule { duration: until, interval: SAMPLE_INTERVAL };
    let (mut begin, mut peak) = (None, 0.0f64);
    // A run that breaks down has its peak up to there.
    let _ = engine::run(mechanism, control, schedule, &mut |instant| {
        let force = instant.tallies.iter().fold(0.0f64, |peak, tally| peak.max(tally.peak));
        peak = peak.max(force);
        if force > 0.0 && begin.is_none() {
            begin = Some(instant.t);
        }
    });
    (begin, peak)
}
