//! The tables of a comparison as files.

use super::quantities::{QUANTITIES, index};
use super::result::{Comparison, RowResult};
use super::statistics::Mean;
use super::verdict::in_words;
use crate::report::number;
use crate::scenario::Law;
use std::fmt::Write as _;

/// `compare.csv`: a row per law and step. Times of computing are in `compare.json` alone: the same
/// comparison gives the same table.
pub fn csv(comparison: &Comparison) -> String {
    let mut table = "law,step_s,tolerance_m_s,resolved,starts,halted,faulty,steps_per_s".to_owned();
    table += &heads();
    table.push('\n');
    for row in &comparison.rows {
        let (law, resolved) = (row.law.name(), row.resolved);
        let [step, tolerance] = [row.step_s, row.tolerance_m_s]
            .map(|v| v.map_or_else(String::new, |v| format!("{v:e}")));
        let runs = format!("{},{},{}", row.starts, row.halted, row.faulty);
        // Writing to a string cannot fail, here and below.
        let _ = write!(table, "{law},{step},{tolerance},{resolved},{runs}");
        let _ = writeln!(table, ",{}{}", cell(row.steps_per_s), cells(&row.quantities));
    }
    table
}

/// Heads of the columns of all quantities, each after a comma.
pub(super) fn heads() -> String {
    QUANTITIES.iter().map(|quantity| format!(",{0},{0}_sem", quantity.key)).collect()
}

/// Their cells.
pub(super) fn cells(quantities: &[Mean]) -> String {
    quantities.iter().map(|mean| format!(",{},{}", cell(mean.mean), cell(mean.sem))).collect()
}

/// A number; empty of none.
pub(super) fn cell(value: f64) -> String {
    if value.is_finite() { format!("{value:.6e}") } else { String::new() }
}

/// Columns of `table.md`: key of the quantity, heading. Of each kind of quantity the one that says most:
/// where the machine is, what its joints and its platform feel, how often.
const SHOWN: [(&str, &str); 4] = [
    ("rms_path_error_m", "rms path error"),
    ("peak_contact_force_N", "peak contact force"),
    ("peak_platform_acceleration_m_s2", "peak acceleration"),
    ("impacts_per_s", "impacts"),
];

/// `table.md`: what the README shows. The law at its tolerance, then native contacts at each step; the
/// first hit at the right, with the power of the step that its error (law) or itself (native) follows.
pub fn markdown(comparison: &Comparison) -> String {
    let headings: Vec<&str> = SHOWN.iter().map(|(_, heading)| *heading).collect();
    let mut table = format!(
        "| law, step | {} | first hit's peak force |\n|{}\n",
        headings.join(" | "),
        "---|".repeat(headings.len() + 2)
    );
    let law = comparison.best(Law::HertzStep);
    for row in law.into_iter().chain(comparison.rows_of(Law::Native)) {
        let cells = SHOWN.iter().filter_map(|(key, _)| {
            let i = index(key)?;
            Some(in_words(&QUANTITIES[i], row.quantities[i].mean))
        });
        let cells: Vec<String> = cells.collect();
        // Writing to a string cannot fail.
        let _ = writeln!(
            table,
            "| {} | {} | {} |",
            name(row),
            cells.join(" | "),
            first_hit(comparison, row).unwrap_or_default()
        );
    }
    table
}

fn name(row: &RowResult) -> String {
    let law = if row.law == Law::Native { "rapier's contacts" } else { "law" };
    let step = row.step_s.map_or("by tolerance".to_owned(), |step| format!("{step:e} s"));
    format!("{law}, {step}")
}

/// The first hit of a row; none where journals do not hit.
fn first_hit(comparison: &Comparison, row: &RowResult) -> Option<String> {
    let hits = comparison.first_hits.as_ref()?;
    if row.law == Law::HertzStep {
        let exact = number(hits.exact.mean);
        let order = hits.law_order.map(|[order, _]| format!(", error ∝ step^{order:.1}"));
        return Some(format!("{exact} N{}", order.unwrap_or_default()));
    }
    let native = || hits.rows.iter().filter(|hit| hit.law == row.law);
    let hit = native().find(|hit| Some(hit.step_s) == row.step_s)?;
    let peak = number(hit.peak.mean);
    // The power belongs to all steps: said once, at the last.
    let last = native().next_back().is_some_and(|last| last.step_s == hit.step_s);
    let power = hits.native_power.filter(|_| last).map(|[power, _]| format!(", ∝ step^{power:.1}"));
    Some(format!("{peak} N{}", power.unwrap_or_default()))
}
