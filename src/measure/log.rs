//! Recorded runs: a CSV file, one row a sample, at a constant rate.

use super::bounded;
use super::dialect::Rows;
use super::shown::shown;
use super::spelling::nearest;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::fmt::Write as _;
use std::path::Path;

/// What a column of a log holds. Joints count from 0.
///
/// [`Log`] has an example.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Channel {
    /// Commanded length of a prismatic joint, m: `q1_cmd`.
    Command(usize),
    /// Its length by its encoder, m: `q1`.
    Length(usize),
    /// Force of its drive, N: `F1`.
    Force(usize),
    /// Pose of the output, x and y in m, φ in rad: `x`, `y`, `phi`.
    Pose(usize),
}

impl Channel {
    /// Unit of the column.
    pub fn unit(self) -> &'static str {
        match self {
            Channel::Command(_) | Channel::Length(_) | Channel::Pose(0 | 1) => "m",
            Channel::Force(_) => "N",
            Channel::Pose(_) => "rad",
        }
    }

    /// The channels of a machine with so many prismatic joints, in the order of a log's columns.
    pub fn all(prismatics: usize) -> Vec<Channel> {
        let joints = 0..prismatics;
        let commands = joints.clone().map(Channel::Command);
        let lengths = joints.clone().map(Channel::Length);
        commands
            .chain(lengths)
            .chain(joints.map(Channel::Force))
            .chain((0..3).map(Channel::Pose))
            .collect()
    }
}

impl Channel {
    /// Whether both are of one kind.
    fn is_like(self, other: Channel) -> bool {
        std::mem::discriminant(&self) == std::mem::discriminant(&other)
    }
}

impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Channel::Command(i) => write!(f, "q{}_cmd", i + 1),
            Channel::Length(i) => write!(f, "q{}", i + 1),
            Channel::Force(i) => write!(f, "F{}", i + 1),
            Channel::Pose(i) => f.write_str(["x", "y", "phi"][*i]),
        }
    }
}

/// Where a quantity stands in somebody's file, and how it gets the unit of its channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ColumnSource {
    /// Head of the column.
    pub column: String,
    /// What its numbers are multiplied by: 1 where they are in SI units.
    #[serde(default = "one")]
    pub scale: f64,
}

fn one() -> f64 {
    1.0
}

impl ColumnSource {
    /// A column whose numbers are multiplied by `scale`.
    pub fn new(column: &str, scale: f64) -> Self {
        Self { column: column.to_owned(), scale }
    }
}

/// A recorded run.
///
/// ```
/// use freeplay::measure::log::{Channel, Log};
///
/// let channels = vec![(Channel::Length(0), vec![0.30, 0.31, 0.32]), (Channel::Force(0), vec![5.0, 6.0, 7.0])];
/// let log = Log::new("run.csv", 0.0, 0.01, channels);
/// assert_eq!(log.get(Channel::Force(0)), Some(&[5.0, 6.0, 7.0][..]));
/// assert!((log.duration() - 0.02).abs() < 1e-12);
/// assert!(log.to_csv().starts_with("t,q1,F1\n"));
/// assert_eq!(log.part(1..3).samples, 2);
/// ```
#[derive(Clone, Debug)]
pub struct Log {
    /// Name of its file.
    pub name: String,
    /// Time of the first sample and between two samples, in s.
    pub start: f64,
    /// Time between two samples in s.
    pub interval: f64,
    /// Number of samples.
    pub samples: usize,
    channels: Vec<(Channel, Vec<f64>)>,
    /// Columns of the file that hold none of them.
    ignored: Vec<String>,
}

/// What is wrong with a log: where, what, and what would be right.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {message}; {help}")]
pub struct LogError {
    /// File, and line where there is one.
    pub place: String,
    /// What was found.
    pub message: String,
    /// What would be right.
    pub help: String,
}

/// Deviation of a time step from the first, as a share of it, that is rounding in the file.
const JITTER: f64 = 0.05;

impl Log {
    /// A log of the given samples.
    pub fn new(name: &str, start: f64, interval: f64, channels: Vec<(Channel, Vec<f64>)>) -> Self {
        let samples = channels.first().map_or(0, |(_, values)| values.len());
        let ignored = Vec::new();
        Self { name: name.to_owned(), start, interval, samples, channels, ignored }
    }

