//! The paper's study: its figures 4 to 9, its table, and each of its claims checked, also under other
//! choices of what the paper leaves open.

mod claims;
mod estimate;
mod figures;
mod items;
mod judgement;
mod page;
mod parameters;
mod probe;
mod result;
mod variants;
mod verdict;

pub use estimate::{Estimate, RunMean};
pub use items::Item;
pub use parameters::{Origin, PaperParameter};
pub use result::{CaseResult, ClaimMoves, ClaimResult, Paper, VariantResult};
pub use variants::{CLEARANCES, Variant, scenarios};
pub use verdict::{ClaimVerdict, JudgedClaim};

use super::chaos;
use super::watch::Watch;
use crate::results::Folder;
use crate::results::{PAGE_FILE, SCENARIO_FILE, to_json};
use crate::results::{RunError, refused};
use crate::scenario::{Problem, Scenario};
use crate::simulate::Provenance;
use crate::study::StudyError;
use claims::CLAIMS;
use judgement::judge;
use rayon::iter::{IntoParallelIterator, IntoParallelRefIterator, ParallelIterator};
use std::fs;
use std::path::PathBuf;
use std::time::Instant as Clock;
use variants::{LARGE, machine};

/// The JSON file of the study, by which its folder is known.
pub const PAPER_FILE: &str = "paper.json";

/// What the study came to.
#[derive(Debug)]
pub struct Studied {
    /// All figures.
    pub paper: Paper,
    /// The text of `paper.json`.
    pub json: String,
    /// Where all files are.
    pub folder: PathBuf,
}

/// Simulated time in s of the study, by which its progress counts.
pub fn simulated_time(scenarios: &[(Variant, Scenario)], phases: usize) -> f64 {
    let runs = (scenarios.len() * CLEARANCES.len() * phases) as f64;
    scenarios.first().map_or(0.0, |(_, base)| runs * base.simulation.duration)
}

/// Simulates all variants and writes everything about them into `folder`. `scenarios` are those of
/// [`scenarios`], the scenario as it stands first. `watch` sees the time simulated so far, in s.
///
/// # Errors
/// [`StudyError`]; the folder is left as it was.
pub fn paper(
    scenarios: &[(Variant, Scenario)],
    phases: usize,
    folder: Folder,
    watch: &Watch,
) -> Result<Studied, StudyError> {
    let started = Clock::now();
    let variants = scenarios
        .par_iter()
        .map(|(variant, scenario)| variant_result(variant, scenario, phases, watch))
        .collect::<Result<Vec<_>, Problem>>()?;
    watch.ended()?;
    let base = &scenarios[0].1;
    let claims = CLAIMS.iter().enumerate().map(|(i, claim)| ClaimResult {
        label: claim.label,
        quote: claim.quote,
        place: claim.place,
        measure: claim.test.in_words(),
        limit: claim.limit.in_words(),
        judged: variants[0].claims[i].clone(),
        over_variants: ClaimMoves::of(variants.iter().map(|variant| &variant.claims[i])),
    });
    let mut paper = Paper {
        provenance: Provenance::of(base),
        seed: base.seed,
        duration_s: base.simulation.duration,
        settle_s: base.simulation.settle(),
        phases,
        clearances_m: CLEARANCES.into(),
        parameters: parameters::parameters(base, &machine(base, LARGE, 0, 1)?),
        claims: claims.collect(),
        variants,
        wall_s: 0.0,
        files: Vec::new(),
    };
    let pictures = figures::draw(base, &paper)?;
    let texts = [PAPER_FILE, SCENARIO_FILE, PAGE_FILE].map(str::to_owned);
    paper.files = texts.into_iter().chain(pictures.iter().map(|p| p.file.clone())).collect();
    paper.wall_s = started.elapsed().as_secs_f64();

    let json = to_json(&paper);
    let write = |name: &str, text: &str| fs::write(folder.file(name), text).map_err(refused(name));
    write(PAPER_FILE, &json)?;
    write(SCENARIO_FILE, &base.to_toml())?;
    for picture in &pictures {
        write(&picture.file, &picture.svg)?;
    }
    write(PAGE_FILE, &page::page(&paper, &pictures))?;
    let folder = folder.finish().map_err(RunError::from)?;
    Ok(Studied { paper, json, folder })
}

fn variant_result(
    variant: &Variant,
    scenario: &Scenario,
    phases: usize,
    watch: &Watch,
) -> Result<VariantResult, Problem> {
    let cases = CLEARANCES
        .par_iter()
        .map(|&clearance| case(scenario, clearance, phases, watch))
        .collect::<Result<Vec<_>, Problem>>()?;
    Ok(VariantResult {
        key: variant.key,
        label: variant.label,
        sets: variant.sets.clone(),
        scenario_hash: scenario.hash(),
        claims: CLAIMS.iter().map(|claim| judge(claim, &cases)).collect(),
        cases,
    })
}

/// All starts of a scenario at one clearance in m. `watch` sees how much time was simulated, in s.
///
/// # Errors
/// A motion table that cannot be read.
pub fn case(
    scenario: &Scenario,
    clearance: f64,
    phases: usize,
    watch: &Watch,
) -> Result<CaseResult, Problem> {
    let runs = (0..phases)
        .into_par_iter()
        .map(|start| {
            let mut machine = machine(scenario, clearance, start, phases)?;
            let mut measured = probe::measure(scenario, &mut machine, watch);
            // Chaos is claimed of the paper's machine.
            if clearance == LARGE
                && let Some(run) = &mut measured
            {
                let window = scenario.simulation.duration.min(chaos::WINDOW);
                let direction = start as f64 / phases as f64;
                let exponent = chaos::exponent(&machine.mechanism, window, direction);
                run.values[Item::Lyapunov as usize] = exponent.unwrap_or(f64::NAN);
            }
            Ok(measured)
        })
        .collect::<Result<Vec<_>, Problem>>()?;
    Ok(CaseResult::new(clearance, &runs))
}
