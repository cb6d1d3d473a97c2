//! A motion sampled in a CSV file.

use super::{Motion, PathPoint};
use crate::measure::bounded;
use crate::measure::dialect::Rows;
use crate::measure::spline::CubicSpline;
use std::path::Path;

/// A motion through the rows of a table, by a cubic spline with continuous acceleration.
/// Before the first and after the last row it rests at that row's pose.
#[derive(Clone, Debug)]
pub struct Table {
    splines: Vec<CubicSpline>,
}

/// Why a table cannot be a motion.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// The file cannot be read, or is no CSV of numbers.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// A column is missing.
    #[error("no column `{missing}`; this table needs the columns {needed}")]
    Column {
        /// Its name.
        missing: String,
        /// All that are needed.
        needed: String,
    },
    /// A field is not a finite number.
    #[error("line {line}: column `{column}` holds `{text}`, which is not a finite number")]
    Number {
        /// Line of the file, from 1.
        line: u64,
        /// The column's name.
        column: String,
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

/// Reads the columns `names` of a CSV file, the first of them the time in s, and returns splines of the others
/// over it; other columns are ignored.
///
/// # Errors
/// A file that is no such table.
pub fn read_columns(path: &Path, names: &[&str]) -> Result<Vec<CubicSpline>, TableError> {
    let file = bounded::open_plain(path, bounded::TABLE).map_err(csv::Error::from)?;
    let mut rows = Rows::begin_unscaled(file)?;
    let headers = rows.heads().clone();
    let missing =
        |name: &&str| TableError::Column { missing: (*name).to_owned(), needed: names.join(",") };
    let index = |name: &&str| headers.iter().position(|h| h == *name).ok_or_else(|| missing(name));
    let indices = names.iter().map(index).collect::<Result<Vec<usize>, _>>()?;
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    let mut record = csv::StringRecord::new();
    while rows.next(&mut record)? {
        let line = record.position().map_or(0, csv::Position::line);
        for ((values, &index), column) in columns.iter_mut().zip(&indices).zip(names) {
            let text = record.get(index).unwrap_or("");
            values.push(rows.number(text).ok_or_else(|| TableError::Number {
                line,
                column: (*column).to_owned(),
                text: text.to_owned(),
            })?);
        }
        if let [.., before, t] = columns[0][..]
            && t <= before
        {
            return Err(TableError::Time { line, t, before });
        }
    }
    if columns[0].len() < 4 {
        return Err(TableError::Short(columns[0].len()));
    }
    Ok(columns[1..].iter().map(|values| CubicSpline::not_a_knot(&columns[0], values)).collect())
}

impl Table {
    /// Reads the columns `t,x,y,phi` (s, m, m, rad) of a CSV file, or `t,x,y` where the motion is a point's;
    /// other columns are ignored.
    ///
    /// # Errors
    /// A file that is no such table.
    pub fn read(path: &Path, of_point: bool) -> Result<Self, TableError> {
        let names: &[&str] = if of_point { &["t", "x", "y"] } else { &["t", "x", "y", "phi"] };
        Ok(Self { splines: read_columns(path, names)? })
    }
}

impl Motion for Table {
    fn at(&self, t: f64) -> PathPoint {
        let mut point = PathPoint::default();
        for (i, spline) in self.splines.iter().enumerate() {
            [point.pose[i], point.rate[i], point.acceleration[i]] = spline.at(t);
        }
        point
    }

    fn known_until(&self) -> f64 {
        self.splines[0].end()
    }

    fn shown_after(&self) -> f64 {
        self.known_until()
    }

    /// A wave that a table shows as one has ten points or so.
    fn fastest_turn(&self) -> f64 {
        10.0 * self.splines[0].shortest_interval()
    }
}
