//! A model of a machine that nothing holds beside a recording: predictions over windows.

use super::fitting::bench::{Bench, suits};
use super::horizons::{HorizonErrors, RunZero};
use super::outcome::{horizons, with};
use super::plausible;
use super::report::{channel_errors, input_columns, pictures, predicted, run_zeros};
use super::score::{Horizon, score};
use crate::calibrate::results::predicted::{ERRORS_FILE, PREDICTED_FILE, Predicted};
use crate::calibrate::results::report::EffectReport;
use crate::calibrate::results::result::{CalibrateError, publish, refuse, to_json};
use crate::calibrate::sensed::events::picture::pictures as events_drawn;
use crate::calibrate::sensed::events::{Event, found};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::values::errors::ChannelError;
use crate::report::{PagePart, PageTable, Style, document, number};
use crate::results::{Folder, PAGE_FILE, RunError};
use crate::scenario::Scenario;
use crate::simulate::Provenance;
use serde::Serialize;
use std::path::Path;
use std::time::Instant as Clock;

/// What a user asks for in place of the usual windows, in s.
#[derive(Clone, Copy, Debug, Default)]
pub struct AskedWindows {
    /// Length of windows.
    pub window: Option<f64>,
    /// The first part, which starts are fitted to.
    pub fit: Option<f64>,
    /// Where the first begins.
    pub from: Option<f64>,
}

/// `errors.json`.
#[derive(Clone, Debug, Serialize)]
pub struct WindowsPrediction {
    /// Which program made this of which model.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// The recording.
    pub run: String,
    /// Names of the model's effects.
    pub effects: Vec<String>,
    /// Errors over the first windows: `after` of the model, `before` of the model without its effects (null where
    /// it has none).
    pub errors: Vec<ChannelError>,
    /// Errors by horizons.
    pub windows: Vec<HorizonErrors>,
    /// What acted on the machine for a while and the model does not know of.
    pub events: Vec<EffectReport>,
    /// Zeros that belong to this run, found in its first seconds.
    pub run_zeros: Vec<RunZero>,
    /// What drives gave, by column.
    pub inputs: Vec<String>,
    /// What is to be known of the recording.
    pub remarks: Vec<String>,
    /// Time of computing in s.
    pub wall_s: f64,
    /// What stands beside this file.
    pub files: Vec<String>,
}

/// A model and a recording that nothing speaks against.
#[derive(Debug)]
pub struct PreparedWindows {
    bench: Bench,
    horizons: Vec<Horizon>,
}

impl PreparedWindows {
    /// What is to be known of the recording.
    pub fn remarks(&self) -> Vec<String> {
        self.bench.runs.iter().flat_map(Recording::remarks).collect()
    }
}

/// Reads a recording of a described machine; none where the model is no machine for windows.
///
/// # Errors
/// What is wrong with the model, the recording, or what is asked for.
pub fn prepare(
    model: &Scenario,
    path: &Path,
    asked: AskedWindows,
) -> Result<Option<PreparedWindows>, CalibrateError> {
    let parts = crate::model::parts_of(model)?;
    if !suits(&parts) {
        return Ok(None);
    }
    let recording = Recording::read_with_time(path, &parts.sensors, true, model.time_column());
    let recording = recording.map_err(|error| CalibrateError::Input(vec![error.to_string()]))?;
    let duration = recording.duration();
    let bench = Bench::new(model, vec![recording])?;
    refuse(plausible::wrong(model, &bench))?;
    let mut horizons = horizons(&bench);
    if let Some(from_s) = asked.from {
        horizons.iter_mut().for_each(|horizon| horizon.from_s = from_s);
    }
    if asked.window.is_some() || asked.fit.is_some() {
        let usual = horizons[0];
        let window_s = asked.window.unwrap_or(usual.window_s);
        let fit_s = asked.fit.unwrap_or(usual.fit_s.min(window_s / 3.0));
        horizons = vec![Horizon { window_s, fit_s, ..usual }];
    }
    let mut wrong = Vec::new();
    for Horizon { window_s, fit_s, from_s } in &horizons {
        if !(*fit_s > 0.0 && fit_s < window_s && *from_s >= 0.0) {
            wrong.push(format!(
                "--window {window_s} --fit {fit_s} --from {from_s}: expected 0 < fit < window, and from at least 0"
            ));
        }
    }
    horizons.retain(|horizon| horizon.from_s + horizon.window_s < duration);
    if horizons.is_empty() && wrong.is_empty() {
        wrong.push(format!("{}: no window fits into its {duration:.3} s", path.display()));
    }
    refuse(wrong)?;
    Ok(Some(PreparedWindows { bench, horizons }))
}

