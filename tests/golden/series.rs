//! Time series, compared as long as they can be.

use crate::kept::{Differences, kept};

/// Until which time a difference may be how large, in units of the column's largest value.
pub type Limits = &'static [(f64, f64)];

/// In units of which a column of nothing but rounding is judged.
fn least(column: &str) -> f64 {
    match column {
        _ if column.starts_with("ecc_") => 1e-6,
        "x" | "y" | "phi" | "q1" | "q2" | "q3" => 1e-2,
        _ => 1.0,
    }
}

/// The names of the columns, and the rows.
pub fn rows(text: &str) -> (Vec<&str>, Vec<Vec<f64>>) {
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().unwrap();
    let number = |cell: &str| cell.parse().unwrap_or(f64::NAN);
    (head, lines.map(|line| line.into_iter().map(number).collect()).collect())
}

/// The series, whose first column is the time, against what is kept of it.
pub fn compare(name: &str, now: &str, limits: Limits) {
    let file = format!("{name}.csv");
    let kept = kept(&file, now);
    let ((head, kept), (head_now, now)) = (rows(&kept), rows(now));
    assert_eq!((head_now, now.len()), (head.clone(), kept.len()), "columns and rows of {file}");
    let mut differences = Differences::default();
    for (k, column) in head.iter().enumerate() {
        let scale = kept.iter().map(|row| row[k].abs()).fold(least(column), f64::max);
        for (row, row_now) in kept.iter().zip(&now) {
            let Some((_, limit)) = limits.iter().find(|(end, _)| row[0] <= end + 1e-9) else {
                break;
            };
            // Ten digits are written: the last may be another for no more than rounding.
            let limit = limit * scale + 1e-9 * row[k].abs();
            differences.number(&format!("{column} at {} s", row[0]), row[k], row_now[k], limit);
        }
    }
    differences.settle(&file);
}
