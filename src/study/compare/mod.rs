//! One motion under several contact models: the contact law, the physics engine's own contacts, and
//! ideal joints, over a list of steps and several starts.

pub mod by_law;
mod first_hit;
mod page;
mod pictures;
mod plan;
mod probe;
mod quantities;
mod result;
mod statistics;
mod table;
mod usable;
mod verdict;

pub use first_hit::{FirstHit, FirstHits};
pub use plan::{Options, SAMPLE_INTERVAL};
pub(in crate::study) use plan::{machine, tolerance};
pub(in crate::study) use probe::{CompareMeasured, Forces, measure, quantile};
pub use quantities::{ComparedQuantity, QUANTITIES};
pub use result::{ChaosResult, Comparison, NativeResult, RowResult, TrendResult};
pub use statistics::{Behaviour, Mean, Trend};
pub use usable::{NativeUse, QuantityVerdict};
pub use verdict::in_words;

use super::chaos::{self, Chaos, ComparedRow};
use super::watch::Watch;
use crate::engine;
use crate::results::Folder;
use crate::results::{PAGE_FILE, keep_scenario, scenario_files};
use crate::results::{RunError, refused};
use crate::scenario::{Law, Problem, Scenario};
use crate::simulate::{FIT_SPEED, Provenance};
use crate::study::StudyError;
use plan::{ComparePlan, plan};
use rayon::iter::{IntoParallelIterator, IntoParallelRefIterator, ParallelIterator};
use statrs::statistics::{Data, OrderStatistics};
use std::fs;
use std::path::PathBuf;
use std::time::Instant as Clock;

/// The JSON file of a comparison, by which its folder is known.
pub const COMPARE_FILE: &str = "compare.json";

const TABLE_FILE: &str = "compare.csv";
const SUMMARY_FILE: &str = "table.md";

/// What a comparison came to.
#[derive(Debug)]
pub struct Compared {
    /// All figures.
    pub comparison: Comparison,
    /// The text of `compare.json`.
    pub json: String,
    /// Where all files are.
    pub folder: PathBuf,
}

/// Simulated time in s of a comparison, by which its progress counts.
///
/// # Errors
/// A motion table that cannot be read, a machine without joints to compare.
pub fn simulated_time(scenario: &Scenario, options: &Options) -> Result<f64, Problem> {
    let plan = plan(scenario, options)?;
    Ok(plan.runs().len() as f64 * scenario.simulation.duration)
}

/// Compares the contact models on a scenario and writes everything about it into `folder`. `watch`
/// sees the time simulated so far, in s.
///
/// # Errors
/// [`StudyError`]; the folder is left as it was.
pub fn compare(
    scenario: &Scenario,
    options: &Options,
    folder: Folder,
    watch: &Watch,
) -> Result<Compared, StudyError> {
    let started = Clock::now();
    let plan = plan(scenario, options)?;
    let jobs = plan.runs();
    let results = jobs
        .par_iter()
        .map(|&(start, row)| {
            let row = plan.rows[row];
            let mut machine = machine(scenario, row.law, row.control, start, plan.starts)?;
            Ok(measure(scenario, &mut machine, watch))
        })
        .collect::<Result<Vec<CompareMeasured>, Problem>>()?;
    watch.ended()?;
    let looks = looks(scenario, &plan)?;

    // By row, then by start.
    let mut runs: Vec<Vec<CompareMeasured>> = vec![Vec::new(); plan.rows.len()];
    for ((_, row), measured) in jobs.iter().zip(results) {
        runs[*row].push(measured);
    }
    let mut comparison = Comparison {
        provenance: Provenance::of(scenario),
        seed: scenario.seed,
        drive: scenario.drive.mode,
        duration_s: scenario.simulation.duration,
        settle_s: scenario.simulation.settle(),
        starts: plan.starts,
        native: native(scenario)?,
        rows: plan.rows.iter().zip(&runs).map(|(row, runs)| row_result(row, runs)).collect(),
        trends: Vec::new(),
        first_hits: first_hit::first_hits(scenario, &plan)?,
        chaos: chaos_result(&looks),
        verdicts: Vec::new(),
        answer: Vec::new(),
        wall_s: started.elapsed().as_secs_f64(),
        files: Vec::new(),
    };
    comparison.trends = trends(&comparison);
    comparison.verdicts = verdict::verdicts(&comparison);
    comparison.answer = verdict::answer(&comparison);

    let pictures = pictures::draw(scenario, &comparison, &plan, &runs, &looks)?;
    let texts = [COMPARE_FILE, TABLE_FILE, SUMMARY_FILE, PAGE_FILE].map(str::to_owned).into_iter();
    let drawn = pictures.iter().map(|picture| picture.file.clone());
    comparison.files = texts.chain(scenario_files(scenario)).chain(drawn).collect();
    let json = crate::results::to_json(&comparison);
    let write = |name: &str, text: &str| fs::write(folder.file(name), text).map_err(refused(name));
    write(COMPARE_FILE, &json)?;
    write(TABLE_FILE, &table::csv(&comparison))?;
    write(SUMMARY_FILE, &table::markdown(&comparison))?;
    keep_scenario(scenario, &folder)?;
    for picture in &pictures {
        write(&picture.file, &picture.svg)?;
    }
    write(PAGE_FILE, &page::page(&comparison, &pictures))?;
    let folder = folder.finish().map_err(RunError::from)?;
    Ok(Compared { comparison, json, folder })
}

