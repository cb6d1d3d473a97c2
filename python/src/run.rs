//! One run: all of it, or its figures alone.

use crate::error::{Failure, refuse, warn};
use crate::law::{Trouble, give};
use crate::scenario::Scenario;
use crate::table::Table;
use crate::work::detached;
use freeplay::results::Folder;
use freeplay::simulate::{Machine, RowColumns, assemble, findings};
use freeplay::study::{self, Recorded, SUMMARY_FILE, Terms, evaluate as single};
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

/// What a run came to.
#[pyclass(frozen, module = "pyfreeplay._native")]
pub struct Record {
    recorded: Recorded,
    json: String,
    table: Py<Table>,
    folder: Option<PathBuf>,
}

#[pymethods]
impl Record {
    /// The text of `summary.json`.
    #[getter]
    fn json(&self) -> &str {
        &self.json
    }

    #[getter]
    fn table(&self, py: Python<'_>) -> Py<Table> {
        self.table.clone_ref(py)
    }

    #[getter]
    fn folder(&self) -> Option<PathBuf> {
        self.folder.clone()
    }

    /// Pictures as (file, title, caption, SVG).
    fn pictures(&self) -> PyResult<Vec<(String, String, String, String)>> {
        let pictures = self.recorded.pictures();
        let pictures =
            pictures.map_err(|e| pyo3::exceptions::PyRuntimeError::new_err(e.to_string()))?;
        Ok(pictures.into_iter().map(|p| (p.file, p.title, p.caption, p.svg)).collect())
    }

    fn animation(&self) -> String {
        self.recorded.animation()
    }

    fn player(&self) -> String {
        self.recorded.player()
    }
}

/// A machine that a run may start with, functions of Python for its laws.
fn machine(
    scenario: &Scenario,
    law: Option<&Py<PyAny>>,
    trouble: &Arc<Trouble>,
    warnings: &mut Vec<String>,
) -> Result<Machine, Failure> {
    let scenario = &scenario.scenario;
    let mut machine = assemble(scenario)?;
    if let Some(law) = law {
        Python::attach(|py| give(law.bind(py), &mut machine.mechanism, trouble))?;
    }
    refuse(findings(scenario, &mut machine), warnings)?;
    Ok(machine)
}

/// The numbers of a run, column by column.
#[derive(Default)]
struct Gathered {
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
    row: Vec<f64>,
}

impl Gathered {
    fn new(machine: &Machine) -> (RowColumns, Self) {
        let columns = RowColumns::new(&machine.layout);
        let names = columns.names(&machine.mechanism);
        let rows = machine.schedule.intervals() + 1;
        let columns_of = names.iter().map(|_| Vec::with_capacity(rows)).collect();
        (columns, Self { names, columns: columns_of, row: Vec::new() })
    }

    fn take(&mut self) {
        for (column, value) in self.columns.iter_mut().zip(self.row.drain(..)) {
            column.push(value);
        }
    }
}

/// Simulates a scenario; into a folder, or into memory alone.
#[pyfunction]
#[pyo3(signature = (scenario, out, force, law))]
fn run(
    py: Python<'_>,
    scenario: &Scenario,
    out: Option<PathBuf>,
    force: bool,
    law: Option<Py<PyAny>>,
) -> PyResult<Record> {
    let trouble = Arc::new(Trouble::default());
    let mut warnings = Vec::new();
    let made = detached(py, &trouble.stop, || {
        let mut machine = machine(scenario, law.as_ref(), &trouble, &mut warnings)?;
        let (columns, mut gathered) = Gathered::new(&machine);
        let stop = &trouble.stop;
        let scenario = &scenario.scenario;
        let Some(out) = out else {
            let recorded =
                study::recorded(scenario, &mut machine, stop, &mut |mechanism, instant| {
                    columns.values(mechanism, instant, &mut gathered.row);
                    gathered.take();
                    ControlFlow::Continue(())
                });
            let json = serde_json::to_string(&recorded.summary).unwrap_or_default();
            return Ok((recorded, json, None, gathered));
        };
        let folder = Folder::prepare(&out, SUMMARY_FILE, force)?;
        let terms = Terms { stop, at_any_cost: true };
        let outcome =
            study::run(scenario, &mut machine, folder, terms, &mut |mechanism, instant| {
                columns.values(mechanism, instant, &mut gathered.row);
                gathered.take();
            })?;
        Ok((outcome.recorded, outcome.json, Some(outcome.folder), gathered))
    });
    if let Some(error) = trouble.take() {
        return Err(error);
    }
    let (recorded, json, folder, gathered) = made?;
    for warning in warnings.iter().chain(&recorded.summary.watched.doubts) {
        warn(py, warning)?;
    }
    let table = Py::new(py, Table::of_numbers(py, gathered.names, gathered.columns)?)?;
    Ok(Record { recorded, json, table, folder })
}

/// The figures of one run, as texts in the order of their names.
#[pyfunction]
#[pyo3(signature = (scenario, figures, law))]
fn evaluate(
    py: Python<'_>,
    scenario: &Scenario,
    figures: Vec<String>,
    law: Option<Py<PyAny>>,
) -> PyResult<Vec<String>> {
    let trouble = Arc::new(Trouble::default());
    let mut warnings = Vec::new();
    let made = detached(py, &trouble.stop, || {
        let mut machine = machine(scenario, law.as_ref(), &trouble, &mut warnings)?;
        Ok(single::figures(&scenario.scenario, &mut machine, &figures, &trouble.stop)?)
    });
    if let Some(error) = trouble.take() {
        return Err(error);
    }
    for warning in &warnings {
        warn(py, warning)?;
    }
    made
}

/// The names of the figures that runs of a scenario have.
#[pyfunction]
fn figures(scenario: &Scenario) -> Vec<String> {
    single::names(&scenario.scenario)
}

pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(run, module)?)?;
    module.add_function(wrap_pyfunction!(evaluate, module)?)?;
    module.add_function(wrap_pyfunction!(figures, module)?)
}
