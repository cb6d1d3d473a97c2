//! `diff.json`: what two have in common and what not.

use crate::report::number;
use crate::simulate::Provenance;
use serde::Serialize;

/// What two came to.
#[derive(Clone, Debug, Serialize)]
pub struct Diff {
    /// Program, versions; the first scenario.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// The second scenario.
    pub second: Provenance,
    /// What the two are called.
    pub names: [String; 2],
    /// `models`, each simulated from several starts, or `results`, each one run.
    pub of: &'static str,
    /// Starts that means and floors are taken over: 1 of results.
    pub starts: usize,
    /// Time in s from which on two runs of a chaotic machine have nothing to do with each other; null where they
    /// do to the end, and of models.
    pub predictable_until_s: Option<f64>,
    /// How many floors two figures have to lie apart to differ.
    pub sure: f64,
    /// The figures, one by one.
    pub rows: Vec<FigureRow>,
    /// What is to be known before a figure is believed.
    pub warnings: Vec<String>,
    /// What differs, in words.
    pub answer: String,
    /// Time of computing in s.
    pub wall_s: f64,
    /// What stands beside this file.
    pub files: Vec<String>,
}

/// One figure of both.
#[derive(Clone, Debug, Serialize)]
pub struct FigureRow {
    /// Its key, with the unit: a figure of summaries, or a column of time series.
    pub key: String,
    /// What it is called in words.
    pub label: String,
    /// Its unit in words.
    pub unit: &'static str,
    /// Both values: means over starts; of a column of results the root mean squares.
    pub values: [f64; 2],
    /// The second less the first; of a column of results the root mean square of that.
    pub difference: f64,
    /// By how much the two may differ by chance or by their own error: of means half of the 95 % interval of their
    /// difference, of positions of results the runs' own errors. Null where nobody knows.
    pub floor: Option<f64>,
    /// Whether they differ by more than [`Diff::sure`] floors; null without a floor.
    pub differs: Option<bool>,
    /// Whether each is one draw of a chaotic motion's peaks, means or counts.
    pub one_draw: bool,
}

impl Diff {
    /// A line a figure, SI units.
    pub(super) fn csv(&self) -> String {
        let mut table = csv::Writer::from_writer(Vec::new());
        let cell =
            |value: f64| if value.is_finite() { format!("{value:e}") } else { String::new() };
        // Writing to memory cannot fail.
        let _ = table.write_record([
            "quantity",
            "unit",
            "first",
            "second",
            "difference",
            "floor",
            "differs",
        ]);
        for row in &self.rows {
            let [a, b] = row.values.map(cell);
            let differs = row.differs.map_or(String::new(), |differs| differs.to_string());
            let floor = row.floor.map_or(String::new(), cell);
            let unit = row.unit.to_owned();
            let _ = table.write_record([
                row.key.clone(),
                unit,
                a,
                b,
                cell(row.difference),
                floor,
                differs,
            ]);
        }
        String::from_utf8(table.into_inner().unwrap_or_default()).unwrap_or_default()
    }

    /// What differs, in one sentence.
    pub(super) fn in_words(&self) -> String {
        let judged = || self.rows.iter().filter(|row| row.differs.is_some());
        let differing: Vec<&str> = judged()
            .filter(|row| row.differs == Some(true))
            .map(|row| row.label.as_str())
            .collect();
        let [a, b] = &self.names;
        let times = number(self.sure);
        match (judged().count(), differing.len()) {
            (0, _) => format!("{a} and {b} have no figure in common whose floor is known."),
            (all, 0) => {
                format!(
                    "{a} and {b} differ in none of {all} figures by more than {times} × their floors."
                )
            }
            (all, count) => {
                format!(
                    "{a} and {b} differ in {count} of {all} figures by more than {times} × their floors: {}.",
                    differing.join("; ")
                )
            }
        }
    }
}