/// The native settings and where they come from.
fn native(scenario: &Scenario) -> Result<NativeResult, Problem> {
    let native = machine(scenario, Law::Native, tolerance(scenario), 0, 1)?.mechanism.native;
    let given = [scenario.native.frequency, scenario.native.damping_ratio];
    let origin = if given.iter().all(Option::is_some) {
        "given in the scenario".to_owned()
    } else {
        format!(
            "fitted to the contact law: a hit of the joints' mass at {FIT_SPEED} m/s lasts as long \
             and returns as much speed"
        )
    };
    Ok(NativeResult {
        restitution: native.restitution,
        frequency: native.frequency,
        damping_ratio: native.damping_ratio,
        iterations: native.iterations,
        predictive: native.predictive,
        origin,
    })
}

/// One pair of runs and one run's own error for each start.
fn looks(scenario: &Scenario, plan: &ComparePlan) -> Result<Vec<Chaos>, Problem> {
    let look = |start: usize| -> Result<Option<Chaos>, Problem> {
        let control = tolerance(scenario);
        let mut machine = machine(scenario, Law::HertzStep, control, start, plan.starts)?;
        machine.schedule.duration = machine.schedule.duration.min(chaos::WINDOW);
        let mechanism = &machine.mechanism;
        let mut rows = Vec::new();
        let done = engine::run(mechanism, control, machine.schedule, &mut |instant| {
            rows.push(ComparedRow::at(mechanism, instant));
        });
        let direction = start as f64 / plan.starts as f64;
        Ok(done
            .ok()
            .and_then(|_| chaos::look(mechanism, control, machine.schedule, &rows, direction)))
    };
    let looks = (0..plan.starts).into_par_iter().map(look).collect::<Result<Vec<_>, _>>()?;
    Ok(looks.into_iter().flatten().collect())
}

fn chaos_result(looks: &[Chaos]) -> Option<ChaosResult> {
    let lyapunov: Vec<f64> = looks.iter().filter_map(|look| look.lyapunov).collect();
    if lyapunov.is_empty() {
        return None;
    }
    let rate = Mean::of(lyapunov.iter().copied());
    let horizons: Vec<f64> =
        looks.iter().map(|look| look.horizon().unwrap_or(f64::INFINITY)).collect();
    let median = Data::new(horizons).median();
    Some(ChaosResult {
        lyapunov_exponent_1_s: rate,
        e_folding_s: (rate.mean > 3.0 * rate.sem).then_some(1.0 / rate.mean),
        predictability_horizon_s: median.is_finite().then_some(median),
        horizon_error_m: chaos::HORIZON_ERROR,
        displacement_m: chaos::DISPLACEMENT,
        window_s: chaos::WINDOW,
        pairs: lyapunov.len(),
    })
}

fn row_result(row: &plan::CompareRow, runs: &[CompareMeasured]) -> RowResult {
    let good = || runs.iter().filter(|run| run.halted.is_none());
    let faulty = || good().filter(|run| !run.faults.is_empty());
    let mean = |f: &dyn Fn(&CompareMeasured) -> f64| Mean::of(good().map(f));
    RowResult {
        law: row.law,
        step_s: row.control.step(),
        tolerance_m_s: row.control.tolerance(),
        resolved: row.resolved,
        starts: row.starts,
        halted: runs.len() - good().count(),
        halt: runs.iter().find_map(|run| run.halted.clone()),
        faulty: faulty().count(),
        faults: faulty().next().map_or(Vec::new(), |run| run.faults.clone()),
        steps_per_s: mean(&|run| run.steps_per_s).mean,
        wall_s_per_simulated_s: mean(&|run| run.cost).mean,
        quantities: (0..quantities::COUNT).map(|i| mean(&|run| run.values[i])).collect(),
    }
}

/// What each quantity tends to under each law that has steps to judge by.
fn trends(comparison: &Comparison) -> Vec<TrendResult> {
    let mut trends = Vec::new();
    for law in plan::LAWS {
        // The law's fixed steps are of second order, rapier's own of first.
        let order = if law == Law::Native { 1.0 } else { 2.0 };
        for (i, quantity) in QUANTITIES.iter().enumerate() {
            let points: Vec<(f64, Mean)> = comparison
                .rows_of(law)
                .filter(|row| row.resolved && row.halted == 0)
                .filter_map(|row| Some((row.step_s?, row.quantities[i])))
                .collect();
            trends.push(TrendResult {
                law,
                quantity: quantity.key,
                trend: statistics::trend(&points, order),
            });
        }
    }
    trends
}
