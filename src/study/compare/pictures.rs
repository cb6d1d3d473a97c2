//! The pictures of a comparison.

use super::plan::{ComparePlan, machine};
use super::probe::CompareMeasured;
use super::quantities::index;
use super::result::{Comparison, RowResult};
use crate::engine::{self, Schedule};
use crate::report::{Curve, Label, Panel, Picture, ReportError, Style, number, panels_svg};
use crate::results::RunError;
use crate::scenario::{Law, Scenario};
use crate::study::StudyError;
use crate::study::chaos::{self, Chaos};

/// Time in s that the curves side by side show: the first hits and what follows.
const SHOWN: f64 = 0.06;

/// Points of a distribution's curve.
const DISTRIBUTION: usize = 400;

/// Draws all pictures. `runs` are by row of the plan.
pub fn draw(
    scenario: &Scenario,
    comparison: &Comparison,
    plan: &ComparePlan,
    runs: &[Vec<CompareMeasured>],
    looks: &[Chaos],
) -> Result<Vec<Picture>, StudyError> {
    let draw = |picture: Result<Picture, ReportError>| picture.map_err(RunError::from);
    let mut pictures = vec![
        draw(over_step(comparison))?,
        draw(side_by_side(beginnings(scenario, plan)?))?,
        draw(distributions(comparison, runs))?,
    ];
    if !looks.is_empty() {
        pictures.push(draw(parting(looks))?);
    }
    Ok(pictures)
}

fn solid(name: String, points: Vec<(f64, f64)>) -> Curve {
    Curve { name, points, style: Style::Solid }
}

/// A quantity over the step (both as they are drawn), law by law.
fn quantity_over_step(comparison: &Comparison, key: &str, scale: fn(f64) -> f64) -> Vec<Curve> {
    let Some(i) = index(key) else { return Vec::new() };
    let points = |law: Law| -> Vec<(f64, f64)> {
        let point = |row: &RowResult| Some((row.step_s?.log10(), scale(row.quantities[i].mean)));
        comparison.rows_of(law).filter_map(point).collect()
    };
    let mut curves: Vec<Curve> =
        [Law::HertzStep, Law::Native].map(|law| solid(law.name().to_owned(), points(law))).into();
    // The law at its tolerance has no step: a level.
    let (law, steps) = (comparison.best(Law::HertzStep), points(Law::Native));
    if let (Some(law), Some(first), Some(last)) = (law, steps.first(), steps.last()) {
        let level = scale(law.quantities[i].mean);
        curves.push(Curve {
            name: "hertz-step at its tolerance".into(),
            points: vec![(first.0, level), (last.0, level)],
            style: Style::Reference,
        });
    }
    curves
}

/// Quantities over the step: the peak force of all, of the first hit, and two that are no forces.
fn over_step(comparison: &Comparison) -> Result<Picture, ReportError> {
    let panel = |title: &str, y_label: Label, curves: Vec<Curve>| Panel {
        title: title.to_owned(),
        x_label: Label::log("step (s)"),
        y_label,
        curves,
    };
    let curves = |key: &str, scale: fn(f64) -> f64| quantity_over_step(comparison, key, scale);
    let mut panels = vec![panel(
        "Peak contact force",
        Label::log("force (N)"),
        curves("peak_contact_force_N", f64::log10),
    )];
    if let Some(hits) = &comparison.first_hits {
        let curve = |law: Law| {
            let hits = hits.rows.iter().filter(|hit| hit.law == law);
            let points = hits.map(|hit| (hit.step_s.log10(), hit.peak.mean.log10())).collect();
            solid(law.name().to_owned(), points)
        };
        panels.push(panel(
            "Peak force of the first hit",
            Label::log("force (N)"),
            vec![curve(Law::HertzStep), curve(Law::Native)],
        ));
    }
    panels.push(panel(
        "Share of time in contact",
        "share".into(),
        curves("contact_fraction", |share| share),
    ));
    panels.push(panel(
        "Path error, rms",
        "error (mm)".into(),
        curves("rms_path_error_m", |metres| 1e3 * metres),
    ));
    Ok(Picture {
        file: "over-step.svg".into(),
        title: "As the step shrinks".into(),
        caption: format!(
            "Means over {} starts. Steps shrink to the left. What has a limit levels off there; what \
             has none keeps its slope. The law's curves leave their level where its hits are no \
             longer resolved.",
            comparison.starts
        ),
        svg: panels_svg(&panels)?,
    })
}

/// The beginning of one motion under one law: path error (mm), peak acceleration (m/s²), and peak
/// contact force (N), over time in s.
struct MotionBeginning {
    name: String,
    style: Style,
    curves: [Vec<(f64, f64)>; 3],
}

