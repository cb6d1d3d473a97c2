//! The page of a prediction.

use super::page::errors_table;
use super::predicted::PredictionReport;
use crate::calibrate::sensed::thresholds::MET;
use crate::calibrate::values::errors::worst;
use crate::report::{PagePart, Picture, document, number};

/// The page as HTML.
pub fn page(prediction: &PredictionReport, pictures: &[Picture]) -> String {
    let effects = if prediction.effects.is_empty() {
        "as declared, without effects".to_owned()
    } else {
        format!("with {}", prediction.effects.join(", "))
    };
    let note = "Root mean square of measured less predicted, both through a zero-phase low-pass of fourth \
                order at 25 Hz, first and last 60 ms left out. After: the model; before, if it has effects: the \
                model without them; floor: what sensor noise and rattle leave to any model.";
    let provenance = provenance(prediction);
    let mut parts = Vec::new();
    if !prediction.errors.is_empty() {
        parts.push(PagePart::Table(errors_table(&prediction.errors, note)));
    }
    parts.push(PagePart::Pictures(pictures));
    parts.push(PagePart::Provenance(&provenance));
    let lead = format!(
        "{}The model is {}, {effects}, driven by the commands of {}. {}",
        verdict(prediction),
        prediction.provenance.scenario_name,
        prediction.run,
        if prediction.rattle.chaotic {
            format!(
                "It rattles by more than its sensors see: the prediction is a mean over {} runs.",
                prediction.rattle.replicas
            )
        } else {
            "It does not rattle by more than its sensors see.".to_owned()
        }
    );
    document(&format!("Prediction of {}", prediction.run), &lead, &parts)
}

/// How well it predicts, by the worst channel.
fn verdict(p: &PredictionReport) -> String {
    let Some(error) = worst(&p.errors).filter(|error| (error.after / error.floor).is_finite())
    else {
        return String::new();
    };
    let times = number(error.after / error.floor);
    match error.after < MET * error.floor {
        true => format!(
            "The recording is predicted to within noise (worst: {}, {times} floors). ",
            error.channel
        ),
        false => format!(
            "The recording is not explained: {} is off by {times} times what noise and rattle leave. ",
            error.channel
        ),
    }
}

fn provenance(p: &PredictionReport) -> Vec<(String, String)> {
    let more = [
        ("Run", p.run.clone()),
        ("Figures", "errors.json, predicted.csv beside this page".to_owned()),
        ("Time of computing", format!("{} s", number(p.wall_s))),
    ];
    p.provenance.lines("model", None, more)
}
