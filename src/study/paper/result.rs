//! `paper.json`: what the study came to.

use super::estimate::RunMean;
use super::items::{COUNT, Item, QUANTITIES};
use super::parameters::PaperParameter;
use super::probe::PaperMeasured;
use super::verdict::{ClaimVerdict, JudgedClaim};
use crate::simulate::Provenance;
use crate::study::compare::ComparedQuantity;
use serde::{Serialize, Serializer};

/// The result of the study. Figures leave out the first `settle_s` seconds of each run.
#[derive(Clone, Debug, Serialize)]
pub struct Paper {
    /// Program, versions, scenario.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Simulated time of each run in s.
    pub duration_s: f64,
    /// Start left out in s.
    pub settle_s: f64,
    /// Starts that each figure is a mean over.
    pub phases: usize,
    /// Clearances of the study in m.
    pub clearances_m: Vec<f64>,
    /// The machine's parameters: what the paper says and what is used here.
    pub parameters: Vec<PaperParameter>,
    /// The claims under the scenario as it stands, and what becomes of them under the variants.
    pub claims: Vec<ClaimResult>,
    /// All variants, the scenario as it stands first.
    pub variants: Vec<VariantResult>,
    /// Time of computing in s.
    pub wall_s: f64,
    /// What stands beside this file.
    pub files: Vec<String>,
}

impl Paper {
    /// Variants with runs that broke down or have faults, in words.
    pub fn faults(&self) -> Vec<String> {
        let cases = self
            .variants
            .iter()
            .flat_map(|variant| variant.cases.iter().map(move |case| (variant.key, case)));
        let faults = cases.flat_map(|(key, case)| {
            let halted = (case.halted > 0).then(|| (case.halted, "broke down".to_owned()));
            let faulty = (case.faulty > 0).then(|| (case.faulty, case.faults.join("; ")));
            halted.into_iter().chain(faulty).map(move |(count, what)| {
                let (clearance, all) = (case.clearance_m, self.phases);
                format!("{key} at {clearance:e} m of clearance: {count} of {all} runs: {what}")
            })
        });
        faults.collect()
    }
}

/// One claim.
#[derive(Clone, Debug, Serialize)]
pub struct ClaimResult {
    /// The claim in a few words.
    pub label: &'static str,
    /// The paper's words.
    pub quote: &'static str,
    /// Where in the paper.
    pub place: &'static str,
    /// What `value` is.
    pub measure: String,
    /// When it counts as true.
    pub limit: String,
    /// Key, verdict, value, interval and evidence under the scenario as it stands.
    #[serde(flatten)]
    pub judged: JudgedClaim,
    /// What becomes of it as the assumptions move.
    pub over_variants: ClaimMoves,
}

/// A claim over all variants.
#[derive(Clone, Debug, Serialize)]
pub struct ClaimMoves {
    /// Number of variants that support it.
    pub supported: usize,
    /// Number of variants that contradict it.
    pub contradicted: usize,
    /// Number of variants that leave it open.
    pub undecided: usize,
    /// Smallest value of a variant.
    pub lowest: f64,
    /// Largest value of a variant; `null` where one is a ratio to nothing.
    pub highest: f64,
}

impl ClaimMoves {
    /// Of a claim's verdicts.
    pub fn of<'a>(judged: impl Iterator<Item = &'a JudgedClaim> + Clone) -> Self {
        let count = |verdict: ClaimVerdict| judged.clone().filter(|j| j.verdict == verdict).count();
        let values = || judged.clone().map(|j| j.estimate.value);
        Self {
            supported: count(ClaimVerdict::Supported),
            contradicted: count(ClaimVerdict::Contradicted),
            undecided: count(ClaimVerdict::Undecided),
            lowest: values().fold(f64::NAN, f64::min),
            highest: values().fold(f64::NAN, f64::max),
        }
    }

    /// Whether all variants give one verdict.
    pub fn agree(&self) -> bool {
        let counts = [self.supported, self.contradicted, self.undecided];
        counts.iter().filter(|count| **count > 0).count() == 1
    }
}

/// One variant.
#[derive(Clone, Debug, Serialize)]
pub struct VariantResult {
    /// Name.
    pub key: &'static str,
    /// What it is in words.
    pub label: &'static str,
    /// What it sets in the scenario.
    pub sets: Vec<String>,
    /// SHA-256 of its effective scenario.
    pub scenario_hash: String,
    /// One for each clearance.
    pub cases: Vec<CaseResult>,
    /// One for each claim.
    pub claims: Vec<JudgedClaim>,
}

/// All starts of a variant at one clearance.
#[derive(Clone, Debug, Serialize)]
pub struct CaseResult {
    /// Clearance of all joints in m.
    pub clearance_m: f64,
    /// Runs that broke down, and are left out.
    pub halted: usize,
    /// Runs with faults (energy that does not balance, rigid joints that came apart); they count like the others.
    pub faulty: usize,
    /// What the first of those says, in words.
    pub faults: Vec<String>,
    /// The measured quantities, as {key: {mean, sem, ci95, runs}}.
    #[serde(serialize_with = "by_key")]
    quantities: Vec<RunMean>,
}

impl CaseResult {
    /// Of the runs at one clearance in m; a run that broke down has no values.
    pub(super) fn new(clearance_m: f64, runs: &[Option<PaperMeasured>]) -> Self {
        let mean = |i: usize| RunMean::of(runs.iter().flatten().map(|run| run.values[i]));
        let faulty = || runs.iter().flatten().filter(|run| !run.faults.is_empty());
        Self {
            clearance_m,
            halted: runs.iter().filter(|run| run.is_none()).count(),
            faulty: faulty().count(),
            faults: faulty().next().map_or(Vec::new(), |run| run.faults.clone()),
            quantities: (0..COUNT).map(mean).collect(),
        }
    }

    /// The mean of an item.
    pub fn mean(&self, item: Item) -> &RunMean {
        &self.quantities[item as usize]
    }

    /// The measured quantities by name.
    pub fn quantities(&self) -> impl Iterator<Item = (&'static ComparedQuantity, &RunMean)> {
        QUANTITIES.iter().zip(&self.quantities)
    }
}

/// Quantities without data are left out: the Lyapunov exponent belongs to one clearance only.
fn by_key<S: Serializer>(means: &[RunMean], serializer: S) -> Result<S::Ok, S::Error> {
    let known = QUANTITIES.iter().zip(means).filter(|(_, mean)| mean.runs > 0);
    serializer.collect_map(known.map(|(quantity, mean)| (quantity.key, mean)))
}
