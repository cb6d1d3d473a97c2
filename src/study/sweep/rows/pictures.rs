//! The pictures of a sweep: its main figures over each varied number.

use super::journal::RunRows;
use super::row::{FORCES, Status, status};
use super::statistics::{Spread, is_start};
use crate::report::{Curve, Label, Panel, Picture, ReportError, Style, panels_svg};
use crate::study::sweep::varied::vary::Values;
use crate::study::sweep::{Identity, Vary};
use csv::StringRecord;
use std::collections::BTreeMap;

/// An output: column, heading, label of the axis, factor to the axis' unit, and the column of the same of the machine
/// without clearance.
type SweptOutput = (&'static str, &'static str, &'static str, f64, Option<&'static str>);

/// What is drawn.
const OUTPUTS: [SweptOutput; 8] = [
    ("peak_contact_force_N", "Peak contact force", "force (N)", 1.0, None),
    (
        "peak_platform_acceleration_m_s2",
        "Peak output acceleration",
        "|a| (m/s²)",
        1.0,
        Some("ideal_peak_platform_acceleration_m_s2"),
    ),
    (
        "rms_acceleration_deviation_m_s2",
        "Acceleration, rms deviation from ideal",
        "a (m/s²)",
        1.0,
        None,
    ),
    (
        "peak_actuator_force_N",
        "Peak actuator force",
        "force (N)",
        1.0,
        Some("ideal_peak_actuator_force_N"),
    ),
    (
        "peak_actuator_torque_Nm",
        "Peak actuator torque",
        "torque (N m)",
        1.0,
        Some("ideal_peak_actuator_torque_Nm"),
    ),
    ("rms_path_error_m", "Path error, rms", "distance (mm)", 1e3, None),
    ("contact_fraction", "Share of time in contact, mean of all joints", "share", 1.0, None),
    ("impacts_per_s", "Impacts per second, all joints", "impacts (1/s)", 1.0, None),
];

/// Runs that are drawn, evenly chosen where there are more: dots would hide each other, and the page
/// grow with the sweep.
const DOTS: usize = 1000;

/// Curves that colours tell apart.
const GROUPS: usize = 6;

/// Most means that are joined, and fewest runs that make one: at one value where values repeat, else
/// over a stretch of the axis, which must be longer than the period of a sample's pattern.
const MEANS: usize = 24;
const RUNS_AT_A_VALUE: usize = 5;
const RUNS_OF_A_STRETCH: usize = 20;

/// Fewest stretches whose means are joined: a straight line between two means over decades lies above nearly all runs between
/// them; of the five decades of clearance from 10 nm to 1 mm each of six takes less than one.
const FEWEST_STRETCHES: usize = 6;

/// Largest over smallest value from which a positive quantity is drawn by its logarithm.
const LOG_SPREAD: f64 = 50.0;

/// Names of the files that [`draw`] may give its pictures.
pub(in crate::study::sweep) fn files(identity: &Identity) -> impl Iterator<Item = String> {
    let inputs = identity.columns.iter().zip(&identity.vary);
    inputs.map(|(path, _)| file(path))
}

/// Keys may be named after bodies, and those as anybody likes: no folders, and no longer than file systems take.
fn file(path: &str) -> String {
    let plain = |c: char| if matches!(c, '/' | '\\') { '-' } else { c };
    format!("over-{}.svg", path.chars().take(60).map(plain).collect::<String>())
}

/// One picture for each varied number.
pub(in crate::study::sweep) fn draw(
    identity: &Identity,
    rows: &RunRows,
) -> Result<Vec<Picture>, ReportError> {
    // A record that was edited has been refused before; what cannot be read is not drawn.
    let varied: Vec<Vary> = identity.vary.iter().filter_map(|v| Vary::parse(v).ok()).collect();
    let rows: Vec<&StringRecord> = rows.values().filter(|row| status(row) == Status::Ok).collect();
    (0..varied.len())
        .filter(|input| !rows.is_empty() && rows.iter().all(|row| cell(row, *input).is_some()))
        .map(|input| picture(identity, &varied, &rows, input))
        .collect()
}

