//! Errors as exceptions of `pyfreeplay`, each with what, where, and what would be right.

use freeplay::calibrate::result::CalibrateError;
use freeplay::results::{FolderError, RunError};
use freeplay::scenario::{Location, Problem, Problems};
use freeplay::simulate::{Finding, Severity};
use freeplay::study::StudyError;
use pyo3::exceptions::PyUserWarning;
use pyo3::ffi::c_str;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ffi::{CStr, CString};

/// What stands for the name of a file where the text came from a dict: its lines are nobody's.
pub const DICT: &str = "dict";

/// Why something was not done, in a form that threads may pass on.
#[derive(Debug)]
pub enum Failure {
    /// A scenario is wrong.
    Scenario(Vec<Problem>),
    /// Something else that was given is wrong.
    Input(String),
    /// A run or a file failed.
    Run(String),
    /// It ended before its last row; the same call goes on from there.
    Unfinished {
        /// All of it.
        message: String,
        /// Rows that are there.
        finished: usize,
        /// Rows that there will be.
        runs: usize,
    },
    /// An exception of Python.
    Python(PyErr),
}

/// An exception of `pyfreeplay._errors` by its name.
fn exception(py: Python<'_>, class: &str, arguments: &Bound<'_, PyDict>) -> PyErr {
    let made = py
        .import("pyfreeplay._errors")
        .and_then(|module| module.getattr(class)?.call((), Some(arguments)));
    match made {
        Ok(value) => PyErr::from_value(value),
        Err(error) => error,
    }
}

impl Failure {
    /// The exception that users see.
    pub fn exception(self, py: Python<'_>) -> PyErr {
        match self.arguments(py) {
            Ok((class, arguments)) => exception(py, class, &arguments),
            Err(error) => error,
        }
    }

    /// The class of it and what that is made of, unless it is an exception already.
    fn arguments(self, py: Python<'_>) -> PyResult<(&'static str, Bound<'_, PyDict>)> {
        let arguments = PyDict::new(py);
        let class = match self {
            Failure::Python(error) => return Err(error),
            Failure::Scenario(problems) => {
                let problems: PyResult<Vec<_>> =
                    problems.iter().map(|problem| described(py, problem)).collect();
                arguments.set_item("problems", problems?)?;
                "ScenarioError"
            }
            Failure::Input(message) => {
                arguments.set_item("message", message)?;
                "InputError"
            }
            Failure::Run(message) => {
                arguments.set_item("message", message)?;
                "RunError"
            }
            Failure::Unfinished { message, finished, runs } => {
                arguments.set_item("message", message)?;
                arguments.set_item("finished", finished)?;
                arguments.set_item("runs", runs)?;
                "Unfinished"
            }
        };
        Ok((class, arguments))
    }
}

/// A problem as a dict.
fn described<'py>(py: Python<'py>, problem: &Problem) -> PyResult<Bound<'py, PyDict>> {
    let mut problem = problem.clone();
    if let Location::File { name, line, column } = &mut problem.location
        && name == DICT
    {
        (*line, *column) = (None, None);
    }
    let dict = PyDict::new(py);
    dict.set_item("text", problem.to_string())?;
    dict.set_item("key", &problem.path)?;
    dict.set_item("message", &problem.message)?;
    dict.set_item("help", &problem.help)?;
    let (file, line, column) = match &problem.location {
        Location::File { name, line, column } => (Some(name), *line, *column),
        Location::Set { .. } => (None, None, None),
    };
    dict.set_item("file", file)?;
    dict.set_item("line", line)?;
    dict.set_item("column", column)?;
    Ok(dict)
}

impl From<Problems> for Failure {
    fn from(problems: Problems) -> Self {
        Failure::Scenario(problems.0)
    }
}

impl From<Problem> for Failure {
    fn from(problem: Problem) -> Self {
        Failure::Scenario(vec![problem])
    }
}

impl From<PyErr> for Failure {
    fn from(error: PyErr) -> Self {
        Failure::Python(error)
    }
}

impl From<FolderError> for Failure {
    fn from(error: FolderError) -> Self {
        match error {
            FolderError::Name { .. } => Failure::Run(error.to_string()),
            error => Failure::Input(error.to_string()),
        }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Folder(error) => error.into(),
            RunError::TooMuch(_) | RunError::TooLong(_) => Failure::Input(error.to_string()),
            error => Failure::Run(error.to_string()),
        }
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        let message = error.to_string();
        match error {
            StudyError::Input(message) | StudyError::Another(message) => Failure::Input(message),
            StudyError::Scenario(problems) => problems.into(),
            StudyError::Files(error) => error.into(),
            StudyError::Interrupted { finished, runs, .. } => {
                Failure::Unfinished { message, finished, runs }
            }
            _ => Failure::Run(message),
        }
    }
}

impl From<CalibrateError> for Failure {
    fn from(error: CalibrateError) -> Self {
        match error {
            CalibrateError::Input(messages) => Failure::Input(messages.join("\n")),
            CalibrateError::Halted(halt) => Failure::Run(halt.to_string()),
            CalibrateError::Files(error) => error.into(),
        }
    }
}

/// Warns of what is doubtful.
pub fn warn(py: Python<'_>, message: &str) -> PyResult<()> {
    let text = CString::new(message.replace('\0', "")).unwrap_or_default();
    let text: &CStr = if text.is_empty() { c_str!("warning") } else { &text };
    PyErr::warn(py, &py.get_type::<PyUserWarning>(), text, 2)
}

/// The errors among findings; warnings go into `warnings`.
pub fn refuse(findings: Vec<Finding>, warnings: &mut Vec<String>) -> Result<(), Failure> {
    let (errors, doubts): (Vec<_>, Vec<_>) =
        findings.into_iter().partition(|finding| finding.severity == Severity::Error);
    warnings.extend(doubts.iter().map(|doubt| doubt.problem.to_string()));
    if errors.is_empty() {
        return Ok(());
    }
    Err(Failure::Scenario(errors.into_iter().map(|error| error.problem).collect()))
}
