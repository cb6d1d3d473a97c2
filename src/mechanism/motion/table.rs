//! A motion sampled in a CSV file.

use super::{Motion, PathPoint};
use crate::measure::spline::CubicSpline;
use nalgebra::Vector3;
use std::path::Path;

/// A motion through the rows of a table, by a cubic spline with continuous acceleration.
/// Before the first and after the last row it rests at that row's pose.
#[derive(Clone, Debug)]
pub struct Table {
    splines: [CubicSpline; 3],
}

/// Why a table cannot be a motion.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// The file cannot be read, or is no CSV of numbers.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// A column is missing.
    #[error("no column `{0}`; a table needs the columns t,x,y,phi (s, m, m, rad)")]
    Column(&'static str),
    /// A field is not a finite number.
    #[error("line {line}: column `{column}` holds `{text}`, which is not a finite number")]
    Number {
        /// Line of the file, from 1.
        line: u64,
        /// The column's name.
        column: &'static str,
        /// What stands there.
        text: String,
    },
    /// Time does not increase.
    #[error("line {line}: time {t} s does not come after {before} s")]
    Time {
        /// Line of the file, from 1.
        line: u64,
        /// Time of the row in s.
        t: f64,
        /// Time of the row before in s.
        before: f64,
    },
    /// Fewer than four rows.
    #[error("only {0} rows; a smooth motion needs at least 4")]
    Short(usize),
}

const COLUMNS: [&str; 4] = ["t", "x", "y", "phi"];

impl Table {
    /// Reads the columns `t,x,y,phi` (s, m, m, rad) of a CSV file; other columns are ignored.
    pub fn read(path: &Path) -> Result<Self, TableError> {
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path)?;
        let headers = reader.headers()?.clone();
        let mut indices = [0; 4];
        for (index, name) in indices.iter_mut().zip(COLUMNS) {
            *index = headers.iter().position(|h| h == name).ok_or(TableError::Column(name))?;
        }
        let mut columns: [Vec<f64>; 4] = Default::default();
        for record in reader.records() {
            let record = record?;
            let line = record.position().map_or(0, csv::Position::line);
            for ((values, &index), column) in columns.iter_mut().zip(&indices).zip(COLUMNS) {
                let text = record.get(index).unwrap_or("");
                let value = text.parse::<f64>().ok().filter(|v| v.is_finite());
                values.push(value.ok_or_else(|| TableError::Number {
                    line,
                    column,
                    text: text.to_owned(),
                })?);
            }
            if let [.., before, t] = columns[0][..]
                && t <= before
            {
                return Err(TableError::Time { line, t, before });
            }
        }
        let [t, x, y, phi] = columns;
        if t.len() < 4 {
            return Err(TableError::Short(t.len()));
        }
        Ok(Self { splines: [x, y, phi].map(|values| CubicSpline::natural(&t, &values)) })
    }
}

impl Motion for Table {
    fn at(&self, t: f64) -> PathPoint {
        let columns = self.splines.each_ref().map(|spline| spline.at(t));
        let pick = |k: usize| Vector3::from(columns.map(|c| c[k]));
        PathPoint { pose: pick(0), rate: pick(1), acceleration: pick(2) }
    }

    fn known_until(&self) -> f64 {
        self.splines[0].end()
    }
}
