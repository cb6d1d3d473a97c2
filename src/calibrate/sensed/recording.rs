//! Recorded runs of any mechanism: a CSV file with a column for each sensor, one row a sample.

use super::cells::Cells;
use super::thresholds::{LATE, LATE_SHARE, LATE_STEPS, LOWEST_RATE, PLAIN_BAND, SHORTEST};
use crate::measure::bounded;
use crate::measure::dialect::Rows;
use crate::measure::log::{LogError, Source, constant_step, no_header};
use crate::measure::shown::shown;
use crate::measure::spelling::nearest;
use crate::measure::spline::CubicSpline;
use crate::mechanism::{Reads, Sensor};
use crate::scenario::Columns;
use std::ops::Range;
use std::path::Path;

/// A recorded run.
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
    /// Where its time stands.
    time: Source,
    /// Columns of the file that no sensor has.
    pub ignored: Vec<String>,
    /// Their cells, column by column; nothing where rows were put on a grid.
    carried: Vec<Cells>,
    /// Share of the rows that came early or late and were put on a grid by splines.
    pub jitter: f64,
}

/// Heads that a column of time may have.
const TIME: [&str; 2] = ["t", "t_s"];

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
        time: Option<Source>,
    ) -> Result<Self, LogError> {
        let file = path.display().to_string();
        let wrong = |line: Option<u64>, message: String, help: String| LogError {
            place: line.map_or_else(|| file.clone(), |line| format!("{file}:{line}")),
            message,
            help,
        };
        let unread = |error: csv::Error| {
            let line = error.position().map(csv::Position::line);
            let message = format!("cannot be read: {error}");
            wrong(line, message, "expected a CSV file with a header and numbers".to_owned())
        };
        let opened =
            bounded::open(path, bounded::TABLE).map_err(|error| unread(csv::Error::from(error)))?;
        let mut rows = Rows::begin(opened).map_err(unread)?;
        let heads = rows.heads().clone();
        let asked = time.as_ref().map(|time| time.column.as_str());
        let Places { time: place_of_time, places, others } = no_header(&heads)
            .map_or_else(|| choose(&heads, sensors, efforts, asked), Err)
            .map_err(|(message, help)| wrong(Some(1), message, help))?;
        let time = time.unwrap_or_else(|| Source::new(&heads[place_of_time], 1.0));
        let ignored = others.iter().map(|place| heads[*place].to_owned()).collect();
        let mut carried = vec![Cells::default(); others.len()];
        let mut times = Vec::new();
        let mut columns: Vec<Option<Vec<f64>>> =
            places.iter().map(|place| place.map(|_| Vec::new())).collect();
        let mut record = csv::StringRecord::new();
        while rows.next(&mut record).map_err(unread)? {
            let number = |place: usize| {
                let text = record.get(place).unwrap_or_default();
                rows.number(text).ok_or_else(|| {
                    let what = if text.is_empty() { "nothing" } else { text };
                    let message = format!("column `{}` holds {what}", &heads[place]);
                    let line = record.position().map(csv::Position::line);
                    wrong(line, message, "expected a finite number in every row".to_owned())
                })
            };
            times.push(time.scale * number(place_of_time)?);
            for ((place, column), sensor) in places.iter().zip(&mut columns).zip(sensors) {
                if let (Some(place), Some(column)) = (place, column) {
                    column.push(sensor.factor * number(*place)?);
                }
            }
            for (place, cells) in others.iter().zip(&mut carried) {
                cells.push(&rows.plain(record.get(*place).unwrap_or_default()));
            }
        }
        let mut jitter = 0.0;
        let interval = match (constant_step(&times), jittered(&times)) {
            (Ok(interval), _) => interval,
            (Err(_), Some(Jitter { interval, share })) => {
                for column in columns.iter_mut().flatten() {
                    *column = on_grid(&times, column, interval);
                }
                let rows = columns.iter().flatten().map(Vec::len).next();
                times.truncate(rows.unwrap_or(times.len()));
                carried.clear();
                jitter = share;
                interval
            }
            (Err((row, message)), None) => {
                let help = "expected samples at a constant rate, time growing".to_owned();
                return Err(wrong(Some(row as u64 + 1 + rows.lines_above()), message, help));
            }
        };
        let name = path.file_name().map_or(file.clone(), |n| n.to_string_lossy().into_owned());
        Ok(Self {
            path: file,
            name: shown(&name).into_owned(),
            start: times[0],
            interval,
            samples: times.len(),
            columns,
            time,
            ignored,
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
            time: Source::new(TIME[0], 1.0),
            ignored: Vec::new(),
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

    /// The recording as CSV, in the columns and units of its file; columns that no sensor has as they were.
    pub fn to_csv(&self, sensors: &[Sensor]) -> String {
        let present: Vec<usize> = (0..sensors.len()).filter(|&i| self.get(i).is_some()).collect();
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

/// Where time stands, where each sensor's column does, and what else there is.
struct Places {
    time: usize,
    places: Vec<Option<usize>>,
    others: Vec<usize>,
}

/// Finds the columns by the header; what is wrong with it and what would be right. Time stands in the column that was
/// `asked` for. A column that no sensor has is left alone, unless it looks like the misspelt name of a sensor's column
/// that is missing.
fn choose(
    heads: &csv::StringRecord,
    sensors: &[Sensor],
    efforts: bool,
    asked: Option<&str>,
) -> Result<Places, (String, String)> {
    let known: Vec<&str> = sensors.iter().map(|sensor| sensor.column.as_str()).collect();
    let named: Vec<&str> = asked.map_or_else(|| TIME.to_vec(), |column| vec![column]);
    let there = heads.iter().collect::<Vec<_>>().join(", ");
    let expected =
        format!("expected `{}` and any of {}; the file has {there}", named[0], known.join(", "));
    let (mut time, mut places) = (None, vec![None; sensors.len()]);
    let mut others = Vec::new();
    for (place, head) in heads.iter().enumerate() {
        let twice = || (format!("column `{head}` twice"), "keep one of them".to_owned());
        if let Some(sensor) = known.iter().position(|column| *column == head) {
            if places[sensor].replace(place).is_some() {
                return Err(twice());
            }
        } else if named.contains(&head) {
            if time.replace(place).is_some() {
                return Err(twice());
            }
        } else {
            others.push(place);
        }
    }
    let missing: Vec<&str> =
        known.iter().zip(&places).filter(|(_, place)| place.is_none()).map(|(k, _)| *k).collect();
    let mut strange = others.iter().map(|place| &heads[*place]);
    if let Some((head, near)) = strange.find_map(|head| Some((head, nearest(head, &missing)?))) {
        let help = format!("did you mean `{near}`? no [[sensor]] has it; {expected}");
        return Err((format!("unknown column `{head}`"), help));
    }
    let Some(time) = time else {
        return Err(match (asked, others.first()) {
            (None, Some(place)) => {
                let help = format!("no [[sensor]] has it; {expected}");
                (format!("unknown column `{}`", &heads[*place]), help)
            }
            _ => (format!("no column `{}`", named[0]), expected),
        });
    };
    if places.iter().all(Option::is_none) {
        let columns = known.iter().map(|column| format!("`{column}`")).collect::<Vec<_>>();
        return Err((format!("no column {}", columns.join(", ")), expected));
    }
    let missing = commands_missing(sensors, &places, efforts);
    if missing.is_empty() {
        return Ok(Places { time, places, others });
    }
    let help = "without its commands nobody knows what the machine was asked to do".to_owned();
    Err((format!("no column {}", missing.join(", ")), help))
}

/// Columns of commands that are not there and that nothing stands in for.
fn commands_missing(sensors: &[Sensor], places: &[Option<usize>], efforts: bool) -> Vec<String> {
    // What was measured of a drive's effort stands in for its command.
    let replaced = |drive: usize| {
        let mut sensors = sensors.iter().zip(places);
        efforts
            && sensors.any(|(s, place)| {
                place.is_some() && matches!(s.reads, Reads::Effort(of) if of == drive)
            })
    };
    sensors
        .iter()
        .zip(places)
        .filter(|(sensor, place)| {
            place.is_none() && matches!(sensor.reads, Reads::Command(drive) if !replaced(drive))
        })
        .map(|(sensor, _)| format!("`{}`", sensor.column))
        .collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::parts_of;
    use crate::scenario::Scenario;

    /// Cells of columns that no sensor has come back as they were; one with a comma in it moved all after it by a column.
    #[test]
    fn what_no_sensor_has_is_carried_whole() {
        let text = include_str!("../../../assets/rigs-planar/planar-2/rig.toml");
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
