//! What is written of a calibration by windows.

use super::fitting::bench::Bench;
use super::horizons::{HorizonErrors, RunZero, Windows};
use super::outcome::{Certain, JudgedRun, LeftOut, WindowsOutcome, calibrate, with};
use super::score::Score;
use crate::calibrate::results::charts::{POINTS, panel, thinned};
use crate::calibrate::results::report::{ActsOn, EffectReport, Ranked, RattleReport, Seeds};
use crate::calibrate::results::result::CalibrateError;
use crate::calibrate::results::result::stem_of;
use crate::calibrate::results::verdict::Verdict;
use crate::calibrate::sensed::events::picture::pictures as events_drawn;
use crate::calibrate::sensed::events::{self, Event};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::results::report::Report;
use crate::calibrate::sensed::results::written::{SensedCalibration, names_of_files, written};
use crate::calibrate::sensed::rounds::words::name;
use crate::calibrate::values::errors::ChannelError;
use crate::report::{Curve, Picture, Style, panels_svg};
use crate::results::{Folder, RunError};
use crate::scenario::Scenario;
use crate::simulate::Provenance;
use std::time::Instant as Clock;

pub(super) const NOTE: &str = "This machine forgets its start, so errors are those of predictions over windows: the start of \
    each is fitted through the model to its first part, the rest is compared, unfiltered. The first horizon is that \
    of `errors`.";

/// Errors of a run by columns, under a model before and one after.
pub(super) fn channel_errors(
    bench: &Bench,
    run: usize,
    role: &'static str,
    before: Option<&Score>,
    after: &Score,
) -> Vec<ChannelError> {
    let sensors = bench.sensors.iter().enumerate();
    sensors
        .map(|(i, &sensor)| ChannelError {
            run: bench.runs[run].name.clone(),
            role,
            channel: bench.mechanism.sensors[sensor].column.clone(),
            unit: bench.mechanism.sensors[sensor].unit(&bench.mechanism),
            before: before.map_or(f64::NAN, |score| score.errors[i]),
            after: after.errors[i],
            floor: after.floors[i],
        })
        .collect()
}

/// Zeros that belong to runs.
pub(super) fn run_zeros(bench: &Bench, zeros: &[Vec<[f64; 2]>]) -> Vec<RunZero> {
    let free = bench.zeros_of_runs();
    let mut listed = Vec::new();
    for (run, own) in bench.runs.iter().zip(zeros) {
        for (i, [offset, std]) in own.iter().enumerate().filter(|(i, _)| free[*i] > 0.0) {
            let sensor = bench.mechanism.sensors[bench.sensors[i]].column.clone();
            listed.push(RunZero { run: run.name.clone(), sensor, offset: *offset, std: *std });
        }
    }
    listed
}

/// Columns that said what drives gave.
pub(super) fn input_columns(bench: &Bench) -> Vec<String> {
    let first = bench.runs.first();
    (0..bench.mechanism.actuators.len())
        .filter_map(|drive| super::fitting::inputs::input_sensor(&bench.mechanism, first?, drive))
        .map(|sensor| bench.mechanism.sensors[sensor].column.clone())
        .collect()
}

/// A recording with predicted columns in place of compared ones.
pub(super) fn predicted(bench: &Bench, run: usize, score: &Score) -> Recording {
    let recording = &bench.runs[run];
    let sensors = bench.mechanism.sensors.len();
    let mut columns: Vec<Option<Vec<f64>>> =
        (0..sensors).map(|i| recording.get(i).map(<[f64]>::to_vec)).collect();
    for (&sensor, values) in bench.sensors.iter().zip(&score.predicted) {
        columns[sensor] = Some(values.clone());
    }
    recording.with(columns)
}

/// Measured and predicted columns of a run, and what is missed.
pub(super) fn pictures(
    bench: &Bench,
    run: usize,
    role: &str,
    models: &[(&str, Style, &Score)],
) -> Result<Vec<Picture>, CalibrateError> {
    let recording = &bench.runs[run];
    let (mut signals, mut missed) = (Vec::new(), Vec::new());
    for (i, &sensor) in bench.sensors.iter().enumerate() {
        let of = &bench.mechanism.sensors[sensor];
        let Some(measured) = recording.get(sensor) else { continue };
        let curve = |name: &str, value: &dyn Fn(usize) -> f64, style| {
            let at = |row: usize| (recording.start + row as f64 * recording.interval, value(row));
            let points: Vec<(f64, f64)> =
                (0..recording.samples).map(at).filter(|(_, v)| v.is_finite()).collect();
            Curve { name: name.to_owned(), points: thinned(&points, POINTS), style }
        };
        let unit = of.unit(&bench.mechanism);
        let mut shown = vec![curve("measured", &|row| measured[row], Style::Solid)];
        let mut left = Vec::new();
        for (name, style, score) in models {
            let values = &score.predicted[i];
            shown.push(curve(name, &|row| values[row], *style));
            left.push(curve(name, &|row| measured[row] - values[row], *style));
        }
        signals.push(panel(of.column.clone(), unit, shown.into_iter()));
        missed.push(panel(format!("{}, measured − model", of.column), unit, left.into_iter()));
    }
    let mut pictures = Vec::new();
    for (panels, what, file) in
        [(&signals, "Measured and predicted", "signals"), (&missed, "What is missed", "missed")]
    {
        pictures.push(Picture {
            file: format!("{file}-{}.svg", run + 1),
            title: format!("{what}, {} ({role})", recording.name),
            caption: NOTE.to_owned(),
            svg: panels_svg(panels).map_err(RunError::from)?,
        });
    }
    Ok(pictures)
}

