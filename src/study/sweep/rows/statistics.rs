//! Runs that differ in nothing but where they start: means over the starts, with the interval that chaos leaves.

use super::journal::RunRows;
use super::row::{Status, status};
use crate::measure::student::t95;
use crate::study::compare::Mean;
use crate::study::sweep::Identity;
use csv::StringRecord;
use std::collections::BTreeMap;

/// The table of statistics.
pub(in crate::study::sweep) const FILE: &str = "statistics.csv";

/// Whether a varied number chooses a start alone: a phase of the motion, or the angle from which a crank turns. The seed does
/// not: runs draw no random numbers.
pub(in crate::study::sweep) fn is_start(path: &str) -> bool {
    path.ends_with(".phase") || path == "motion.start"
}

/// Whether there is a number of each kind among the varied ones, so that means over starts say something.
pub(in crate::study::sweep) fn has_starts(identity: &Identity) -> bool {
    varied(identity).any(|(_, path)| is_start(path))
}

/// The varied numbers with their columns.
fn varied(identity: &Identity) -> impl Iterator<Item = (usize, &String)> {
    identity.columns.iter().enumerate().take(identity.vary.len())
}

/// A figure over the starts of a group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::study::sweep) struct Spread {
    /// Mean.
    pub mean: f64,
    /// Half of its 95 % interval (Student's t); infinite of a single run.
    pub half: f64,
}

impl Spread {
    /// Of some runs.
    pub fn of(values: &[f64]) -> Self {
        let Mean { mean, sem } = Mean::of(values.iter().copied());
        let half = match values.len() {
            0 | 1 => f64::INFINITY,
            n => t95(n - 1) * sem,
        };
        Self { mean, half }
    }
}

/// Runs that differ in their starts alone.
#[derive(Clone, Debug)]
pub(in crate::study::sweep) struct StartsGroup {
    /// The varied values that they share, in the order of the columns.
    pub values: Vec<String>,
    /// How many there are.
    pub runs: usize,
    /// Their figures, in the order of the columns behind the varied ones; none of what is no number in any of them.
    pub figures: Vec<Option<Spread>>,
}

/// The groups of the runs that reached their end, in the order of their first runs.
pub(in crate::study::sweep) fn groups(identity: &Identity, rows: &RunRows) -> Vec<StartsGroup> {
    let shared: Vec<usize> =
        varied(identity).filter(|(_, path)| !is_start(path)).map(|(column, _)| column).collect();
    let mut places: BTreeMap<Vec<String>, usize> = BTreeMap::new();
    let mut found: Vec<(Vec<String>, Vec<&StringRecord>)> = Vec::new();
    for row in rows.values().filter(|row| status(row) == Status::Ok) {
        let values: Vec<String> =
            shared.iter().map(|column| row.get(*column).unwrap_or_default().to_owned()).collect();
        let place = *places.entry(values.clone()).or_insert(found.len());
        if place == found.len() {
            found.push((values, Vec::new()));
        }
        found[place].1.push(row);
    }
    let columns = identity.vary.len()..identity.columns.len();
    let group = |(values, rows): (Vec<String>, Vec<&StringRecord>)| {
        let figure = |column: usize| {
            let values = rows.iter().filter_map(|row| row.get(column)?.parse().ok());
            let values: Vec<f64> = values.collect();
            (!values.is_empty()).then(|| Spread::of(&values))
        };
        StartsGroup { values, runs: rows.len(), figures: columns.clone().map(figure).collect() }
    };
    found.into_iter().map(group).collect()
}

/// Names of the values that groups share.
pub(super) fn shared(identity: &Identity) -> Vec<&str> {
    let all = varied(identity).filter(|(_, path)| !is_start(path));
    all.map(|(_, path)| path.as_str()).collect()
}

/// The table: a row a group, with mean and ends of the 95 % interval of each figure.
pub(in crate::study::sweep) fn csv(identity: &Identity, groups: &[StartsGroup]) -> String {
    let mut table = csv::Writer::from_writer(Vec::new());
    let figures = &identity.columns[identity.vary.len()..];
    let some = |k: &usize| groups.iter().any(|group| group.figures[*k].is_some());
    let kept: Vec<usize> = (0..figures.len()).filter(some).collect();
    let heads = shared(identity).into_iter().map(str::to_owned).chain(["runs".to_owned()]);
    let of_figure =
        |k: &usize| ["mean", "ci95_low", "ci95_high"].map(|of| format!("{}_{of}", figures[*k]));
    // Writing to memory cannot fail.
    let _ = table.write_record(heads.chain(kept.iter().flat_map(of_figure)));
    for group in groups {
        let cell = |value: f64| if value.is_finite() { value.to_string() } else { String::new() };
        let cells = |k: &usize| match group.figures[*k] {
            Some(Spread { mean, half }) => [mean, mean - half, mean + half].map(cell),
            None => [const { String::new() }; 3],
        };
        let first = group.values.iter().cloned().chain([group.runs.to_string()]);
        let _ = table.write_record(first.chain(kept.iter().flat_map(cells)));
    }
    String::from_utf8(table.into_inner().unwrap_or_default()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_choose_starts() {
        for path in ["motion.phase", "motion.terms.0.phase"] {
            assert!(is_start(path), "{path}");
        }
        assert!(
            !is_start("seed") && !is_start("joints.clearance") && !is_start("effect.0.phase_rad")
        );
    }

    #[test]
    fn the_interval_is_students() {
        // Four values with standard deviation 1.29: 2.05 = 3.182 · 1.29/2.
        let Spread { mean, half } = Spread::of(&[1.0, 2.0, 3.0, 4.0]);
        assert!((mean - 2.5).abs() < 1e-12 && (half - 2.0539).abs() < 1e-3, "{half}");
        assert_eq!(Spread::of(&[1.0]).half, f64::INFINITY);
    }
}
