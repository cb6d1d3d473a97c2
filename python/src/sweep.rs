//! Many runs: planned, made here or elsewhere, kept in the journal of a folder.

use crate::error::{Failure, warn};
use crate::scenario::Scenario;
use crate::table::Table;
use crate::value::{in_line as in_one_line, to_toml};
use crate::work::detached;
use freeplay::cli::threads_of_queue;
use freeplay::study::StudyError;
use freeplay::study::sweep::{self, Ongoing, Shard, on_threads};
use pyo3::exceptions::{PyIndexError, PyRuntimeError};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::str::FromStr;
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, PoisonError};
use toml::Value;

/// A sweep before it is run.
#[pyclass(frozen, module = "pyfreeplay._native")]
pub struct Plan {
    plan: sweep::Plan,
}

#[pymethods]
impl Plan {
    /// Plans a sweep; every run is checked where `checked`, otherwise none.
    #[new]
    fn new(
        py: Python<'_>,
        scenario: &Scenario,
        vary: Vec<String>,
        shard: &str,
        checked: bool,
    ) -> PyResult<Self> {
        let plan = detached(py, &AtomicBool::new(false), || {
            let shard =
                Shard::from_str(shard).map_err(|e| Failure::Input(format!("shard: {e}")))?;
            let (source, sets) = (scenario.source.clone(), &scenario.sets);
            let plan = match checked {
                true => sweep::Plan::new(source, sets, &vary, shard),
                false => sweep::Plan::unchecked(source, sets, &vary, shard),
            };
            Ok(plan?)
        })?;
        for warning in plan.warnings() {
            warn(py, warning)?;
        }
        Ok(Self { plan })
    }

    #[getter]
    fn runs(&self) -> usize {
        self.plan.identity().runs
    }

    #[getter]
    fn name(&self) -> &str {
        &self.plan.base().name
    }

    /// What a worker has to find run `run` to be.
    fn mark(&self, run: usize) -> PyResult<u64> {
        self.plan
            .mark(run)
            .ok_or_else(|| PyIndexError::new_err(format!("no run {run} was checked")))
    }

    /// The row of run `run`, whose mark is `mark` where it was planned.
    fn row(&self, py: Python<'_>, run: usize, mark: u64) -> PyResult<Vec<String>> {
        let stop = AtomicBool::new(false);
        detached(py, &stop, || {
            let row = self.plan.row_of_mark(run, mark, &stop)?;
            row.ok_or_else(|| Failure::Run("the run was interrupted".to_owned()))
        })
    }

    /// Makes the runs that the folder `out` lacks, on so many threads of this process; returns its `sweep.json`.
    fn sweep(
        &self,
        py: Python<'_>,
        out: PathBuf,
        force: bool,
        threads: Option<usize>,
    ) -> PyResult<String> {
        let stop = AtomicBool::new(false);
        detached(py, &stop, || {
            let made = on_threads(threads.or_else(threads_of_queue), || {
                sweep::sweep(&self.plan, &out, force, &stop, &|_, _| {})
            });
            Ok(made??.json)
        })
    }
}

/// The folder of a sweep whose runs are made elsewhere.
#[pyclass(frozen, module = "pyfreeplay._native")]
pub struct Rows {
    ongoing: Mutex<Option<Ongoing>>,
}

impl Rows {
    fn with<T>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Ongoing) -> Result<T, StudyError>,
    ) -> PyResult<T> {
        let mut ongoing = self.ongoing.lock().unwrap_or_else(PoisonError::into_inner);
        let ongoing = ongoing.as_mut().ok_or_else(|| PyRuntimeError::new_err("closed"))?;
        work(ongoing).map_err(|error| Failure::from(error).exception(py))
    }
}

#[pymethods]
impl Rows {
    #[new]
    fn new(py: Python<'_>, plan: &Plan, out: PathBuf, force: bool) -> PyResult<Self> {
        let ongoing = Ongoing::begin(&plan.plan, &out, force);
        let ongoing = ongoing.map_err(|error| Failure::from(error).exception(py))?;
        Ok(Self { ongoing: Mutex::new(Some(ongoing)) })
    }

    fn missing(&self, py: Python<'_>) -> PyResult<Vec<usize>> {
        self.with(py, |ongoing| Ok(ongoing.missing()))
    }

    /// Keeps a row; one that is there already changes nothing.
    fn add(&self, py: Python<'_>, run: usize, row: Vec<String>) -> PyResult<()> {
        self.with(py, |ongoing| ongoing.add(run, row))
    }

    /// Rows that are there, and that there will be.
    fn progress(&self, py: Python<'_>) -> PyResult<(usize, usize)> {
        self.with(py, |ongoing| Ok((ongoing.finished(), ongoing.runs())))
    }

    /// The text that says how far it came.
    fn interrupted(&self, py: Python<'_>) -> PyResult<String> {
        self.with(py, |ongoing| Ok(ongoing.interrupted().to_string()))
    }

    /// Writes everything that follows from the rows, and returns `sweep.json`.
    fn finish(&self, py: Python<'_>) -> PyResult<String> {
        let ongoing = self.close_it().ok_or_else(|| PyRuntimeError::new_err("closed"))?;
        detached(py, &AtomicBool::new(false), || Ok(ongoing.finish()?.json))
    }

    /// Lets others work on the folder.
    fn close(&self) {
        drop(self.close_it());
    }
}

impl Rows {
    fn close_it(&self) -> Option<Ongoing> {
        self.ongoing.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// Joins the parts of a sweep; returns `sweep.json`.
#[pyfunction]
fn merge(
    py: Python<'_>,
    parts: Vec<PathBuf>,
    out: PathBuf,
    force: bool,
    partial: bool,
) -> PyResult<String> {
    detached(py, &AtomicBool::new(false), || Ok(sweep::merge(&parts, &out, force, partial)?.json))
}

/// The values of a varied key as `--vary` takes a list of them; `path` is the key.
#[pyfunction]
fn in_line(py: Python<'_>, path: &str, values: &Bound<'_, PyAny>) -> PyResult<String> {
    let text = to_toml(path, values).and_then(|values| match values {
        Value::Array(values) => Ok(values.iter().map(element).collect::<Vec<_>>().join(",")),
        value => Err(Failure::Input(format!(
            "{path}: varies over {value}, one value; expected a list of values, or a range such as \"1e-5..1e-3:log:20\""
        ))),
    });
    text.map_err(|failure| failure.exception(py))
}

/// A value as an element of a list: a word as the command line has it, without quotes.
fn element(value: &Value) -> String {
    match value {
        Value::String(text) if is_word(text) => text.clone(),
        value => in_one_line(value),
    }
}

/// Whether a text stands for itself where it stands without quotes.
fn is_word(text: &str) -> bool {
    let plain = text.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c));
    let names_a_number = text.parse::<f64>().is_ok() || ["true", "false"].contains(&text);
    plain && text.starts_with(|c: char| c.is_ascii_alphabetic()) && !names_a_number
}

/// A table that freeplay wrote.
#[pyfunction]
fn read_csv(py: Python<'_>, path: PathBuf) -> PyResult<Table> {
    Table::of_csv(py, &path).map_err(|failure| failure.exception(py))
}

pub fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(merge, module)?)?;
    module.add_function(wrap_pyfunction!(in_line, module)?)?;
    module.add_function(wrap_pyfunction!(read_csv, module)?)
}
