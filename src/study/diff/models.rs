//! Two models, each simulated from several starts.

use super::page::{self, RUNS_FILE};
use super::result::{Diff, FigureRow};
use super::series::{TimeTable, overlaid};
use super::{FinishedDiff, Side, unlike, unlike_times};
use crate::measure::student::t95;
use crate::report::{Curve, Label, Panel, Picture, Style, panels_svg};
use crate::results::Folder;
use crate::results::RunError;
use crate::scenario::{Problem, Scenario};
use crate::simulate::{Provenance, measured};
use crate::study::StudyError;
use crate::study::Watch;
use crate::study::compare::{CompareMeasured, Mean, QUANTITIES, machine, measure, tolerance};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use std::time::Instant as Clock;

/// Half widths of a 95 % interval by which means must differ: a third of a per cent of differences by chance exceed it
/// (Student's t of 14 degrees of freedom), so that of fifteen figures hardly one does.
const SURE: f64 = 1.5;

/// Relative difference below which two means are the same whatever their scatter: what a tolerance leaves of a
/// motion that is not chaotic.
const LEAST_DIFFERENCE: f64 = 1e-4;

/// Simulated time in s of a difference of models, by which its progress counts.
pub fn simulated_time(sides: &[Side; 2], starts: usize) -> f64 {
    sides.iter().map(|side| side.scenario().simulation.duration).sum::<f64>() * (starts + 1) as f64
}

/// Simulates both from several starts and writes what differs into `folder`. `watch` sees the time simulated so
/// far, in s.
///
/// # Errors
/// A machine that cannot be put together, files that cannot be written; the folder is left as it was.
pub fn diff_models(
    sides: &[Side; 2],
    names: [String; 2],
    starts: usize,
    folder: Folder,
    watch: &Watch,
) -> Result<FinishedDiff, StudyError> {
    let started = Clock::now();
    let both = [0, 1].map(|i| sides[i].scenario());
    let runs = simulate(both, starts, watch)?;
    let rows = rows(&runs, starts);
    let of = |i: usize| Provenance::of(both[i]);
    let mut diff = Diff {
        provenance: of(0),
        second: of(1),
        names,
        of: "models",
        starts,
        predictable_until_s: None,
        sure: SURE,
        rows,
        warnings: unlike_times(sides).into_iter().chain(broken(&runs)).collect(),
        answer: String::new(),
        wall_s: 0.0,
        files: Vec::new(),
    };
    diff.warnings.extend(unlike(sides)?);
    diff.answer = diff.in_words();
    let mut pictures = vec![every_run(&diff, &runs)?];
    pictures.extend(over_time(both, &diff.names)?);
    diff.wall_s = started.elapsed().as_secs_f64();
    page::write(diff, &pictures, folder)
}

/// All runs, of the first and of the second, start by start.
fn simulate(
    both: [&Scenario; 2],
    starts: usize,
    watch: &Watch,
) -> Result<[Vec<CompareMeasured>; 2], StudyError> {
    let jobs: Vec<(usize, usize)> =
        (0..starts).flat_map(|start| [(0, start), (1, start)]).collect();
    let results = jobs
        .into_par_iter()
        .map(|(side, start)| {
            let scenario = both[side];
            let control = tolerance(scenario);
            let mut machine = machine(scenario, scenario.contact.law, control, start, starts)?;
            Ok(measure(scenario, &mut machine, watch))
        })
        .collect::<Result<Vec<CompareMeasured>, Problem>>()?;
    watch.ended()?;
    let of = |side: usize| results.iter().skip(side).step_by(2).cloned().collect();
    Ok([of(0), of(1)])
}

/// The figures that both have, with means over the starts.
fn rows(runs: &[Vec<CompareMeasured>; 2], starts: usize) -> Vec<FigureRow> {
    let figure = |(i, quantity): (usize, &crate::study::compare::ComparedQuantity)| {
        let [a, b] = [0, 1].map(|side: usize| {
            let good = runs[side].iter().filter(|run| run.halted.is_none());
            Mean::of(good.map(|run| run.values[i]))
        });
        let difference = b.mean - a.mean;
        let floor = t95(starts - 1) * a.sem.hypot(b.sem);
        let least = LEAST_DIFFERENCE * a.mean.abs().max(b.mean.abs());
        difference.is_finite().then(|| FigureRow {
            key: quantity.key.to_owned(),
            label: quantity.label.to_owned(),
            unit: quantity.unit,
            values: [a.mean, b.mean],
            difference,
            floor: Some(floor),
            one_draw: false,
            differs: Some(difference.abs() > (SURE * floor).max(least)),
        })
    };
    QUANTITIES.iter().enumerate().filter_map(figure).collect()
}

