//! `compare.json`: what a comparison came to.

use super::first_hit::FirstHits;
use super::statistics::{Mean, Trend};
use super::usable::QuantityVerdict;
use crate::scenario::{DriveMode, Law};
use crate::simulate::Provenance;
use serde::Serialize;
use serde_json::{Map, Value};

/// The result of a comparison. Figures leave out the first `settle_s` seconds of each run.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Program, versions, scenario.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Kind of drive.
    pub drive: DriveMode,
    /// Simulated time of each run in s.
    pub duration_s: f64,
    /// Start left out in s.
    pub settle_s: f64,
    /// Starts that each figure is a mean over, but those of ideal joints, which need one only.
    pub starts: usize,
    /// Settings of the native contacts.
    pub native: NativeResult,
    /// Law by law and step by step.
    pub rows: Vec<RowResult>,
    /// What each quantity tends to under each law.
    pub trends: Vec<TrendResult>,
    /// The first hit, before chaos.
    pub first_hits: Option<FirstHits>,
    /// How long a prediction holds under the law.
    pub chaos: Option<ChaosResult>,
    /// What native contacts may be used for.
    pub verdicts: Vec<QuantityVerdict>,
    /// The same in words.
    pub answer: Vec<String>,
    /// Time of computing in s.
    pub wall_s: f64,
    /// What stands beside this file.
    pub files: Vec<String>,
}

/// How the native contacts were set.
#[derive(Clone, Debug, Serialize)]
pub struct NativeResult {
    /// Share of the speed that a hit after a flight keeps, beside the spring.
    pub restitution: f64,
    /// Natural frequency of the spring in Hz.
    #[serde(rename = "frequency_Hz")]
    pub frequency: f64,
    /// Its damping ratio.
    pub damping_ratio: f64,
    /// Sweeps of the solver per step.
    pub iterations: usize,
    /// Whether journals are stopped before they touch.
    pub predictive: bool,
    /// Where frequency and damping ratio come from.
    pub origin: String,
}

/// One row.
#[derive(Clone, Debug, Serialize)]
pub struct RowResult {
    /// The law.
    pub law: Law,
    /// Fixed step in s, if it is fixed.
    pub step_s: Option<f64>,
    /// Velocity error allowed for one step in m/s, if the step follows it.
    pub tolerance_m_s: Option<f64>,
    /// Whether the step resolves the law's hits.
    pub resolved: bool,
    /// Starts that it was run from.
    pub starts: usize,
    /// Runs that broke down, and are left out.
    pub halted: usize,
    /// Why the first of those did.
    pub halt: Option<String>,
    /// Runs with faults (energy that does not balance, rigid joints that came apart); they count like the others.
    pub faulty: usize,
    /// What the first of those says, in words.
    pub faults: Vec<String>,
    /// Steps per simulated second.
    pub steps_per_s: f64,
    /// Time of computing in s per simulated second, on one of the cores in use.
    pub wall_s_per_simulated_s: f64,
    /// The compared quantities, as {key: {mean, sem}}.
    #[serde(serialize_with = "by_key")]
    pub quantities: Vec<Mean>,
}

impl RowResult {
    /// What speaks against the row, in words.
    pub fn remark(&self) -> Option<String> {
        let mut said = Vec::new();
        if self.halted > 0 {
            said.push(format!("{} broke down", self.halted));
        }
        if !self.resolved {
            said.push("step too long".to_owned());
        } else if self.faulty > 0 {
            said.push(format!("{} with faults", self.faulty));
        }
        (!said.is_empty()).then(|| said.join(", "))
    }
}

/// What one quantity tends to under one law.
#[derive(Clone, Debug, Serialize)]
pub struct TrendResult {
    /// The law.
    pub law: Law,
    /// Key of the quantity.
    pub quantity: &'static str,
    /// What it does as the step shrinks.
    #[serde(flatten)]
    pub trend: Trend,
}

/// Chaos under the law.
#[derive(Clone, Debug, Serialize)]
pub struct ChaosResult {
    /// Largest Lyapunov exponent in 1/s, mean over pairs of runs.
    pub lyapunov_exponent_1_s: Mean,
    /// 1/λ in s; none where the exponent does not differ from zero by three standard errors.
    pub e_folding_s: Option<f64>,
    /// Time in s from which on the runs' own error exceeds `horizon_error_m`: median of the starts;
    /// none if it does not in most of them.
    pub predictability_horizon_s: Option<f64>,
    /// See `predictability_horizon_s`.
    pub horizon_error_m: f64,
    /// Distance of each pair at its start in m.
    pub displacement_m: f64,
    /// Time watched in s.
    pub window_s: f64,
    /// Number of pairs.
    pub pairs: usize,
}

pub(super) fn by_key<S: serde::Serializer>(
    means: &[Mean],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let entry = |(quantity, mean): (&super::quantities::ComparedQuantity, &Mean)| {
        let mean = serde_json::to_value(mean).unwrap_or(Value::Null);
        (quantity.key.to_owned(), mean)
    };
    let map: Map<String, Value> =
        super::quantities::QUANTITIES.iter().zip(means).map(entry).collect();
    map.serialize(serializer)
}

impl Comparison {
    /// The rows of a law.
    pub fn rows_of(&self, law: Law) -> impl Iterator<Item = &RowResult> {
        self.rows.iter().filter(move |row| row.law == law)
    }

    /// Rows that should be without faults and are not, in words: those of the law and of ideal joints, at steps that resolve
    /// them. (Steps that are too long are there to be seen, and the engine's own contacts are judged by the law.)
    pub fn faults(&self) -> Vec<String> {
        let judged = self.rows.iter().filter(|row| row.law != Law::Native && row.resolved);
        let faults = judged.flat_map(|row| {
            let how = match row.step_s {
                Some(step) => format!("a step of {step:e} s"),
                None => "the tolerance".to_owned(),
            };
            let runs = format!("{} at {how}", row.law.name());
            let halted = row.halt.iter().map(|reason| (row.halted, reason.clone()));
            let faulty = (row.faulty > 0).then(|| (row.faulty, row.faults.join("; ")));
            let said = halted.chain(faulty).collect::<Vec<_>>();
            said.into_iter()
                .map(move |(count, what)| format!("{runs}: {count} of {} runs: {what}", row.starts))
        });
        faults.collect()
    }

    /// The row of a law that is trusted most: the tolerance's, or the shortest step's.
    pub fn best(&self, law: Law) -> Option<&RowResult> {
        self.rows_of(law).last()
    }

    /// What a quantity tends to under a law.
    pub fn trend(&self, law: Law, quantity: &str) -> Option<&Trend> {
        let found = self.trends.iter().find(|t| t.law == law && t.quantity == quantity);
        found.map(|t| &t.trend)
    }
}
