//! Time series of two runs over one another.

use crate::measure::bounded;
use crate::report::{Curve, Panel, Style};
use std::path::Path;

/// Points of a curve in a picture: more than a page has pixels.
const POINTS: usize = 2000;

/// A table of numbers over time.
#[derive(Clone, Debug, Default)]
pub struct TimeTable {
    /// Heads, `t` first.
    pub heads: Vec<String>,
    /// Column by column, as many as heads.
    pub columns: Vec<Vec<f64>>,
}

impl TimeTable {
    /// Reads the `timeseries.csv` of a run.
    ///
    /// # Errors
    /// What cannot be read, in words.
    pub fn read(path: &Path) -> Result<Self, String> {
        let wrong =
            |error: &dyn std::fmt::Display| format!("{}: cannot be read: {error}", path.display());
        let file = bounded::open(path, bounded::TABLE).map_err(|error| wrong(&error))?;
        let mut rows = csv::Reader::from_reader(file);
        let heads: Vec<String> =
            rows.headers().map_err(|error| wrong(&error))?.iter().map(str::to_owned).collect();
        let mut columns = vec![Vec::new(); heads.len()];
        for (line, row) in (2..).zip(rows.records()) {
            let row = row.map_err(|error| wrong(&error))?;
            for ((column, head), cell) in columns.iter_mut().zip(&heads).zip(&row) {
                // An empty cell is a figure that the row does not have.
                let value = if cell.is_empty() { Ok(f64::NAN) } else { cell.parse() };
                let told = |_| {
                    wrong(&format!("line {line}, column {head}: expected a number, found `{cell}`"))
                };
                column.push(value.map_err(told)?);
            }
        }
        if heads.first().map(String::as_str) != Some("t") || columns[0].len() < 2 {
            return Err(wrong(&"expected a column t and at least two rows"));
        }
        let rises = |pair: &[f64]| pair[0] < pair[1] && pair.iter().all(|t| t.is_finite());
        if let Some(row) = columns[0].windows(2).position(|pair| !rises(pair)) {
            return Err(wrong(&format!(
                "line {}: expected a time after that of the line before",
                row + 3
            )));
        }
        Ok(Self { heads, columns })
    }

    /// Times in s.
    pub fn times(&self) -> &[f64] {
        self.columns.first().map_or(&[], Vec::as_slice)
    }

    /// A column by its head.
    pub fn get(&self, head: &str) -> Option<&[f64]> {
        let place = self.heads.iter().position(|known| known == head)?;
        self.columns.get(place).map(Vec::as_slice)
    }

    /// The value of a column at time t by linear interpolation; none outside of the rows.
    fn at(times: &[f64], values: &[f64], t: f64) -> Option<f64> {
        let next = times.partition_point(|time| *time < t);
        if next == 0 {
            return (times.first() == Some(&t)).then(|| values[0]);
        }
        let (t0, t1) = (times[next - 1], *times.get(next)?);
        let share = (t - t0) / (t1 - t0);
        Some(values[next - 1] + share * (values[next] - values[next - 1]))
    }

    /// Root mean squares of a column of both over the times of the first in `from..=until` that both have, and of the
    /// second less the first.
    pub fn apart(&self, other: &Self, head: &str, [from, until]: [f64; 2]) -> Option<[f64; 3]> {
        let (mine, theirs) = (self.get(head)?, other.get(head)?);
        let pairs = self.times().iter().zip(mine).filter(|(t, _)| (from..=until).contains(*t));
        let pairs = pairs.filter_map(|(t, a)| Some((*a, Self::at(other.times(), theirs, *t)?)));
        let pairs: Vec<(f64, f64)> =
            pairs.filter(|(a, b)| a.is_finite() && b.is_finite()).collect();
        let rms = |of: &dyn Fn(&(f64, f64)) -> f64| {
            (pairs.iter().map(|pair| of(pair).powi(2)).sum::<f64>() / pairs.len() as f64).sqrt()
        };
        (!pairs.is_empty()).then(|| [rms(&|p| p.0), rms(&|p| p.1), rms(&|p| p.1 - p.0)])
    }
}

/// A column of both, one over the other, `scale` of the column's numbers drawn.
pub fn overlaid(
    both: [&TimeTable; 2],
    names: &[String; 2],
    head: &str,
    (title, y_label, scale): (&str, &str, f64),
) -> Option<Panel> {
    let curves = both.into_iter().zip(names).map(|(series, name)| {
        let values = series.get(head)?;
        let points: Vec<(f64, f64)> =
            series.times().iter().zip(values).map(|(t, value)| (*t, scale * value)).collect();
        let every = points.len().div_ceil(POINTS).max(1);
        let points = points.into_iter().step_by(every).collect();
        Some(Curve { name: name.clone(), points, style: Style::Solid })
    });
    let curves: Vec<Curve> = curves.collect::<Option<_>>()?;
    Some(Panel {
        title: title.to_owned(),
        x_label: "time (s)".into(),
        y_label: y_label.into(),
        curves,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_at_other_times_are_compared_in_between() {
        let of = |step: f64, add: f64| {
            let t: Vec<f64> = (0..11).map(|i| f64::from(i) * step).collect();
            let x = t.iter().map(|t| 2.0 * t + add).collect();
            TimeTable { heads: vec!["t".into(), "x".into()], columns: vec![t, x] }
        };
        let [_, _, difference] = of(0.1, 0.0).apart(&of(0.07, 0.5), "x", [0.0, 9.0]).unwrap();
        assert!((difference - 0.5).abs() < 1e-12);
        assert!(of(0.1, 0.0).apart(&of(0.1, 0.0), "y", [0.0, 9.0]).is_none());
    }
}
