//! Two results of runs, as they lie there.

use super::page;
use super::result::{Diff, FigureRow};
use super::series::{TimeTable, overlaid};
use super::{FinishedDiff, Side, unlike, unlike_times};
use crate::measure::bounded;
use crate::report::{Panel, Picture, panels_svg};
use crate::results::Folder;
use crate::results::RunError;
use crate::simulate::Provenance;
use crate::study::StudyError;
use crate::study::chaos;
use crate::study::compare::QUANTITIES;
use crate::study::run::{SUMMARY_FILE, TIME_SERIES_FILE};
use serde_json::Value;
use std::path::Path;
use std::time::Instant as Clock;

/// Relative difference that rounding in a file makes.
const ROUNDING: f64 = 1e-9;

/// Largest difference, in units of both runs' own errors together, that these errors make: they are measured over some
/// tenths of a second and known to a factor.
const SURE: f64 = 3.0;

/// Figures of summaries beside those of comparisons.
const FIGURES: [(&str, &str, &str); 3] = [
    ("rms_actuator_torque_deviation_Nm", "actuator torques, rms deviation from ideal", "N m"),
    ("peak_actuator_torque_Nm", "actuator torque, peak", "N m"),
    ("impacts", "impacts", ""),
];

/// A result read.
struct Read {
    summary: Value,
    series: TimeTable,
}

impl Read {
    fn of(folder: &Path) -> Result<Self, StudyError> {
        let file = folder.join(SUMMARY_FILE);
        let wrong = |error: &dyn std::fmt::Display| {
            StudyError::Input(format!("{}: cannot be read: {error}", file.display()))
        };
        let text = bounded::text(&file, bounded::TABLE).map_err(|error| wrong(&error))?;
        let summary = serde_json::from_str(&text).map_err(|error| wrong(&error))?;
        let series = TimeTable::read(&folder.join(TIME_SERIES_FILE)).map_err(StudyError::Input)?;
        Ok(Self { summary, series })
    }

    fn number(&self, key: &str) -> Option<f64> {
        self.summary.pointer(key)?.as_f64()
    }

    /// Whether pairs of runs part exponentially.
    fn chaotic(&self) -> bool {
        let simulated = self.number("/simulated_s").unwrap_or(chaos::WINDOW);
        self.number("/lyapunov_exponent_1_s").is_some_and(|rate| chaos::chaotic(rate, simulated))
    }
}

/// Compares two results and writes what differs into `folder`.
///
/// # Errors
/// Files that cannot be read or written; the folder is left as it was.
pub fn diff_results(
    sides: &[Side; 2],
    folders: [&Path; 2],
    names: [String; 2],
    folder: Folder,
) -> Result<FinishedDiff, StudyError> {
    let started = Clock::now();
    let both = [Read::of(folders[0])?, Read::of(folders[1])?];
    let chaotic = both.iter().any(Read::chaotic);
    let horizon = both.iter().filter_map(|read| read.number("/predictability_horizon_s"));
    let horizon = horizon.reduce(f64::min).filter(|_| chaotic);
    let mut rows = figures(&both, chaotic);
    rows.extend(columns(&both, horizon));
    let of = |i: usize| Provenance::of(sides[i].scenario());
    let times = unlike_times(sides).into_iter();
    let mut diff = Diff {
        provenance: of(0),
        second: of(1),
        of: "results",
        starts: 1,
        predictable_until_s: horizon,
        sure: SURE,
        rows,
        warnings: times.chain(warnings(chaotic, horizon, folders)).collect(),
        answer: String::new(),
        wall_s: 0.0,
        files: Vec::new(),
        names,
    };
    diff.warnings.extend(unlike(sides)?);
    diff.answer = diff.in_words();
    let pictures = over_time(&both, &diff)?;
    diff.wall_s = started.elapsed().as_secs_f64();
    page::write(diff, &pictures, folder)
}

fn warnings(chaotic: bool, horizon: Option<f64>, folders: [&Path; 2]) -> Vec<String> {
    if !chaotic {
        return Vec::new();
    }
    let [a, b] = folders.map(|folder| folder.join("scenario.toml").display().to_string());
    let until = horizon.map_or(String::new(), |horizon| {
        format!(
            " Columns are compared up to {} s, until which the runs can be predicted.",
            crate::report::number(horizon)
        )
    });
    vec![format!(
        "The machine is chaotic: the peaks, means and counts of a single run are one draw, and another start gives \
         others. Means over starts: freeplay diff {a} {b}.{until}"
    )]
}

/// Figures of both summaries. Those of chaotic runs are one draw each: nobody knows their floor.
fn figures(both: &[Read; 2], chaotic: bool) -> Vec<FigureRow> {
    let known = QUANTITIES.iter().map(|quantity| (quantity.key, quantity.label, quantity.unit));
    let row = |(key, label, unit): (&str, &str, &'static str)| {
        let path = format!("/{key}");
        let [a, b] = [both[0].number(&path)?, both[1].number(&path)?];
        let floor = (!chaotic).then(|| ROUNDING * a.abs().max(b.abs()));
        let difference = b - a;
        let differs = floor.map(|floor| difference.abs() > SURE * floor);
        let (key, label) = (key.to_owned(), label.to_owned());
        Some(FigureRow {
            key,
            label,
            unit,
            values: [a, b],
            difference,
            floor,
            differs,
            one_draw: chaotic,
        })
    };
    known.chain(FIGURES).filter_map(row).collect()
}