fn role(run: usize, fits: usize) -> &'static str {
    if run < fits { "calibration" } else { "validation" }
}

/// Calibrates by windows on the first `fits` recordings and writes everything about it into `folder`.
///
/// # Errors
/// A rig that cannot be put together, files that cannot be written.
pub fn into_folder(
    rig: &Scenario,
    recordings: Vec<Recording>,
    fits: usize,
    without: &[&str],
    folder: Folder,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<SensedCalibration, CalibrateError> {
    let started = Clock::now();
    let (bench, outcome) = calibrate(rig, recordings, fits, without, tell)?;
    tell("drawing and writing");
    let (mut files, mut drawn) = (Vec::new(), Vec::new());
    let (mut errors, mut horizons) = (Vec::new(), Vec::new());
    let main = outcome.judged.first().map(|j| j.horizon);
    for JudgedRun { run, horizon, before, after } in &outcome.judged {
        let role = role(*run, fits);
        let of = channel_errors(&bench, *run, role, Some(before), after);
        if Some(*horizon) == main {
            errors.extend(of.iter().cloned());
            let sensors = &bench.mechanism.sensors;
            let text = predicted(&bench, *run, after).to_csv(sensors);
            files.push((format!("predicted-{}.csv", stem_of(&bench.runs[*run].name)), text));
            let models =
                [("declared", Style::Reference, before), ("calibrated", Style::Solid, after)];
            drawn.extend(pictures(&bench, *run, role, &models)?);
        }
        let name = bench.runs[*run].name.clone();
        let (horizon, windows) = (*horizon, after.windows);
        horizons.push(HorizonErrors { run: name, role, horizon, windows, errors: of });
    }
    drawn.extend(events_drawn(&outcome.events).map_err(RunError::from)?);
    let report = Report {
        provenance: Provenance::of(rig),
        verdict: outcome.verdict,
        summary: format!("{}{}", summary(&outcome), events::found::sentence(&outcome.events)),
        effects: effects(&outcome),
        errors,
        ranking: ranking(&outcome),
        noises: Vec::new(),
        limits: Vec::new(),
        residuals: Vec::new(),
        rattle: RattleReport { chaotic: false, difference: 0.0, replicas: 1 },
        without: without.iter().map(|kind| (*kind).to_owned()).collect(),
        tolerance_m_s: f64::NAN,
        seeds: Seeds { scenario: rig.seed, replicas: Vec::new() },
        simulations: 0,
        wall_s: started.elapsed().as_secs_f64(),
        files: names_of_files(&files, &drawn),
        windows: Some(Windows {
            note: NOTE,
            fitted_s: outcome.lengths.clone(),
            horizons,
            run_zeros: run_zeros(&bench, &outcome.zeros),
            inputs: input_columns(&bench),
            remarks: bench.runs.iter().flat_map(Recording::remarks).collect(),
            left_out: outcome.left_out.iter().map(|left| name(&left.effect)).collect(),
        }),
    };
    written(report, &with(rig, &outcome.model), &files, &drawn, folder)
}

fn summary(outcome: &WindowsOutcome) -> String {
    let list = outcome.effects.iter().map(|c| name(&c.effect)).collect::<Vec<_>>().join(", ");
    match (outcome.verdict, outcome.fitted) {
        (_, false) => "No values could be fitted: the declared model does not follow these recordings even over \
                       short windows."
            .to_owned(),
        (Verdict::NothingMissing, _) => {
            "The declared model predicts the recordings to within noise: nothing is missing.".to_owned()
        }
        (Verdict::Explained, _) if list.is_empty() => {
            "With what does not last the declared model predicts the recordings to within noise.".to_owned()
        }
        (Verdict::Explained, _) => format!(
            "The declared model lacks {list}. With it the recordings are predicted to within noise."
        ),
        (Verdict::Unexplained, _) if list.is_empty() => {
            "What the declared model misses stands above noise, and nothing that is tried here makes it certainly \
             less."
                .to_owned()
        }
        (Verdict::Unexplained, _) => format!(
            "The declared model certainly lacks {list}. More is missing: what remains stands above the sensors' noise."
        ),
    }
}

/// What lasts, then what does not.
fn effects(outcome: &WindowsOutcome) -> Vec<EffectReport> {
    let lasting = outcome.effects.iter().map(effect);
    lasting.chain(outcome.events.iter().map(Event::report)).collect()
}

fn effect(certain: &Certain) -> EffectReport {
    EffectReport {
        kind: certain.effect.kind.name,
        on: ActsOn::of(&certain.effect),
        depends_on: None,
        params: certain.params.clone(),
        evidence: format!(
            "is {:.0} squared standard deviations from nothing, by how differently windows pull at it",
            certain.gain
        ),
        as_good: Vec::new(),
        not_ruled_out: Vec::new(),
        equation: certain.effect.kind.equation,
    }
}

fn ranking(outcome: &WindowsOutcome) -> Vec<Ranked> {
    let kept = outcome.effects.iter().map(|c| (&c.effect, c.gain, true));
    let left = outcome.left_out.iter().map(|LeftOut { effect, gain }| (effect, *gain, false));
    let mut all: Vec<_> = kept.chain(left).collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all.into_iter()
        .map(|(effect, gain, kept)| Ranked {
            kind: effect.kind.name,
            on: ActsOn::of(effect),
            validation_score: f64::NAN,
            kept,
            round: 1,
            simulated: true,
            gain,
        })
        .collect()
}