    /// Reads a CSV file with a column `t` and any of `known`. Other columns are left alone, unless one may be the misspelt
    /// name of a known one that is missing, or one of a kind is missing of which others are there.
    ///
    /// # Errors
    /// A file that cannot be read, unknown or double columns, values that are no numbers, time that
    /// does not advance by a constant step.
    pub fn read(path: &Path, known: &[Channel]) -> Result<Log, LogError> {
        let names: Vec<String> = known.iter().map(Channel::to_string).collect();
        let expected = format!("expected a header with t and any of {}", names.join(", "));
        load(path, &expected, |header| {
            let (mut time, mut chosen): (_, Vec<(usize, Channel)>) = (None, Vec::new());
            let there = |name: &str| header.iter().any(|head| head == name);
            let missing: Vec<&str> =
                names.iter().map(String::as_str).chain(["t"]).filter(|name| !there(name)).collect();
            let torn = known.iter().zip(&names).any(|(channel, name)| {
                let kin =
                    |(other, name): (&Channel, &String)| other.is_like(*channel) && there(name);
                !there(name) && known.iter().zip(&names).any(kin)
            });
            for (i, name) in header.iter().enumerate() {
                let channel = names.iter().position(|known| known == name).map(|k| known[k]);
                let taken = chosen.iter().any(|(_, c)| Some(*c) == channel);
                match channel {
                    None if name == "t" && time.is_none() => time = Some(i),
                    None if name == "t" => {
                        return Err(("column `t` twice".to_owned(), "keep one of them".to_owned()));
                    }
                    None => {
                        let near = nearest(name, &missing);
                        if near.is_none() && !torn && there("t") {
                            continue;
                        }
                        let help = near.map_or(expected.clone(), |near| {
                            format!("did you mean `{near}`? {expected}")
                        });
                        return Err((format!("unknown column `{name}`"), help));
                    }
                    Some(_) if taken => {
                        let help = "keep one of them".to_owned();
                        return Err((format!("column `{name}` twice"), help));
                    }
                    Some(channel) => chosen.push((i, channel)),
                }
            }
            let time = time.ok_or_else(|| ("no column `t`".to_owned(), expected.clone()))?;
            Ok((time, chosen))
        })
    }

    /// Columns of its file that hold none of its channels.
    pub fn ignored(&self) -> &[String] {
        &self.ignored
    }

    /// Samples of a channel, if the log has it.
    pub fn get(&self, channel: Channel) -> Option<&[f64]> {
        self.channels.iter().find(|(c, _)| *c == channel).map(|(_, values)| values.as_slice())
    }

    /// The channels that the log has, in the order of its columns.
    pub fn channels(&self) -> impl Iterator<Item = Channel> + '_ {
        self.channels.iter().map(|(channel, _)| *channel)
    }

    /// Length of the log in s.
    pub fn duration(&self) -> f64 {
        self.samples.saturating_sub(1) as f64 * self.interval
    }

    /// The same with its columns in the order of `channels`, those that are not among them at the end.
    pub fn arranged(&self, channels: impl Iterator<Item = Channel>) -> Log {
        let order: Vec<Channel> = channels.collect();
        let place = |channel: Channel| order.iter().position(|c| *c == channel);
        let mut columns = self.channels.clone();
        columns.sort_by_key(|(channel, _)| place(*channel).unwrap_or(order.len()));
        Log::new(&self.name, self.start, self.interval, columns)
    }

    /// The log as CSV, as [`Log::read`] takes it: commands as they are, lengths to a nanometre, forces
    /// to a micronewton, angles to a nanoradian.
    pub fn to_csv(&self) -> String {
        let mut text = String::from("t");
        for channel in self.channels() {
            // Writing to a string cannot fail, here and below.
            let _ = write!(text, ",{channel}");
        }
        text.push('\n');
        for row in 0..self.samples {
            let _ = write!(text, "{:.6}", self.start + row as f64 * self.interval);
            for (channel, values) in &self.channels {
                let value = values[row];
                let _ = match channel {
                    Channel::Command(_) => write!(text, ",{value}"),
                    Channel::Force(_) => write!(text, ",{value:.6}"),
                    Channel::Length(_) | Channel::Pose(_) => write!(text, ",{value:.9}"),
                };
            }
            text.push('\n');
        }
        text
    }

    /// Samples `range` as a log of their own; its time starts where they do.
    pub fn part(&self, range: std::ops::Range<usize>) -> Log {
        let cut =
            |(channel, values): &(Channel, Vec<f64>)| (*channel, values[range.clone()].to_vec());
        let start = self.start + range.start as f64 * self.interval;
        Log::new(&self.name, start, self.interval, self.channels.iter().map(cut).collect())
    }
}

/// Places of columns: that of time, and those of channels.
type ColumnPlaces = (usize, Vec<(usize, Channel)>);