/// Predicts and writes everything about it into `folder`.
///
/// # Errors
/// A model that cannot be rolled along the recording, files that cannot be written.
pub fn into_folder(
    model: &Scenario,
    prepared: &PreparedWindows,
    folder: Folder,
    tell: &dyn Fn(&str),
) -> Result<Predicted<WindowsPrediction>, CalibrateError> {
    let started = Clock::now();
    let PreparedWindows { bench, horizons } = prepared;
    let problem =
        || model.problem("mechanism", "cannot be rolled along this run", "check its masses");
    tell("finding what belongs to the run");
    let zeros = bench.own_zeros(&bench.declared, &bench.zeros_of_runs()).ok_or_else(problem)?;
    let own: Vec<f64> = zeros[0].iter().map(|[zero, _]| *zero).collect();
    let none = vec![0.0; bench.sensors.len()];
    let machine = bench.machines(&bench.declared).ok_or_else(problem)?;
    let plain = if bench.declared.is_empty() {
        None
    } else {
        let plain = Bench::new(&with(model, &[]), bench.runs.clone())?;
        let machine = plain.machines(&[]).ok_or_else(problem)?;
        Some((plain, machine))
    };
    tell("predicting");
    let mut windows = Vec::new();
    let mut first = None;
    for &horizon in horizons {
        let after = score(bench, &machine[0], &own, 0, horizon);
        let before =
            plain.as_ref().map(|(plain, machine)| score(plain, &machine[0], &none, 0, horizon));
        let errors = channel_errors(bench, 0, "prediction", before.as_ref(), &after);
        let run = bench.runs[0].name.clone();
        let count = after.windows;
        windows.push(HorizonErrors { run, role: "prediction", horizon, windows: count, errors });
        first.get_or_insert((before, after));
    }
    let Some((before, after)) = first else { return Err(problem().into()) };
    let mut models = Vec::new();
    models.extend(before.as_ref().map(|before| ("without effects", Style::Reference, before)));
    models.push(("predicted", Style::Solid, &after));
    tell("looking for what does not last");
    let events = bench.events();
    let mut drawn = pictures(bench, 0, "prediction", &models)?;
    drawn.extend(events_drawn(&events).map_err(RunError::from)?);
    let texts = [ERRORS_FILE, PREDICTED_FILE, PAGE_FILE].map(str::to_owned).into_iter();
    let prediction = WindowsPrediction {
        provenance: Provenance::of(model),
        run: bench.runs[0].name.clone(),
        effects: model.effects.iter().map(ToString::to_string).collect(),
        errors: windows[0].errors.clone(),
        windows,
        events: events.iter().map(Event::report).collect(),
        run_zeros: run_zeros(bench, &zeros),
        inputs: input_columns(bench),
        remarks: prepared.remarks(),
        wall_s: started.elapsed().as_secs_f64(),
        files: texts.chain(drawn.iter().map(|picture| picture.file.clone())).collect(),
    };
    let json = to_json(&prediction);
    let rows = predicted(bench, 0, &after).to_csv(&bench.mechanism.sensors);
    let page = page(&prediction, &found::sentence(&events), &drawn);
    let texts = [(ERRORS_FILE, &json), (PREDICTED_FILE, &rows), (PAGE_FILE, &page)];
    let folder = publish(folder, &texts, &drawn)?;
    Ok(Predicted { prediction, json, folder })
}

/// The page.
fn page(p: &WindowsPrediction, events: &str, pictures: &[crate::report::Picture]) -> String {
    let effects = if p.effects.is_empty() {
        "without effects".to_owned()
    } else {
        format!("with {}", p.effects.join(", "))
    };
    let lead = format!("{} {effects}, against {}.{events}", p.provenance.scenario_name, p.run);
    let head =
        ["window", "fitted to", "from", "column", "unit", "without effects", "predicted", "floor"];
    let rows = p.windows.iter().flat_map(|of| {
        of.errors.iter().map(|e| {
            let Horizon { window_s, fit_s, from_s } = of.horizon;
            let times = [window_s, fit_s, from_s].map(|t| format!("{t} s"));
            let errors = [e.before, e.after, e.floor].map(number);
            let of = [e.channel.clone(), e.unit.to_owned()];
            times.into_iter().chain(of).chain(errors).collect()
        })
    });
    let errors = PageTable {
        id: "errors",
        title: "Errors over windows".into(),
        header: head.iter().map(|name| (*name).to_owned()).collect(),
        rows: rows.collect(),
        note: super::report::NOTE.into(),
    };
    let more = [
        ("Run", p.run.clone()),
        ("Figures", "errors.json, predicted.csv beside this page".to_owned()),
        ("Time of computing", format!("{} s", number(p.wall_s))),
    ];
    let provenance = p.provenance.lines("model", None, more);
    let mut parts = vec![PagePart::Table(errors), PagePart::Pictures(pictures)];
    if !p.remarks.is_empty() {
        parts.insert(
            1,
            PagePart::Text { id: "remarks", title: "The recording", paragraphs: &p.remarks },
        );
    }
    parts.push(PagePart::Provenance(&provenance));
    document(&format!("Prediction of {}", p.run), &lead, &parts)
}
