//! The pages of a drive stage.

use super::calibration::Report;
use super::prediction::Prediction;
use crate::calibrate::page::{errors_table, verdict};
use crate::report::{Part, Picture, Table, document, known_to, number};

const NOTE: &str = "Root mean square of measured less predicted, both through a zero-phase low-pass of \
                    fourth order at 25 Hz, first and last 60 ms left out. Floor: what the recording's own \
                    white noise leaves to any model.";

/// How the stage is sent along its recording.
const ALONG: &str = "driven by the recorded reference, its own controller closing the loop";

/// The page of a prediction.
pub(super) fn prediction(p: &Prediction, pictures: &[Picture]) -> String {
    let effects = if p.effects.is_empty() {
        "as declared, without effects".to_owned()
    } else {
        format!("with {}", p.effects.join(", "))
    };
    let carried = if p.carried_columns.is_empty() {
        String::new()
    } else {
        format!(" Columns left as they are: {}.", p.carried_columns.join(", "))
    };
    let lead = format!(
        "{}, a drive stage {effects}, {ALONG}, against {}.{carried}",
        p.provenance.scenario_name, p.run
    );
    let note = format!("{NOTE} After: the model; before: the model without its effects.");
    let more = [
        ("Run", p.run.clone()),
        ("Figures", "errors.json, predicted.csv beside this page".to_owned()),
        ("Time of computing", format!("{} s", number(p.wall_s))),
    ];
    let provenance = p.provenance.lines("model", None, more);
    let mut parts = Vec::new();
    if !p.errors.is_empty() {
        parts.push(Part::Table(errors_table(&p.errors, &note)));
    }
    parts.push(Part::Pictures(pictures));
    parts.push(Part::Provenance(&provenance));
    document(&format!("Prediction of {}", p.run), &lead, &parts)
}

/// The page of a calibration.
pub(super) fn calibration(r: &Report, pictures: &[Picture]) -> String {
    let mut rows = Vec::new();
    for effect in &r.effects {
        for (name, fitted) in &effect.params {
            let [low, high] = fitted.ci95.map(|end| known_to(end, fitted.std));
            let joint = effect.on.words();
            rows.push(vec![
                format!("{}{joint}", effect.kind),
                (*name).to_owned(),
                known_to(fitted.value, fitted.std),
                number(fitted.std),
                format!("{low} to {high}"),
            ]);
        }
    }
    for p in &r.parameters {
        let [low, high] = p.ci95.map(|end| known_to(end, p.std));
        rows.push(vec![
            format!("{} (declared: {})", p.path, number(p.declared)),
            p.unit.to_owned(),
            known_to(p.value, p.std),
            number(p.std),
            format!("{low} to {high}"),
        ]);
    }
    let head = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    let values = Table {
        id: "effects",
        title: "What the model was given".into(),
        header: head(&["effect", "parameter", "value", "± standard deviation", "95 % interval"]),
        rows,
        note: "SI units. Standard deviations count what is left stretch by stretch, since it is not white. \
               calibrated.toml holds the rig with all of this."
            .into(),
    };
    let ranking = Table {
        id: "candidates",
        title: "Candidates, round by round".into(),
        header: head(&["round", "candidate", "removes", "error after over before", "95 %", ""]),
        rows: r
            .ranking
            .iter()
            .map(|t| {
                vec![
                    t.round.to_string(),
                    t.what.clone(),
                    format!("{:.1} %", 100.0 * t.validation_score),
                    format!("{:.3}", t.ratio),
                    format!("{:.3} to {:.3}", t.ratio_ci95[0], t.ratio_ci95[1]),
                    if t.kept { "kept" } else { "" }.to_owned(),
                ]
            })
            .collect(),
        note: "On data that a candidate was not fitted to, stretch by stretch: the geometric mean of the \
               ratios of the errors, with its interval."
            .into(),
    };
    let equations: Vec<String> = r
        .effects
        .iter()
        .map(|effect| format!("{}: {}. It {}.", effect.kind, effect.equation, effect.evidence))
        .collect();
    let more = [
        ("Figures", "report.json beside this page".to_owned()),
        ("Time of computing", format!("{} s", number(r.wall_s))),
    ];
    let provenance = r.provenance.lines("rig", None, more);
    let note = format!("{NOTE} Before: the rig as declared; after: calibrated; {ALONG}.");
    let mut parts = vec![Part::Table(values)];
    if !equations.is_empty() {
        parts.push(Part::Text { id: "why", title: "Why these", paragraphs: &equations });
    }
    parts.push(Part::Table(errors_table(&r.errors, &note)));
    parts.push(Part::Pictures(pictures));
    parts.push(Part::Table(ranking));
    parts.push(Part::Provenance(&provenance));
    let title = format!("Calibration of {}: {}", r.provenance.scenario_name, verdict(r.verdict));
    document(&title, &r.summary, &parts)
}
