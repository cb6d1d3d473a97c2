//! The rows of a file of samples, put on a grid where they came early or late.

use super::cells::Cells;
use super::columns::Places;
use crate::calibrate::sensed::thresholds::{LATE, LATE_SHARE, LATE_STEPS};
use crate::measure::dialect::Rows;
use crate::measure::log::{LogError, constant_step};
use crate::measure::spline::CubicSpline;
use crate::mechanism::Sensor;

/// What is wrong with a file, on a line of it.
pub fn wrong(file: &str, line: Option<u64>, message: String, help: String) -> LogError {
    let place = line.map_or_else(|| file.to_owned(), |line| format!("{file}:{line}"));
    LogError { place, message, help }
}

/// What to say of a file that cannot be read.
pub fn unread(file: &str, error: &csv::Error) -> LogError {
    let line = error.position().map(csv::Position::line);
    let message = format!("cannot be read: {error}");
    wrong(
        file,
        line,
        message,
        "expected a CSV file with a header, and in each row as many values as it has names"
            .to_owned(),
    )
}

/// A row of a file.
pub struct FileRow<'a> {
    pub rows: &'a Rows,
    pub record: &'a csv::StringRecord,
    pub heads: &'a csv::StringRecord,
    pub file: &'a str,
}

impl FileRow<'_> {
    fn number(&self, place: usize) -> Result<f64, LogError> {
        let text = self.record.get(place).unwrap_or_default();
        self.rows.number(text).ok_or_else(|| {
            let what = if text.is_empty() { "nothing" } else { text };
            let message = format!("column `{}` holds {what}", &self.heads[place]);
            let line = self.record.position().map(csv::Position::line);
            let help = "expected a finite number in every row".to_owned();
            wrong(self.file, line, message, help)
        })
    }
}

/// What rows hold.
pub struct Samples {
    /// Times in s.
    pub times: Vec<f64>,
    /// Sensor by sensor.
    pub columns: Vec<Option<Vec<f64>>>,
    /// Cells of columns that no sensor has, column by column.
    pub carried: Vec<Cells>,
}

impl Samples {
    /// Those of no rows.
    pub fn none(places: &Places) -> Self {
        Self {
            times: Vec::new(),
            columns: places.places.iter().map(|place| place.map(|_| Vec::new())).collect(),
            carried: vec![Cells::default(); places.others.len()],
        }
    }

    /// Adds a row; `seconds` make one unit of its time.
    pub fn add(
        &mut self,
        row: &FileRow,
        places: &Places,
        sensors: &[Sensor],
        seconds: f64,
    ) -> Result<(), LogError> {
        self.times.push(seconds * row.number(places.time)?);
        for ((place, column), sensor) in places.places.iter().zip(&mut self.columns).zip(sensors) {
            if let (Some(place), Some(column)) = (place, column) {
                column.push(sensor.factor * row.number(*place)?);
            }
        }
        for (place, cells) in places.others.iter().zip(&mut self.carried) {
            cells.push(&row.rows.plain(row.record.get(*place).unwrap_or_default()));
        }
        Ok(())
    }

    /// Puts rows that came early or late on a grid; the time between two rows in s, and the share of those.
    ///
    /// # Errors
    /// Of others the first row that does not come at its time, and what is wrong with it.
    pub fn evenly(&mut self) -> Result<(f64, f64), (usize, String)> {
        match (constant_step(&self.times), jittered(&self.times)) {
            (Ok(interval), _) => Ok((interval, 0.0)),
            (Err(_), Some(Jitter { interval, share })) => {
                for column in self.columns.iter_mut().flatten() {
                    *column = on_grid(&self.times, column, interval);
                }
                let rows = self.columns.iter().flatten().map(Vec::len).next();
                self.times.truncate(rows.unwrap_or(self.times.len()));
                self.carried.clear();
                Ok((interval, share))
            }
            (Err(wrong), None) => Err(wrong),
        }
    }
}

/// Rows that came at times of their own.
struct Jitter {
    /// Time between two rows in s: the median.
    interval: f64,
    /// Share of the steps that are off it.
    share: f64,
}

/// Time stamps that a controller's load shifted now and then: growing, few of their steps off the median
/// ([`LATE_SHARE`]) and none by more than [`LATE_STEPS`]. None of others.
fn jittered(times: &[f64]) -> Option<Jitter> {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.len() < 3 || steps.iter().any(|step| *step <= 0.0) {
        return None;
    }
    let sorted = {
        let mut sorted = steps.clone();
        sorted.sort_by(f64::total_cmp);
        sorted
    };
    let interval = sorted[sorted.len() / 2];
    steps.retain(|step| (step / interval - 1.0).abs() > LATE);
    let share = steps.len() as f64 / sorted.len() as f64;
    let worst = sorted.last().map_or(0.0, |step| step / interval);
    (share <= LATE_SHARE && worst <= LATE_STEPS).then_some(Jitter { interval, share })
}

/// Values at times of their own on a grid from the first time on.
fn on_grid(times: &[f64], values: &[f64], interval: f64) -> Vec<f64> {
    let spline = CubicSpline::not_a_knot(times, values);
    let first = times[0];
    let rows = times.last().map_or(0, |last| ((last - first) / interval + 1e-6) as usize + 1);
    (0..rows).map(|row| spline.at(first + row as f64 * interval)[0]).collect()
}