fn picture(
    identity: &Identity,
    varied: &[Vary],
    rows: &[&StringRecord],
    input: usize,
) -> Result<Picture, ReportError> {
    let path = &varied[input].path;
    let over = DrawnOver::new(identity, varied, rows, input);
    let drawn: Vec<DrawnPanel> = OUTPUTS.iter().filter_map(|output| over.panel(output)).collect();
    let averaged = drawn.iter().any(|drawn| drawn.averaged);
    let panels: Vec<Panel> = drawn.into_iter().map(|drawn| drawn.panel).collect();
    Ok(Picture {
        file: file(path),
        title: format!("Over {path}"),
        caption: over.caption(averaged),
        svg: panels_svg(&panels)?,
    })
}

/// What is drawn over one varied number.
struct DrawnOver<'a> {
    identity: &'a Identity,
    path: &'a str,
    rows: &'a [&'a StringRecord],
    /// Its column.
    input: usize,
    x_log: bool,
    groups: Vec<(String, Vec<&'a StringRecord>)>,
    /// Whether runs are drawn that differ by how they start.
    over_starts: bool,
}

/// A panel, and whether it shows means.
struct DrawnPanel {
    panel: Panel,
    averaged: bool,
}

impl<'a> DrawnOver<'a> {
    fn new(
        identity: &'a Identity,
        varied: &'a [Vary],
        rows: &'a [&'a StringRecord],
        input: usize,
    ) -> Self {
        let path = varied[input].path.as_str();
        let declared_log = matches!(&varied[input].values, Values::Range(range) if range.log);
        let inputs = || rows.iter().filter_map(|row| cell(row, input));
        let other_start = |(k, v): (usize, &Vary)| k != input && is_start(&v.path);
        Self {
            identity,
            path,
            rows,
            input,
            x_log: declared_log || wide(inputs()),
            groups: groups(varied, rows, input),
            over_starts: varied.iter().enumerate().any(other_start) && !is_start(path),
        }
    }

    fn column(&self, name: &str) -> Option<usize> {
        self.identity.columns.iter().position(|column| column == name)
    }

    /// Values of a column over the varied number.
    fn points(&self, rows: &[&StringRecord], column: usize, factor: f64) -> Vec<(f64, f64)> {
        let point =
            |row: &&StringRecord| Some((cell(row, self.input)?, factor * cell(row, column)?));
        rows.iter().filter_map(point).collect()
    }

    /// The same in the units of the axes.
    fn scaled(&self, points: Vec<(f64, f64)>, y_log: bool) -> Vec<(f64, f64)> {
        points.into_iter().map(|(x, y)| (scale(x, self.x_log), scale(y, y_log))).collect()
    }

    fn panel(&self, output: &SweptOutput) -> Option<DrawnPanel> {
        let (name, title, label, factor, ideal) = *output;
        let column = self.column(name)?;
        let all = self.points(self.rows, column, factor);
        if FORCES.contains(&name) && all.iter().all(|point| point.1 == 0.0) {
            return None;
        }
        let y_log = wide(all.iter().map(|point| point.1));
        let mut curves = Vec::new();
        let means = self.means(all, column, factor, y_log);
        // Dots of several groups would hide their means.
        if !(self.over_starts && self.groups.len() > 1) {
            curves.extend(self.dots(column, factor, y_log));
        }
        let averaged = !means.is_empty();
        curves.extend(means);
        if let Some(column) = ideal.and_then(|ideal| self.column(ideal)) {
            curves.push(self.ideal_machine(column, factor, y_log));
        }
        let panel = Panel {
            title: title.to_owned(),
            x_label: Label::log_if(in_words(self.path), self.x_log),
            y_label: Label::log_if(label, y_log),
            curves,
        };
        Some(DrawnPanel { panel, averaged })
    }

    /// A dot for each run, group by group.
    fn dots(&self, column: usize, factor: f64, y_log: bool) -> impl Iterator<Item = Curve> {
        self.groups.iter().map(move |(name, rows)| Curve {
            name: name.clone(),
            points: self.scaled(thinned(self.points(rows, column, factor)), y_log),
            style: Style::Dots,
        })
    }

    /// Means over starts with their intervals, group by group, or those of `all` runs of the only group, if there are enough.
    fn means(&self, all: Vec<(f64, f64)>, column: usize, factor: f64, y_log: bool) -> Vec<Curve> {
        if self.over_starts {
            let starts = self.groups.iter().flat_map(|(name, rows)| {
                let name = if self.groups.len() == 1 { "mean over starts" } else { name };
                interval(self.points(rows, column, factor), name, y_log)
            });
            let scaled = |curve: Curve| Curve { points: self.scaled(curve.points, y_log), ..curve };
            return starts.map(scaled).collect();
        }
        let ([_], Some(means)) = (self.groups.as_slice(), means(all, self.x_log)) else {
            return Vec::new();
        };
        let points = self.scaled(means, y_log);
        vec![Curve { name: "mean".to_owned(), points, style: Style::Reference }]
    }

    fn ideal_machine(&self, column: usize, factor: f64, y_log: bool) -> Curve {
        let mut points = self.points(self.rows, column, factor);
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.dedup_by(|a, b| a.0 == b.0);
        let points = self.scaled(thinned(points), y_log);
        Curve { name: "ideal machine".to_owned(), points, style: Style::Reference }
    }

    fn caption(&self, averaged: bool) -> String {
        let (path, runs) = (self.path, self.rows.len());
        let mut caption =
            format!("Each dot is a run that reached its end, at its value of {path}.");
        if self.over_starts {
            caption += " Lines join means over the starts; grey: their 95 % intervals.";
        } else if averaged {
            caption +=
                " The dashed line joins the means of runs at the same or neighbouring values.";
        }
        if runs > DOTS {
            caption += &format!(" Shown are {DOTS} runs of {runs}, evenly chosen.");
        }
        caption
    }
}