fn beginnings(scenario: &Scenario, plan: &ComparePlan) -> Result<Vec<MotionBeginning>, StudyError> {
    let mut beginnings = Vec::new();
    for law in super::plan::LAWS {
        let Some(row) = plan.rows.iter().rfind(|row| row.law == law) else { continue };
        let mut machine = machine(scenario, law, row.control, 0, plan.starts)?;
        let duration = SHOWN.min(scenario.simulation.duration);
        let schedule = Schedule { duration, ..machine.schedule };
        let (mechanism, ideal) = (&machine.mechanism, &mut machine.ideal);
        let mut curves = [const { Vec::new() }; 3];
        // What a run that breaks down has shown before is drawn.
        let _ = engine::run(mechanism, row.control, schedule, &mut |instant| {
            let position = mechanism.output_state(instant.states).position;
            let force = instant.tallies.iter().fold(0.0f64, |peak, tally| peak.max(tally.peak));
            let error = (position - ideal.at(instant.t).position).norm();
            curves[0].push((instant.t, 1e3 * error));
            curves[1].push((instant.t, instant.peaks.acceleration));
            if law != Law::Ideal {
                curves[2].push((instant.t, force));
            }
        });
        let step = row
            .control
            .step()
            .map_or_else(String::new, |step| format!(", step {} s", number(step)));
        let style = if law == Law::Ideal { Style::Reference } else { Style::Solid };
        beginnings.push(MotionBeginning { name: law.name().to_owned() + &step, style, curves });
    }
    // The law, drawn last, stays visible on the native spikes.
    beginnings.reverse();
    Ok(beginnings)
}

fn side_by_side(beginnings: Vec<MotionBeginning>) -> Result<Picture, ReportError> {
    let labels = [
        ("Distance of the output body from its ideal position", "distance (mm)"),
        ("Acceleration of the output body, peak since the row before", "|a| (m/s²)"),
        ("Contact force, largest of all joints, peak since the row before", "force (N)"),
    ];
    let panels: Vec<Panel> = labels
        .iter()
        .enumerate()
        .map(|(k, (title, label))| Panel {
            title: (*title).into(),
            x_label: "time (s)".into(),
            y_label: (*label).into(),
            curves: beginnings
                .iter()
                .map(|b| Curve {
                    name: b.name.clone(),
                    points: b.curves[k].clone(),
                    style: b.style,
                })
                .collect(),
        })
        .collect();
    Ok(Picture {
        file: "beginning.svg".into(),
        title: "The beginning under each model".into(),
        caption: "The same start under each model: flights are the same, then come the first hits."
            .into(),
        svg: panels_svg(&panels)?,
    })
}

/// How often a touching joint feels more than a force.
fn distributions(
    comparison: &Comparison,
    runs: &[Vec<CompareMeasured>],
) -> Result<Picture, ReportError> {
    let curve = |row: &RowResult, runs: &[CompareMeasured]| {
        let mut forces: Vec<f64> = runs.iter().flat_map(|run| run.forces.iter().copied()).collect();
        forces.sort_by(f64::total_cmp);
        let n = forces.len();
        let stride = n.div_ceil(DISTRIBUTION).max(1);
        let points = forces.iter().enumerate().step_by(stride);
        let name = match row.step_s {
            Some(step) => format!("{}, step {} s", row.law.name(), number(step)),
            None => row.law.name().to_owned(),
        };
        solid(name, points.map(|(i, f)| (f.log10(), 1.0 - i as f64 / n as f64)).collect())
    };
    let last = |law: Law| comparison.rows.iter().rposition(|row| row.law == law);
    let first = comparison.rows.iter().position(|row| row.law == Law::Native);
    let mut shown: Vec<usize> =
        [last(Law::HertzStep), first, last(Law::Native)].into_iter().flatten().collect();
    shown.dedup();
    let curves = shown.into_iter().map(|i| curve(&comparison.rows[i], &runs[i])).collect();
    let panel = Panel {
        title: "Share of the time in contact with more than this force".into(),
        x_label: Label::log("contact force (N)"),
        y_label: "share".into(),
        curves,
    };
    Ok(Picture {
        file: "force-distribution.svg".into(),
        title: "Contact forces".into(),
        caption:
            "Contact forces of all joints while they touch, sampled every 0.1 ms, of all starts."
                .into(),
        svg: panels_svg(&[panel])?,
    })
}

/// How pairs of runs part.
fn parting(looks: &[Chaos]) -> Result<Picture, ReportError> {
    let curves = looks
        .iter()
        .enumerate()
        .map(|(i, look)| {
            let grown = look.distances.iter().filter(|(_, d)| *d > 0.0);
            solid(format!("start {}", i + 1), grown.map(|(t, d)| (*t, d.log10())).collect())
        })
        .collect();
    let panel = Panel {
        title: "Distance of two motions that begin alike".into(),
        x_label: "time (s)".into(),
        y_label: Label::log("distance (m)"),
        curves,
    };
    Ok(Picture {
        file: "chaos.svg".into(),
        title: "What chaos leaves".into(),
        caption: format!(
            "Distance between the output bodies of two runs under the law whose starts differ by {} m. A \
             straight rise is exponential growth; its slope is the largest Lyapunov exponent.",
            number(chaos::DISPLACEMENT)
        ),
        svg: panels_svg(&[panel])?,
    })
}
