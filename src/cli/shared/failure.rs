//! How a command fails: whose fault, and what is said.

use super::output;
use crate::measure::dialect;
use crate::results::{FolderError, RunError};
use crate::scenario::{Location, Problem, Problems, Scenario};
use crate::simulate::{Finding, Severity, doubts};
use crate::study::StudyError;
use std::path::Path;
use std::process::ExitCode;

/// Most problems that are told one by one: those after them mostly follow from these.
const TOLD: usize = 50;

/// Most faults of a result that are told: a study has hundreds of runs, and what ails one ails others.
const FAULTS: usize = 5;

/// The exit code of a command that was told to end and goes on where it was when started again: `EX_TEMPFAIL` of
/// sysexits.h, "the user is invited to retry".
pub(super) const GO_ON: u8 = 75;

/// A command that did not do what was asked.
#[derive(Debug)]
pub(in crate::cli) enum Failure {
    /// Wrong input; one message a problem.
    Input(Vec<String>),
    /// Anything else.
    Other(String),
    /// It was told to end by this signal; what became of its work was said.
    Interrupted(u8),
    /// It was told to end; what it made is kept, and the same command goes on from there.
    GoOn(String),
}

impl Failure {
    /// Says it on standard error, one line a problem.
    pub fn print(&self) {
        let messages = match self {
            Failure::Input(messages) => messages.as_slice(),
            Failure::Other(message) | Failure::GoOn(message) => std::slice::from_ref(message),
            Failure::Interrupted(_) => &[],
        };
        for message in messages.iter().take(TOLD) {
            output::complain(&format!("error: {message}"));
        }
        if messages.len() > TOLD {
            output::complain(&format!("error: … and {} more", messages.len() - TOLD));
        }
    }

    /// The exit code for it.
    pub fn code(&self) -> ExitCode {
        match self {
            Failure::Input(_) => ExitCode::from(2),
            Failure::Other(_) => ExitCode::FAILURE,
            // As shells report a process that a signal ended.
            Failure::Interrupted(signal) => ExitCode::from(128 + signal),
            Failure::GoOn(_) => ExitCode::from(GO_ON),
        }
    }
}

impl From<Problems> for Failure {
    fn from(problems: Problems) -> Self {
        Failure::Input(problems.0.iter().map(Problem::to_string).collect())
    }
}

impl From<Problem> for Failure {
    fn from(problem: Problem) -> Self {
        Problems::from(problem).into()
    }
}

impl From<FolderError> for Failure {
    fn from(error: FolderError) -> Self {
        match error {
            FolderError::Name { .. } => Failure::Other(error.to_string()),
            error => Failure::Input(vec![error.to_string()]),
        }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Folder(error) => error.into(),
            RunError::TooMuch(_) | RunError::TooLong(_) => Failure::Input(vec![error.to_string()]),
            error => Failure::Other(error.to_string()),
        }
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Input(message) | StudyError::Another(message) => {
                Failure::Input(vec![message])
            }
            StudyError::Scenario(problems) => problems.into(),
            StudyError::Files(error) => error.into(),
            StudyError::Interrupted { .. } => Failure::GoOn(error.to_string()),
            error => Failure::Other(error.to_string()),
        }
    }
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        Failure::Other(format!("cannot write the result: {error}"))
    }
}

/// Says how recordings are written, where that is unusual.
pub(in crate::cli) fn say_how_written<'a>(paths: impl IntoIterator<Item = &'a Path>) {
    for path in paths {
        if let Some(remark) = dialect::remark(path) {
            output::complain(&format!("note: {}: {remark}", path.display()));
        }
    }
}

/// Says what is to be known of recordings.
pub(in crate::cli) fn say_remarks(remarks: Vec<String>) {
    for remark in remarks {
        output::complain(&format!("note: {remark}"));
    }
}

/// Says what a scenario holds that means nothing to its machine, or is hardly meant.
pub(in crate::cli) fn warn_of_doubts(scenario: &Scenario) {
    for finding in doubts(scenario) {
        output::complain(&finding.to_string());
    }
}

/// Says that a seed that somebody set changes nothing, for commands that draw no random numbers.
pub(in crate::cli) fn warn_of_seed(scenario: &Scenario) {
    let message = "is not used: this command draws no random numbers";
    let help = "leave it out; noise of `freeplay record` and random values of `freeplay sweep` follow from it";
    let problem = scenario.problem("seed", message, help);
    if matches!(problem.location, Location::Set { .. }) {
        output::complain(&Finding::warning(problem).to_string());
    }
}

/// Prints warnings, and fails if there are errors.
pub(in crate::cli) fn refuse_errors(findings: Vec<Finding>) -> Result<(), Failure> {
    let (errors, warnings): (Vec<_>, Vec<_>) =
        findings.into_iter().partition(|finding| finding.severity == Severity::Error);
    for warning in &warnings {
        output::complain(&warning.to_string());
    }
    if errors.is_empty() {
        return Ok(());
    }
    Err(Failure::Input(errors.iter().map(|error| error.problem.to_string()).collect()))
}

/// Fails if runs of a result, which is written, saw faults of their own.
pub(in crate::cli) fn refuse_faults(faults: &[String]) -> Result<(), Failure> {
    if faults.is_empty() {
        return Ok(());
    }
    let mut message = faults.iter().take(FAULTS).map(String::as_str).collect::<Vec<_>>().join("; ");
    if faults.len() > FAULTS {
        message += &format!("; … and {} more, in the result", faults.len() - FAULTS);
    }
    Err(Failure::Other(message))
}