/// What a varied number is, in words, with its unit; of what has no words here the path.
pub(super) fn in_words(path: &str) -> String {
    let known = [
        ("joints.clearance", "clearance (m)"),
        ("joints.friction", "coefficient of friction"),
        ("joints.bearing_radius", "bearing radius (m)"),
        ("mechanism.platform_mass", "mass of the platform (kg)"),
        ("motion.period", "period (s)"),
        ("motion.radius", "radius (m)"),
        ("motion.phase", "phase of the start (rad)"),
        ("contact.restitution", "restitution"),
        ("contact.c_max", "damping (N s/m)"),
        ("simulation.tolerance", "tolerance (m/s)"),
        ("drive.stiffness", "stiffness of the drives (N/m)"),
        ("drive.damping", "damping of the drives (N s/m)"),
    ];
    let words = known.iter().find(|(name, _)| *name == path).map(|(_, words)| (*words).to_owned());
    words.unwrap_or_else(|| format!("{path} (SI units)"))
}

fn scale(value: f64, log: bool) -> f64 {
    if log { value.log10() } else { value }
}

fn cell(row: &StringRecord, column: usize) -> Option<f64> {
    row.get(column)?.parse().ok()
}

/// Whether positive values spread so far that only their logarithms can be told apart.
fn wide(values: impl Iterator<Item = f64>) -> bool {
    let (least, most) =
        values.fold((f64::INFINITY, 0.0f64), |(least, most), v| (least.min(v), most.max(v)));
    least > 0.0 && most >= LOG_SPREAD * least
}

