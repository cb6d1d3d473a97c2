//! Recorded runs of any mechanism: a CSV file with a column for each sensor, one row a sample.

use super::cells::Cells;
use super::columns::{TIME, choose};
use super::samples::{FileRow, Samples, unread, wrong};
use crate::calibrate::sensed::thresholds::{LOWEST_RATE, PLAIN_BAND, SHORTEST};
use crate::measure::bounded;
use crate::measure::dialect::Rows;
use crate::measure::log::{ColumnSource, LogError, no_header};
use crate::measure::shown::shown;
use crate::mechanism::Sensor;
use crate::scenario::Columns;
use std::ops::Range;
use std::path::Path;

/// A recorded run.
///
/// ```
/// use freeplay::calibrate::sensed::recording::Recording;
///
/// let columns = vec![Some(vec![0.0, 0.1, 0.2, 0.3]), None];
/// let recording = Recording::of("run-a", 0.01, 4, columns);
/// assert_eq!((recording.sensors(), recording.get(1)), (2, None));
/// assert_eq!(recording.part(1..3).get(0), Some(&[0.1, 0.2][..]));
/// assert!((recording.duration() - 0.03).abs() < 1e-12);
/// ```
#[derive(Clone, Debug)]
pub struct Recording {
    /// The file as the user called it.
    pub path: String,
    /// Its name.
    pub name: String,
    /// Time of the first row in s.
    pub start: f64,
    /// Time between two rows in s.
    pub interval: f64,
    /// Number of rows.
    pub samples: usize,
    columns: Vec<Option<Vec<f64>>>,
    /// Sensors in the order of the file's columns; none of one that was not read.
    order: Vec<usize>,
    /// Where its time stands.
    time: ColumnSource,
    /// Columns of the file that no sensor has.
    pub ignored: Vec<String>,
    /// Columns of sensors that the file does not have.
    absent: Vec<String>,
    /// Their cells, column by column; nothing where rows were put on a grid.
    carried: Vec<Cells>,
    /// Share of the rows that came early or late and were put on a grid by splines.
    pub jitter: f64,
}

impl Recording {
    /// Reads the columns of `sensors`; measured ones may be missing, commands may not, unless `efforts` drive the
    /// machine and theirs were measured. Time stands in `t` or `t_s`.
    ///
    /// # Errors
    /// As of [`read_with_time`](Self::read_with_time).
    pub fn read(path: &Path, sensors: &[Sensor], efforts: bool) -> Result<Self, LogError> {
        Self::read_with_time(path, sensors, efforts, None)
    }

    /// The same where `time` says in which column time stands and what makes seconds of it.
    ///
    /// # Errors
    /// A file that cannot be read, columns that stand there twice, none that a sensor has, missing commands,
    /// values that are no numbers, time that does not advance by a constant step.
    pub fn read_with_time(
        path: &Path,
        sensors: &[Sensor],
        efforts: bool,
        time: Option<ColumnSource>,
    ) -> Result<Self, LogError> {
        let file = path.display().to_string();
        let opened = bounded::open(path, bounded::TABLE)
            .map_err(|error| unread(&file, &csv::Error::from(error)))?;
        let mut rows = Rows::begin(opened).map_err(|error| unread(&file, &error))?;
        let heads = rows.heads().clone();
        let asked = time.as_ref().map(|time| time.column.as_str());
        let places = no_header(&heads)
            .map_or_else(|| choose(&heads, sensors, efforts, asked), Err)
            .map_err(|(message, help)| wrong(&file, Some(1), message, help))?;
        let time = time.unwrap_or_else(|| ColumnSource::new(&heads[places.time], 1.0));
        let lacking = places.places.iter().zip(sensors).filter(|(place, _)| place.is_none());
        let absent = lacking.map(|(_, sensor)| sensor.column.clone()).collect();
        let ignored = places.others.iter().map(|place| heads[*place].to_owned()).collect();
        let mut order: Vec<usize> =
            (0..sensors.len()).filter(|&i| places.places[i].is_some()).collect();
        order.sort_by_key(|&i| places.places[i]);
        let mut samples = Samples::none(&places);
        let mut record = csv::StringRecord::new();
        while rows.next(&mut record).map_err(|error| unread(&file, &error))? {
            let row = FileRow { rows: &rows, record: &record, heads: &heads, file: &file };
            samples.add(&row, &places, sensors, time.scale)?;
        }
        let (interval, jitter) = samples.evenly().map_err(|(row, message)| {
            let help = "expected samples at a constant rate, time growing".to_owned();
            wrong(&file, Some(row as u64 + 1 + rows.lines_above()), message, help)
        })?;
        let Samples { times, columns, carried } = samples;
        let name = path.file_name().map_or(file.clone(), |n| n.to_string_lossy().into_owned());
        Ok(Self {
            path: file,
            name: shown(&name).into_owned(),
            start: times[0],
            interval,
            samples: times.len(),
            columns,
            order,
            time,
            ignored,
            absent,
            carried,
            jitter,
        })
    }

