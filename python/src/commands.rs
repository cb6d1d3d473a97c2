//! The other commands. Their results are the texts of the JSON files that the program writes.

use crate::error::{Failure, refuse, warn};
use crate::scenario::Scenario;
use crate::work::{detached, end_if};
use freeplay::calibrate::predicted::ERRORS_FILE;
use freeplay::calibrate::result::REPORT_FILE;
use freeplay::calibrate::sensed;
use freeplay::calibrate::sensed::predict as along;
use freeplay::calibrate::sensed::windows::predict::{self as windows, AskedWindows};
use freeplay::cli::{compare_steps, effect_described, law_described, laws_to_compare};
use freeplay::measure::spelling::nearest;
use freeplay::results::Folder;
use freeplay::scenario::Law;
use freeplay::simulate::{assemble, findings};
use freeplay::study::compare::by_law::{LAWS_COMPARED_FILE, compare_laws};
use freeplay::study::compare::{COMPARE_FILE, Options};
use freeplay::study::{self, Check, Watch};
use freeplay::{contact, effects as catalogue};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Everything that can be said without simulating, as JSON.
#[pyfunction]
fn check(py: Python<'_>, scenario: &Scenario) -> PyResult<String> {
    detached(py, &AtomicBool::new(false), || {
        let check = match assemble(&scenario.scenario) {
            Ok(mut machine) => study::check(&scenario.scenario, &mut machine),
            Err(problem) => Check::unreadable(vec![problem]),
        };
        Ok(serde_json::to_string(&check).unwrap_or_default())
    })
}

/// Compares contact models, or laws where some are named; returns the JSON.
#[pyfunction]
fn compare(
    py: Python<'_>,
    scenario: &Scenario,
    out: PathBuf,
    force: bool,
    steps: &str,
    starts: usize,
    laws: Option<&str>,
) -> PyResult<String> {
    let stop = AtomicBool::new(false);
    let mut warnings = Vec::new();
    let json = detached(py, &stop, || {
        let mut scenario = scenario.scenario.clone();
        // A program that calls this knows what it asks for; Ctrl-C ends it.
        let mut tell = |_: f64| end_if(&stop);
        let watch = Watch::new(1.0, true, &mut tell);
        if !(2..=1000).contains(&starts) {
            return Err(Failure::Input(format!("starts: is {starts}; expected 2 to 1000")));
        }
        if let Some(laws) = laws {
            let kinds = laws_to_compare(laws).map_err(Failure::Input)?;
            refuse(findings(&scenario, &mut assemble(&scenario)?), &mut warnings)?;
            let folder = Folder::prepare(&out, LAWS_COMPARED_FILE, force)?;
            return Ok(compare_laws(&scenario, &kinds, starts, folder, &watch)?.json);
        }
        let steps = compare_steps(steps).map_err(Failure::Input)?;
        scenario.contact.law = Law::HertzStep;
        refuse(findings(&scenario, &mut assemble(&scenario)?), &mut warnings)?;
        let folder = Folder::prepare(&out, COMPARE_FILE, force)?;
        let options = Options { steps, starts };
        Ok(study::compare::compare(&scenario, &options, folder, &watch)?.json)
    })?;
    for warning in &warnings {
        warn(py, warning)?;
    }
    Ok(json)
}

/// Kinds of effects by name.
fn without(names: &[String]) -> Result<Vec<&'static str>, Failure> {
    let known: Vec<&str> = catalogue::ALL.iter().map(|kind| kind.name).collect();
    let kind = |name: &String| {
        catalogue::named(name).map(|kind| kind.name).ok_or_else(|| {
            let near = nearest(name, &known);
            let help = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            Failure::Input(format!("without: `{name}` is not an effect{help}"))
        })
    };
    names.iter().map(kind).collect()
}

/// What a declared model lacks; returns the text of `report.json`.
#[pyfunction]
fn calibrate(
    py: Python<'_>,
    rig: &Scenario,
    data: Vec<PathBuf>,
    validate: Vec<PathBuf>,
    left_out: Vec<String>,
    out: PathBuf,
    force: bool,
) -> PyResult<String> {
    let stop = AtomicBool::new(false);
    detached(py, &stop, || {
        let left_out = without(&left_out)?;
        let rig = rig.scenario.clone();
        let paths: Vec<&Path> = data.iter().chain(&validate).map(PathBuf::as_path).collect();
        let prepared = sensed::prepare(rig, &paths, data.len())?;
        let folder = Folder::prepare(&out, REPORT_FILE, force)?;
        Ok(sensed::into_folder(prepared, &left_out, folder, &|_: &str| end_if(&stop))?.json)
    })
}

/// How far a model is off along a recording; returns the text of `errors.json`.
#[pyfunction]
fn predict(
    py: Python<'_>,
    model: &Scenario,
    data: PathBuf,
    out: PathBuf,
    force: bool,
    asked: [Option<f64>; 3],
) -> PyResult<String> {
    let stop = AtomicBool::new(false);
    let [window, fit, from] = asked;
    detached(py, &stop, || {
        let model = &model.scenario;
        let tell = |_: &str| end_if(&stop);
        let prepare = || Folder::prepare(&out, ERRORS_FILE, force);
        let asked_of = AskedWindows { window, fit, from };
        if let Some(prepared) = windows::prepare(model, &data, asked_of)? {
            return Ok(windows::into_folder(model, &prepared, prepare()?, &tell)?.json);
        }
        refuse_windows(asked)?;
        let prepared = along::prepare(model, &data)?;
        Ok(along::into_folder(&prepared, prepare()?, &tell)?.json)
    })
}

fn refuse_windows(given: [Option<f64>; 3]) -> Result<(), Failure> {
    match ["window", "fit", "start"].into_iter().zip(given).find(|(_, given)| given.is_some()) {
        None => Ok(()),
        Some((name, _)) => Err(Failure::Input(format!(
            "{name}: this machine is predicted from its release on, not over windows; leave it out"
        ))),
    }
}

/// The effects of the catalogue, as JSON.
#[pyfunction]
fn effects() -> String {
    let all: Vec<_> = catalogue::ALL.iter().map(|kind| effect_described(kind)).collect();
    serde_json::to_string(&all).unwrap_or_default()
}

/// The contact laws, as JSON.
#[pyfunction]
fn laws() -> String {
    let all: Vec<_> = contact::laws::ALL.iter().map(|kind| law_described(kind)).collect();
    serde_json::to_string(&all).unwrap_or_default()
}

pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(check, module)?)?;
    module.add_function(wrap_pyfunction!(compare, module)?)?;
    module.add_function(wrap_pyfunction!(calibrate, module)?)?;
    module.add_function(wrap_pyfunction!(predict, module)?)?;
    module.add_function(wrap_pyfunction!(effects, module)?)?;
    module.add_function(wrap_pyfunction!(laws, module)?)
}
