//! One motion under every contact law, at equal restitution where it can be matched: which results depend on the
//! law by more than their chaos.

mod matching;
mod page;
mod result;

pub use result::{Dependence, LawRow, LawsCompared};

use super::plan::{machine, no_contacts, tolerance};
use super::probe::{CompareMeasured, measure};
use super::quantities::{COUNT, QUANTITIES};
use super::statistics::Mean;
use crate::contact::laws::LawKind;
use crate::measure::student::t95;
use crate::results::Folder;
use crate::results::refused;
use crate::results::{PAGE_FILE, keep_scenario, scenario_files, to_json};
use crate::scenario::{Law, Problem, Scenario};
use crate::simulate::{FIT_SPEED, Provenance};
use crate::study::StudyError;
use crate::study::Watch;
use matching::{Matched, own, under};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use std::fs;
use std::path::PathBuf;
use std::time::Instant as Clock;

/// The JSON file of a comparison of laws, by which its folder is known.
pub const LAWS_COMPARED_FILE: &str = "compare-laws.json";

const TABLE_FILE: &str = "compare-laws.csv";

/// Half widths of a 95 % interval by which means must differ: a sixth of a per cent of differences by chance
/// exceed it, so that of all laws hardly one does.
const SURE: f64 = 1.5;

/// Relative difference below which no conclusion hangs on the law.
const LEAST_DIFFERENCE: f64 = 0.01;

/// A finished comparison and its files.
#[derive(Debug)]
pub struct FinishedByLaw {
    /// All figures.
    pub compared: LawsCompared,
    /// The text of [`LAWS_COMPARED_FILE`].
    pub json: String,
    /// Where the files are.
    pub folder: PathBuf,
}

/// Compares laws on a scenario, its own law first, and writes everything about it into `folder`. `watch`
/// sees the time simulated so far, in s.
///
/// # Errors
/// [`StudyError`]; the folder is left as it was.
pub fn compare_laws(
    scenario: &Scenario,
    kinds: &[&'static LawKind],
    starts: usize,
    folder: Folder,
    watch: &Watch,
) -> Result<FinishedByLaw, StudyError> {
    let started = Clock::now();
    let base = own(scenario)?;
    let others = others(kinds, base.kind)
        .par_iter()
        .map(|kind| under(scenario, kind, base.returned))
        .collect::<Result<Vec<Matched>, Problem>>()?;
    let asked = base.returned;
    let laws: Vec<Matched> = [base].into_iter().chain(others).collect();
    let runs = simulate(&laws, starts, watch)?;
    let rows: Vec<LawRow> = laws.iter().zip(&runs).map(|(law, runs)| row(law, runs)).collect();
    let mut compared = LawsCompared {
        provenance: Provenance::of(scenario),
        duration_s: scenario.simulation.duration,
        settle_s: scenario.simulation.settle(),
        starts,
        speed_m_s: FIT_SPEED,
        restitution: asked,
        dependences: (0..COUNT).map(|i| dependence(&rows, i, starts)).collect(),
        rows,
        wall_s: started.elapsed().as_secs_f64(),
        files: Vec::new(),
    };
    let pictures = page::pictures(&compared, &runs)?;
    let texts = [LAWS_COMPARED_FILE, TABLE_FILE, PAGE_FILE].map(str::to_owned).into_iter();
    let drawn = pictures.iter().map(|picture| picture.file.clone());
    compared.files = texts.chain(scenario_files(scenario)).chain(drawn).collect();
    let json = to_json(&compared);
    let write = |name: &str, text: &str| fs::write(folder.file(name), text).map_err(refused(name));
    write(LAWS_COMPARED_FILE, &json)?;
    write(TABLE_FILE, &result::csv(&compared))?;
    keep_scenario(scenario, &folder)?;
    for picture in &pictures {
        write(&picture.file, &picture.svg)?;
    }
    write(PAGE_FILE, &page::page(&compared, &pictures))?;
    let folder = folder.finish().map_err(crate::results::RunError::from)?;
    Ok(FinishedByLaw { compared, json, folder })
}

/// Simulated time of a comparison in s, by which its progress counts.
///
/// # Errors
/// A machine without a joint that a law acts in.
pub fn simulated_time(
    scenario: &Scenario,
    kinds: &[&'static LawKind],
    starts: usize,
) -> Result<f64, Problem> {
    let base = own(scenario)?;
    if !base.returned.is_finite() {
        return Err(no_contacts(scenario));
    }
    let laws = 1 + others(kinds, base.kind).len();
    Ok((laws * starts) as f64 * scenario.simulation.duration)
}

/// The laws of a list beside the first one.
fn others(kinds: &[&'static LawKind], first: &LawKind) -> Vec<&'static LawKind> {
    kinds.iter().copied().filter(|kind| *kind != first).collect()
}

/// All runs, law by law and start by start.
fn simulate(
    laws: &[Matched],
    starts: usize,
    watch: &Watch,
) -> Result<Vec<Vec<CompareMeasured>>, StudyError> {
    let jobs: Vec<(usize, usize)> =
        (0..laws.len()).flat_map(|law| (0..starts).map(move |start| (law, start))).collect();
    let results = jobs
        .par_iter()
        .map(|&(law, start)| {
            let law = &laws[law];
            let control = tolerance(&law.scenario);
            let mut machine = machine(&law.scenario, Law::of(law.kind), control, start, starts)?;
            Ok(measure(&law.scenario, &mut machine, watch))
        })
        .collect::<Result<Vec<CompareMeasured>, Problem>>()?;
    watch.ended()?;
    Ok(results.chunks(starts).map(<[CompareMeasured]>::to_vec).collect())
}

fn row(law: &Matched, runs: &[CompareMeasured]) -> LawRow {
    let good = || runs.iter().filter(|run| run.halted.is_none());
    LawRow {
        law: law.kind.name,
        key: law.chosen.map(|(key, _)| key),
        value: law.chosen.map(|(_, value)| value),
        returned: law.returned,
        matched: law.matched,
        halted: runs.len() - good().count(),
        steps_per_s: Mean::of(good().map(|run| run.steps_per_s)).mean,
        quantities: (0..COUNT).map(|i| Mean::of(good().map(|run| run.values[i]))).collect(),
    }
}

/// Whether a quantity differs between the first law and the others of equal restitution by more than chance.
fn dependence(rows: &[LawRow], i: usize, starts: usize) -> Dependence {
    let base = rows[0].quantities[i];
    let known = || rows.iter().filter(|row| row.matched && row.quantities[i].mean.is_finite());
    let differs = |row: &&LawRow| {
        let mean = row.quantities[i];
        let apart = (mean.mean - base.mean).abs();
        apart > SURE * t95(starts - 1) * mean.sem.hypot(base.sem)
            && apart > LEAST_DIFFERENCE * base.mean.abs()
    };
    let by_mean = |a: &&LawRow, b: &&LawRow| a.quantities[i].mean.total_cmp(&b.quantities[i].mean);
    let differing: Vec<&'static str> = known().filter(differs).map(|row| row.law).collect();
    Dependence {
        quantity: QUANTITIES[i].key,
        depends: !differing.is_empty(),
        differing,
        lowest: known().min_by(by_mean).map(|row| row.law),
        highest: known().max_by(by_mean).map(|row| row.law),
    }
}