    /// A recording called `name` of so many samples `interval` (s) apart from time 0 on, sensor by sensor.
    pub fn of(name: &str, interval: f64, samples: usize, columns: Vec<Option<Vec<f64>>>) -> Self {
        Self {
            path: name.to_owned(),
            name: name.to_owned(),
            start: 0.0,
            interval,
            samples,
            columns,
            order: Vec::new(),
            time: ColumnSource::new(TIME[0], 1.0),
            ignored: Vec::new(),
            absent: Vec::new(),
            carried: Vec::new(),
            jitter: 0.0,
        }
    }

    /// Samples of sensor `index`, if the recording has them.
    pub fn get(&self, index: usize) -> Option<&[f64]> {
        self.columns.get(index)?.as_deref()
    }

    /// Number of sensors that it may have samples of.
    pub fn sensors(&self) -> usize {
        self.columns.len()
    }

    /// The same recording with other columns.
    pub fn with(&self, columns: Vec<Option<Vec<f64>>>) -> Self {
        Self { columns, ..self.clone() }
    }

    /// The rows of the first so many seconds.
    pub fn first(&self, seconds: f64) -> Self {
        let samples = ((seconds / self.interval) as usize + 1).min(self.samples);
        self.part(0..samples)
    }

    /// Some of its rows, by their places, as a recording of their own.
    pub fn part(&self, rows: Range<usize>) -> Self {
        let cut = |column: &Option<Vec<f64>>| column.as_ref().map(|c| c[rows.clone()].to_vec());
        Self {
            start: self.start + rows.start as f64 * self.interval,
            samples: rows.len(),
            columns: self.columns.iter().map(cut).collect(),
            carried: self.carried.iter().map(|cells| cells.part(rows.clone())).collect(),
            ..self.clone()
        }
    }

    /// What speaks against a recording whose rows are too far apart for a command that looks at it up to `band` Hz and needs
    /// `lowest` rows a second for that.
    pub fn too_slow(&self, command: &str, lowest: f64, band: f64) -> Option<LogError> {
        let rate = 1.0 / self.interval;
        // A rate that is the limit's reads a hair below it.
        (rate < lowest * 0.999).then(|| LogError {
            place: self.path.clone(),
            message: format!("rows are {:.4} s apart, {rate:.4} a second", self.interval),
            help: format!(
                "{command} needs at least {lowest} a second, because it looks at what is left up to {band} Hz; if \
                 column `{}` is in ms, write it in s",
                self.time.column
            ),
        })
    }

    /// What speaks against calibrating with this recording.
    pub fn wrong(&self) -> Option<LogError> {
        let slow = self.too_slow("calibrate", LOWEST_RATE, PLAIN_BAND);
        if slow.is_some() {
            return slow;
        }
        if self.duration() < SHORTEST * 0.999 {
            let message = format!("lasts {:.4} s", self.duration());
            let help = format!("expected at least {SHORTEST} s of motion");
            return Some(LogError { place: self.path.clone(), message, help });
        }
        None
    }