/// Most columns of a log, and most bytes of their heads: what has more was never a header.
const WIDEST: [usize; 2] = [1000, 65_536];

/// What is wrong with a header that is none, and what would be right.
pub(crate) fn no_header(heads: &csv::StringRecord) -> Option<(String, String)> {
    let [columns, bytes] = WIDEST;
    (heads.len() > columns || heads.as_slice().len() > bytes).then(|| {
        let message = format!(
            "the header has {} columns in {} characters",
            heads.len(),
            heads.as_slice().chars().count()
        );
        (message, format!("expected at most {columns} columns in {bytes} characters"))
    })
}

/// Reads the columns that `choose` picks by the header; its errors say what is wrong with that and what
/// would be right.
fn load(
    path: &Path,
    expected: &str,
    choose: impl FnOnce(&csv::StringRecord) -> Result<ColumnPlaces, (String, String)>,
) -> Result<Log, LogError> {
    let file = path.display().to_string();
    let wrong = |line: Option<u64>, message: String, help: &str| LogError {
        place: line.map_or_else(|| file.clone(), |line| format!("{file}:{line}")),
        message,
        help: help.to_owned(),
    };
    let opened = bounded::open(path, bounded::TABLE).map_err(|error| {
        wrong(None, format!("cannot be read: {error}"), "is this the right file?")
    })?;
    let mut rows = Rows::begin_unscaled(opened)
        .map_err(|error| wrong(Some(1), format!("cannot be read: {error}"), expected))?;
    let header = rows.heads().clone();
    let (time, chosen) = no_header(&header)
        .map_or_else(|| choose(&header), Err)
        .map_err(|(message, help)| wrong(Some(1), message, &help))?;
    let mut times = Vec::new();
    let mut channels: Vec<(Channel, Vec<f64>)> =
        chosen.iter().map(|(_, channel)| (*channel, Vec::new())).collect();
    let mut record = csv::StringRecord::new();
    loop {
        let more = rows.next(&mut record).map_err(|error| {
            let line = error.position().map(csv::Position::line);
            let help = "as many values as the header has names";
            wrong(line, format!("cannot be read: {error}"), help)
        })?;
        if !more {
            break;
        }
        let line = record.position().map(csv::Position::line);
        let number = |place: usize| {
            let field = record.get(place).unwrap_or_default();
            rows.number(field).ok_or_else(|| {
                let what = if field.is_empty() { "nothing" } else { field };
                let message = format!("column `{}` holds {what}", &header[place]);
                wrong(line, message, "expected a finite number in every row")
            })
        };
        times.push(number(time)?);
        for ((place, _), (_, values)) in chosen.iter().zip(&mut channels) {
            values.push(number(*place)?);
        }
    }
    let interval = constant_step(&times).map_err(|(row, message)| {
        let help = "expected samples at a constant rate, time growing";
        wrong(Some(row as u64 + 1 + rows.lines_above()), message, help)
    })?;
    let name = path.file_name().map_or(file.clone(), |name| name.to_string_lossy().into_owned());
    let name = shown(&name);
    let used = |place: usize| place == time || chosen.iter().any(|(other, _)| *other == place);
    let unused = header.iter().enumerate().filter(|(place, _)| !used(*place));
    let ignored = unused.map(|(_, head)| shown(head).into_owned()).collect();
    Ok(Log { ignored, ..Log::new(&name, times[0], interval, channels) })
}

/// The step of a time column, or the first row that breaks it and how.
pub(crate) fn constant_step(times: &[f64]) -> Result<f64, (usize, String)> {
    let [first, .., last] = times else {
        return Err((0, format!("the log has {} row(s)", times.len())));
    };
    let mean = (last - first) / (times.len() - 1) as f64;
    // The middle step stands for all: a gap would spoil the mean.
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    for (i, pair) in times.windows(2).enumerate() {
        let [before, now] = [pair[0], pair[1]];
        if now == before {
            return Err((i + 1, format!("t = {now} s is repeated")));
        }
        if now < before {
            return Err((i + 1, format!("time runs backwards, from {before} to {now} s")));
        }
    }
    steps.sort_by(f64::total_cmp);
    let step = steps[steps.len() / 2];
    for (i, pair) in times.windows(2).enumerate() {
        if ((pair[1] - pair[0]) / step - 1.0).abs() > JITTER {
            let message = format!(
                "a step of {:.6} s from t = {} s, where others are {step:.6} s",
                pair[1] - pair[0],
                pair[0]
            );
            return Err((i + 1, message));
        }
    }
    Ok(mean)
}
