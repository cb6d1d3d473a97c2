//! The page of a calibration and its pictures.

use super::charts::{DrawnRun, of_run};
use super::outcome::SensedOutcome;
use super::report::Report;
use crate::calibrate::results::page::{errors_table, verdict, why};
use crate::calibrate::sensed::residuals::problem::RigProblem;
use crate::calibrate::sensed::windows::horizons::Windows;
use crate::report::{PagePart, PageTable, Picture, ReportError, Style, document, known_to, number};

/// Runs that are drawn, the calibration run first: more would hide what matters.
const DRAWN: usize = 3;

const CAPTION: &str = "Declared: the rig as its file has it. Calibrated: with the effects found.";

/// Each measured column of each run as it was recorded and as it is predicted, and what is missed.
pub(super) fn pictures(
    problem: &RigProblem,
    outcome: &SensedOutcome,
) -> Result<Vec<Picture>, ReportError> {
    let mut pictures = Vec::new();
    for (index, run) in problem.runs.iter().take(DRAWN).enumerate() {
        let role = if index == 0 { "calibration" } else { "validation" };
        let models = [
            ("declared", Style::Reference, &outcome.declared[index]),
            ("calibrated", Style::Solid, &outcome.predicted[index]),
        ];
        let drawn = DrawnRun { index, role, caption: CAPTION };
        pictures.extend(of_run(&problem.declared, &run.recording, drawn, &models)?);
    }
    Ok(pictures)
}

const NOTE: &str = "Root mean square of measured less predicted, both through a zero-phase low-pass of \
                    fourth order at 25 Hz, first and last 60 ms left out. Before: the rig as declared; \
                    after: calibrated. Floor: what sensor noise and rattle leave to any model.";

/// The page.
pub(in crate::calibrate::sensed) fn page(report: &Report, pictures: &[Picture]) -> String {
    let equations: Vec<String> = report.effects.iter().map(why).collect();
    let more = [
        ("Figures", "report.json beside this page".to_owned()),
        ("Simulations", report.simulations.to_string()),
        ("Time of computing", format!("{} s", number(report.wall_s))),
    ];
    let provenance = report.provenance.lines("rig", None, more);
    let mut parts = vec![PagePart::Table(values(report))];
    if !equations.is_empty() {
        parts.push(PagePart::Text { id: "why", title: "Why these", paragraphs: &equations });
    }
    if let Some(windows) = &report.windows {
        parts.push(PagePart::Table(errors_table(&report.errors, windows.note)));
        parts.push(PagePart::Table(horizons(windows)));
        if !windows.remarks.is_empty() {
            parts.push(PagePart::Text {
                id: "remarks",
                title: "The recordings",
                paragraphs: &windows.remarks,
            });
        }
    } else {
        parts.push(PagePart::Table(errors_table(&report.errors, NOTE)));
        if !report.residuals.is_empty() {
            parts.push(PagePart::Table(residuals(report)));
        }
    }
    parts.push(PagePart::Pictures(pictures));
    parts.push(PagePart::Table(ranking(report)));
    if !report.limits.is_empty() {
        parts.push(PagePart::Table(limits(report)));
    }
    parts.push(PagePart::Provenance(&provenance));
    let title =
        format!("Calibration of {}: {}", report.provenance.scenario_name, verdict(report.verdict));
    document(&title, &report.summary, &parts)
}

fn head(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// What the effects of the model were found to be.
fn values(report: &Report) -> PageTable {
    let mut rows = Vec::new();
    for effect in &report.effects {
        for (name, fitted) in &effect.params {
            let [low, high] = fitted.ci95.map(|end| known_to(end, fitted.std));
            rows.push(vec![
                format!("{}{}", effect.kind, effect.on.words()),
                (*name).to_owned(),
                known_to(fitted.value, fitted.std),
                format!("{low} to {high}"),
            ]);
        }
    }
    PageTable {
        id: "effects",
        title: "What the model was given".into(),
        header: head(&["effect", "parameter", "value", "95 % interval"]),
        rows,
        note: "SI units. calibrated.toml holds the rig with all of this.".into(),
    }
}

/// What is left of residuals before and after.
fn residuals(report: &Report) -> PageTable {
    PageTable {
        id: "residuals",
        title: "Residuals in units of noise, on the run where most is left".into(),
        header: head(&[
            "residual",
            "mean square before",
            "after",
            "noise up to",
            "largest before",
            "after",
            "noise up to",
        ]),
        rows: report
            .residuals
            .iter()
            .map(|r| {
                let squares = [r.mean_square_before, r.mean_square_after, r.noise_up_to];
                let largest = [r.largest_before, r.largest_after, r.largest_noise_up_to];
                let cells = squares.into_iter().chain(largest);
                std::iter::once(r.residual.clone()).chain(cells.map(number)).collect()
            })
            .collect(),
        note:
            "1 is noise. Law: a drive against its command; dynamics: efforts against the measured \
               motion; closure: a position against the others."
                .into(),
    }
}

/// What the search tried.
fn ranking(report: &Report) -> PageTable {
    PageTable {
        id: "candidates",
        title: "Candidates, round by round".into(),
        header: head(&["round", "candidate", "removes", "gain", ""]),
        rows: report
            .ranking
            .iter()
            .filter(|ranked| ranked.gain > 0.0)
            .map(|ranked| {
                vec![
                    ranked.round.to_string(),
                    format!("{}{}", ranked.kind, ranked.on.words()),
                    format!("{:.1} %", 100.0 * ranked.validation_score),
                    number(ranked.gain),
                    if ranked.kept { "kept" } else { "" }.to_owned(),
                ]
            })
            .collect(),
        note: "Of what stands above noise on data that a candidate was not fitted to.".into(),
    }
}

/// How large other effects would have to be.
fn limits(report: &Report) -> PageTable {
    PageTable {
        id: "limits",
        title: "What would have been seen".into(),
        header: head(&["effect", "parameter", "from", "unit"]),
        rows: report
            .limits
            .iter()
            .map(|limit| {
                vec![
                    format!("{}{}", limit.kind, limit.on.words()),
                    limit.parameter.to_owned(),
                    limit.smallest.map_or_else(|| "not at any size".to_owned(), number),
                    limit.unit.to_owned(),
                ]
            })
            .collect(),
        note: "How far from its neutral value a parameter would have to be for these recordings to show it, \
               by the linearisation of the fit, with 98 % certainty."
            .into(),
    }
}

/// Errors of all runs by windows.
fn horizons(windows: &Windows) -> PageTable {
    let rows = windows.horizons.iter().flat_map(|of| {
        of.errors.iter().map(|e| {
            let horizon = of.horizon;
            let times = [horizon.window_s, horizon.fit_s, horizon.from_s].map(|t| format!("{t} s"));
            let errors = [e.before, e.after, e.floor].map(number);
            let run = [of.run.clone(), of.role.to_owned()];
            run.into_iter().chain(times).chain([e.channel.clone()]).chain(errors).collect()
        })
    });
    PageTable {
        id: "horizons",
        title: "Errors over windows".into(),
        header: head(&[
            "run",
            "role",
            "window",
            "fitted to",
            "from",
            "column",
            "declared",
            "calibrated",
            "floor",
        ]),
        rows: rows.collect(),
        note: "Root mean squares in SI units.".into(),
    }
}
