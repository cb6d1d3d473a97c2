//! What a comparison of laws came to, and its table as a file.

use crate::simulate::Provenance;
use crate::study::compare::result::by_key;
use crate::study::compare::statistics::Mean;
use crate::study::compare::table::{cell, cells, heads};
use serde::Serialize;
use std::fmt::Write as _;

/// One motion under several laws. Figures leave out the first `settle_s` seconds of each run.
#[derive(Clone, Debug, Serialize)]
pub struct LawsCompared {
    /// Program, versions, scenario.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Simulated time of each run in s.
    pub duration_s: f64,
    /// Start left out in s.
    pub settle_s: f64,
    /// Starts that each figure is a mean over.
    pub starts: usize,
    /// Speed in m/s of the hit at which laws are matched.
    pub speed_m_s: f64,
    /// Share of it that the scenario's own law returns, and the others are asked for.
    pub restitution: f64,
    /// Law by law, the scenario's own first.
    pub rows: Vec<LawRow>,
    /// Quantity by quantity.
    pub dependences: Vec<Dependence>,
    /// Time of computing in s.
    pub wall_s: f64,
    /// Names of all files of the result.
    pub files: Vec<String>,
}

/// One law.
#[derive(Clone, Debug, Serialize)]
pub struct LawRow {
    /// Its name.
    pub law: &'static str,
    /// The key that was matched, where the law has one.
    pub key: Option<&'static str>,
    /// Its value.
    pub value: Option<f64>,
    /// Share of the speed that its hits return.
    pub returned: f64,
    /// Whether that is what was asked for.
    pub matched: bool,
    /// Runs that broke down, and are left out.
    pub halted: usize,
    /// Steps per simulated second.
    pub steps_per_s: f64,
    /// The compared quantities, as {key: {mean, sem}}.
    #[serde(serialize_with = "by_key")]
    pub quantities: Vec<Mean>,
}

/// Whether a quantity depends on the law.
#[derive(Clone, Debug, Serialize)]
pub struct Dependence {
    /// Its key.
    pub quantity: &'static str,
    /// Whether a law of equal restitution differs from the scenario's own by more than chaos explains.
    pub depends: bool,
    /// Those laws.
    pub differing: Vec<&'static str>,
    /// The law of equal restitution under which it is smallest.
    pub lowest: Option<&'static str>,
    /// The one under which it is largest.
    pub highest: Option<&'static str>,
}

/// A row per law. Times of computing are in the JSON alone: the same comparison gives the same table.
pub(super) fn csv(compared: &LawsCompared) -> String {
    let mut table = format!("law,key,value,returned,matched,halted,steps_per_s{}\n", heads());
    for row in &compared.rows {
        let value = row.value.map_or_else(String::new, |value| format!("{value:e}"));
        let (law, key, returned) = (row.law, row.key.unwrap_or_default(), cell(row.returned));
        let (matched, halted) = (row.matched, row.halted);
        // Writing to a string cannot fail.
        let _ = write!(table, "{law},{key},{value},{returned},{matched},{halted}");
        let _ = writeln!(table, ",{}{}", cell(row.steps_per_s), cells(&row.quantities));
    }
    table
}