/// The unit of a column of a time series, by how its name begins, and whether it is a place.
fn unit(head: &str) -> (&'static str, bool) {
    let begins = |starts: &[&str]| {
        starts.iter().any(|start| {
            let rest = head.strip_prefix(start);
            rest.is_some_and(|rest| {
                rest.is_empty() || rest.starts_with('_') || rest.parse::<u8>().is_ok()
            })
        })
    };
    match () {
        () if begins(&["x", "y"]) => ("m", true),
        () if begins(&["phi"]) => ("rad", false),
        () if begins(&["vx", "vy"]) => ("m/s", false),
        () if begins(&["omega"]) => ("rad/s", false),
        () if begins(&["ax", "ay"]) => ("m/s²", false),
        () if begins(&["alpha"]) => ("rad/s²", false),
        () if begins(&["ecc"]) => ("m", false),
        () if begins(&["force"]) => ("N", false),
        // Legs of a 3-RPR; of other machines the name of a drive does not say whether it turns or slides.
        () if matches!(head, "q1" | "q2" | "q3") => ("m", false),
        () if matches!(head, "F1" | "F2" | "F3") => ("N", false),
        () => ("", false),
    }
}

/// What a column of a time series holds, in words, and of what: `ecc_A1` is the eccentricity of A1.
fn in_words(head: &str) -> String {
    const WORDS: [(&str, &str); 13] = [
        ("x", "position along x"),
        ("y", "position along y"),
        ("phi", "angle"),
        ("vx", "velocity along x"),
        ("vy", "velocity along y"),
        ("omega", "angular velocity"),
        ("ax", "acceleration along x"),
        ("ay", "acceleration along y"),
        ("alpha", "angular acceleration"),
        ("ecc", "eccentricity"),
        ("force", "contact force"),
        ("q", "coordinate"),
        ("F", "effort"),
    ];
    let legs = head.strip_prefix(['q', 'F']).filter(|leg| leg.parse::<u8>().is_ok());
    if let Some(leg) = legs {
        let what = if head.starts_with('q') { "length" } else { "actuator force" };
        return format!("{what} of leg {leg}");
    }
    let (what, of) = head.split_once('_').map_or((head, None), |(what, of)| (what, Some(of)));
    match (WORDS.iter().find(|(start, _)| *start == what), of) {
        (Some((_, words)), Some(of)) => format!("{words} of {of}"),
        (Some((_, words)), None) => (*words).to_owned(),
        (None, _) => format!("column {head}"),
    }
}

/// Columns that both have, up to where they can be compared.
fn columns(both: &[Read; 2], horizon: Option<f64>) -> Vec<FigureRow> {
    let [a, b] = both;
    let own = |read: &Read| read.number("/watched/own_error/position_m");
    let floor = own(a).zip(own(b)).map(|(a, b)| a + b);
    let window = [0.0, horizon.unwrap_or(f64::INFINITY)];
    let heads = a.series.heads.iter().skip(1).filter(|head| !head.ends_with("_max"));
    let row = |head: &String| {
        let [first, second, difference] = a.series.apart(&b.series, head, window)?;
        let (unit, place) = unit(head);
        let floor = floor.filter(|_| place);
        Some(FigureRow {
            key: head.clone(),
            label: format!("{}, rms", in_words(head)),
            unit,
            values: [first, second],
            difference,
            floor,
            one_draw: false,
            differs: floor
                .map(|floor| difference > (SURE * floor).max(ROUNDING * first.max(second))),
        })
    };
    heads.filter_map(row).collect()
}

/// The columns that differ most of what they are, one over the other.
fn over_time(both: &[Read; 2], diff: &Diff) -> Result<Vec<Picture>, RunError> {
    let series = [&both[0].series, &both[1].series];
    let wanted = |row: &&FigureRow| {
        let force = row.key.starts_with('F') || row.key.starts_with("force_");
        unit(&row.key).1 || row.key.starts_with('q') || force
    };
    let panel = |row: &FigureRow| {
        let unit = if row.unit.is_empty() { "SI" } else { row.unit };
        overlaid(series, &diff.names, &row.key, (&in_words(&row.key), unit, 1.0))
    };
    let panels: Vec<Panel> = diff.rows.iter().filter(wanted).filter_map(panel).take(8).collect();
    if panels.is_empty() {
        return Ok(Vec::new());
    }
    Ok(vec![Picture {
        file: "over-time.svg".to_owned(),
        title: "Both over time".to_owned(),
        caption: "Columns of both time series, the second over the first.".to_owned(),
        svg: panels_svg(&panels)?,
    }])
}