/// The runs by their values of the other lists and ranges if these are few, or all of them.
fn groups<'a>(
    varied: &[Vary],
    rows: &[&'a StringRecord],
    input: usize,
) -> Vec<(String, Vec<&'a StringRecord>)> {
    // In the order of the runs.
    let mut places: BTreeMap<String, usize> = BTreeMap::new();
    let mut groups: Vec<(String, Vec<&StringRecord>)> = Vec::new();
    for row in rows {
        let others = varied
            .iter()
            .enumerate()
            .filter(|(k, v)| *k != input && !v.is_random() && !is_start(&v.path));
        let name: Vec<String> = others.map(|(k, v)| format!("{} = {}", v.path, &row[k])).collect();
        let name = name.join(", ");
        let place = *places.entry(name.clone()).or_insert(groups.len());
        if place == groups.len() {
            groups.push((name, Vec::new()));
        }
        if groups.len() > GROUPS {
            break;
        }
        groups[place].1.push(row);
    }
    if (2..=GROUPS).contains(&groups.len()) {
        return groups;
    }
    vec![("runs".to_owned(), rows.to_vec())]
}

fn thinned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let stride = points.len().div_ceil(DOTS).max(1);
    points.into_iter().step_by(stride).collect()
}

/// Means over the runs at each value, and their 95 % intervals as a band; `positive` keeps the band where a logarithm has
/// a value.
fn interval(mut points: Vec<(f64, f64)>, name: &str, positive: bool) -> [Curve; 2] {
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let at = |chunk: &[(f64, f64)]| {
        let values: Vec<f64> = chunk.iter().map(|point| point.1).collect();
        (chunk[0].0, Spread::of(&values), values.into_iter().fold(f64::INFINITY, f64::min))
    };
    let means: Vec<_> = points.chunk_by(|a, b| a.0 == b.0).map(at).collect();
    let known = || means.iter().filter(|(_, spread, _)| spread.half.is_finite());
    let upper = known().map(|(x, spread, _)| (*x, spread.mean + spread.half));
    let lower = known().rev().map(|(x, spread, least)| {
        let end = spread.mean - spread.half;
        (*x, if positive && end <= 0.0 { *least } else { end })
    });
    let band = Curve {
        name: "95 % interval".to_owned(),
        points: upper.chain(lower).collect(),
        style: Style::Band,
    };
    let points = means.iter().map(|(x, spread, _)| (*x, spread.mean)).collect();
    [band, Curve { name: name.to_owned(), points, style: Style::Solid }]
}

/// Means at each value of x, or where these are many, over stretches with the same number of runs;
/// none if there are too few runs for either.
fn means(mut points: Vec<(f64, f64)>, x_log: bool) -> Option<Vec<(f64, f64)>> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let count = points.len();
    let distinct = points.chunk_by(|a, b| a.0 == b.0).count();
    let repeats = distinct <= MEANS && count >= RUNS_AT_A_VALUE * distinct;
    let chunks: Vec<&[(f64, f64)]> = if repeats {
        points.chunk_by(|a, b| a.0 == b.0).collect()
    } else {
        points.chunks(count.div_ceil(MEANS).max(RUNS_OF_A_STRETCH)).collect()
    };
    let fewest = if repeats { 2 } else { FEWEST_STRETCHES };
    if chunks.len() < fewest {
        return None;
    }
    let mean = |chunk: &[(f64, f64)]| {
        let n = chunk.len() as f64;
        let x = chunk.iter().map(|p| scale(p.0, x_log)).sum::<f64>() / n;
        let x = if x_log { 10f64.powf(x) } else { x };
        (x, chunk.iter().map(|p| p.1).sum::<f64>() / n)
    };
    Some(chunks.into_iter().map(mean).collect())
}

#[cfg(test)]
mod tests {
    use super::means;

    /// `y = x²` over four decades: two stretches of it have no line of means, ten have, and so have two values that repeat.
    #[test]
    fn means_are_joined_where_the_line_between_them_says_something() {
        let runs = |count: usize| -> Vec<(f64, f64)> {
            let x = |k: usize| 10f64.powf(4.0 * k as f64 / count as f64);
            (0..count).map(|k| (x(k), x(k) * x(k))).collect()
        };
        assert!(means(runs(40), true).is_none());
        assert_eq!(means(runs(200), true).map(|means| means.len()), Some(10));
        let twice: Vec<_> = (0..10).map(|k| (f64::from(k % 2), 1.0)).collect();
        assert_eq!(means(twice, false), Some(vec![(0.0, 1.0), (1.0, 1.0)]));
    }
}