    /// What a rig's `[columns]` names and the file does not have; what was told beside commands need not be there.
    pub fn lacks(&self, sensors: &[Sensor], columns: &Columns) -> Option<LogError> {
        let there =
            |(i, sensor): (usize, &Sensor)| self.get(i).is_some().then(|| sensor.column.clone());
        let missing = columns.quantities().find_map(|name| {
            let column = columns.source(name)?.column;
            let index = sensors.iter().position(|sensor| sensor.column == column)?;
            let needed = self.get(index).is_none() && !sensors[index].tells();
            needed.then(|| format!("no column `{column}`, which columns.{name} asks for"))
        })?;
        let measured = sensors.iter().enumerate().filter_map(there);
        let heads: Vec<String> = std::iter::once(self.time.column.clone())
            .chain(measured)
            .chain(self.ignored.iter().cloned())
            .collect();
        let help = format!("the file has {}", heads.join(", "));
        Some(LogError { place: format!("{}:1", self.path), message: missing, help })
    }

    /// Whether another recording holds the same samples.
    pub fn is_twin_of(&self, other: &Self) -> bool {
        self.columns == other.columns
    }

    /// Length in s.
    pub fn duration(&self) -> f64 {
        (self.samples - 1) as f64 * self.interval
    }

    /// What is to be known of it: rows that came early or late, columns that no sensor has.
    pub fn remarks(&self) -> Vec<String> {
        let jitter = (self.jitter > 0.0).then(|| {
            format!(
                "{}: {:.1} % of the rows came early or late; all are put on a grid of {:.6} s by splines",
                self.name,
                100.0 * self.jitter,
                self.interval
            )
        });
        let ignored = (!self.ignored.is_empty()).then(|| {
            // What a sensor lacks may stand in one of them.
            let absent = match self.absent.as_slice() {
                [] => String::new(),
                absent => format!("; sensors that no column has: {}", absent.join(", ")),
            };
            let ignored = self.ignored.join(", ");
            format!("{}: columns that no sensor has: {ignored}{absent}", self.name)
        });
        jitter.into_iter().chain(ignored).collect()
    }

    /// The recording as CSV, in the columns and units of its file, what was not there after them; columns that no sensor has
    /// as they were.
    pub fn to_csv(&self, sensors: &[Sensor]) -> String {
        let added = (0..sensors.len()).filter(|i| !self.order.contains(i));
        let ordered = self.order.iter().copied().chain(added);
        let present: Vec<usize> = ordered.filter(|&i| self.get(i).is_some()).collect();
        let heads = present.iter().map(|&i| sensors[i].column.as_str());
        let others = self.ignored.iter().zip(&self.carried).map(|(head, _)| head.as_str());
        let mut text = csv::Writer::from_writer(Vec::new());
        // Writing to memory cannot fail.
        let _ =
            text.write_record([self.time.column.as_str()].into_iter().chain(heads).chain(others));
        for row in 0..self.samples {
            let t = (self.start + row as f64 * self.interval) / self.time.scale;
            let read = present.iter().map(|&i| {
                let value = self.get(i).map_or(f64::NAN, |column| column[row] / sensors[i].factor);
                format!("{value:.9}")
            });
            let cells = self.carried.iter().map(|cells| cells.get(row).to_owned());
            let _ = text.write_record([format!("{t:.6}")].into_iter().chain(read).chain(cells));
        }
        String::from_utf8(text.into_inner().unwrap_or_default()).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::parts_of;
    use crate::scenario::Scenario;

    /// Cells of columns that no sensor has come back as they were; one with a comma in it moved all after it by a column.
    #[test]
    fn what_no_sensor_has_is_carried_whole() {
        let text = include_str!("../../../../assets/rigs-planar/planar-2/rig.toml");
        let sensors = parts_of(&Scenario::from_text(text, "rig", &[]).unwrap()).unwrap().sensors;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        let mut rows = "t,q_O_cmd,\"a, \"\"note\"\"\",q_D\n".to_owned();
        for i in 0..4 {
            rows += &format!("0.00{i}000,0.500000000,\"left, {i}\",1.250000000\n");
        }
        std::fs::write(&path, &rows).unwrap();
        let recording = Recording::read(&path, &sensors, false).unwrap();
        std::fs::write(&path, recording.to_csv(&sensors)).unwrap();
        let again = Recording::read(&path, &sensors, false).unwrap();
        assert_eq!(again.ignored, recording.ignored);
        assert_eq!(again.carried, recording.carried);
        assert_eq!(again.carried[0].get(3), "left, 3");
        assert_eq!(recording.part(1..3).carried[0].get(1), "left, 2");
    }
}