/// Runs that broke down or saw faults of their own.
fn broken(runs: &[Vec<CompareMeasured>; 2]) -> Vec<String> {
    let told = |(side, runs): (&str, &Vec<CompareMeasured>)| {
        let halted = runs.iter().filter_map(|run| run.halted.as_deref());
        let faulty = runs.iter().flat_map(|run| run.faults.iter().map(String::as_str));
        let said: Vec<&str> = halted.chain(faulty).collect();
        said.first().map(|first| format!("{} of the {side} model's runs: {first}", said.len()))
    };
    ["first", "second"].into_iter().zip(runs).filter_map(told).collect()
}

/// One dot a run, figure by figure.
fn every_run(diff: &Diff, runs: &[Vec<CompareMeasured>; 2]) -> Result<Picture, RunError> {
    let panel = |row: &FigureRow| {
        let i = QUANTITIES.iter().position(|quantity| quantity.key == row.key)?;
        let curves = diff.names.iter().zip(runs).enumerate().map(|(k, (name, runs))| Curve {
            name: format!("{} {name}", k + 1),
            points: runs.iter().map(|run| ((k + 1) as f64, run.values[i])).collect(),
            style: Style::Dots,
        });
        Some(Panel {
            title: row.label.clone(),
            x_label: Label::counted("model"),
            y_label: row.unit.into(),
            curves: curves.collect(),
        })
    };
    // What differs first; more than six panels are no picture.
    let mut shown: Vec<&FigureRow> = diff.rows.iter().collect();
    shown.sort_by_key(|row| row.differs != Some(true));
    let panels: Vec<Panel> = shown.into_iter().filter_map(panel).take(6).collect();
    Ok(Picture {
        file: RUNS_FILE.to_owned(),
        title: "Every run".to_owned(),
        caption: "One dot a run. Where the dots of both lie apart, the models differ by more than chance.".to_owned(),
        svg: panels_svg(&panels)?,
    })
}

/// The first start of both over time.
fn over_time(both: [&Scenario; 2], names: &[String; 2]) -> Result<Option<Picture>, StudyError> {
    let [first, second] = [series(both[0])?, series(both[1])?];
    let mut panels = Vec::new();
    for head in &first.heads[1..] {
        let (title, label, scale) = match head.as_str() {
            "path error" => ("Distance from the ideal position", "distance (mm)", 1e3),
            "acceleration" => ("Acceleration of the output", "|a| (m/s²)", 1.0),
            drive => (drive, "effort of the drive (N or N m)", 1.0),
        };
        panels.extend(overlaid([&first, &second], names, head, (title, label, scale)));
    }
    if panels.is_empty() {
        return Ok(None);
    }
    Ok(Some(Picture {
        file: "over-time.svg".to_owned(),
        title: "One start over time".to_owned(),
        caption: "The first start of both. Where joints rattle, each is one draw: what differs from hit to hit says \
                  nothing of the models."
            .to_owned(),
        svg: panels_svg(&panels).map_err(RunError::from)?,
    }))
}

/// Path error, acceleration and efforts of one run as its scenario says.
fn series(scenario: &Scenario) -> Result<TimeTable, StudyError> {
    let mut machine = crate::simulate::assemble(scenario)?;
    let drives = machine.mechanism.actuators.iter().map(|drive| drive.name.clone());
    let heads = ["t", "path error", "acceleration"].map(str::to_owned).into_iter();
    let heads: Vec<String> = heads.chain(drives).collect();
    let mut columns = vec![Vec::new(); heads.len()];
    measured(scenario, &mut machine, &mut |mechanism, instant, ideal| {
        let position = mechanism.output_state(instant.states).position;
        let figures = [instant.t, (position - ideal.position).norm(), instant.peaks.acceleration];
        let figures = figures.into_iter().chain(instant.evaluation.drive_forces.iter().copied());
        columns.iter_mut().zip(figures).for_each(|(column, figure)| column.push(figure));
    });
    Ok(TimeTable { heads, columns })
}
