//! One run for its figures: what a program that chooses parameters asks for.

mod parameters;

pub use parameters::Parameters;

use super::sweep::row;
use crate::measure::spelling::nearest;
use crate::scenario::Scenario;
use crate::simulate::{Machine, measured_until};
use crate::study::StudyError;
use std::sync::atomic::AtomicBool;

/// The figures that a run of this scenario has, by the names of `summary.json` and of a sweep's columns.
pub fn names(scenario: &Scenario) -> Vec<String> {
    let mut columns = row::columns(&[], &row::more(scenario));
    // The last column is no figure, but how the run ended.
    columns.pop();
    columns
}

/// Where the figures that are asked for stand among those that there are.
fn places(scenario: &Scenario, asked: &[String]) -> Result<Vec<usize>, StudyError> {
    let names = names(scenario);
    let known: Vec<&str> = names.iter().map(String::as_str).collect();
    let place = |name: &String| {
        known.iter().position(|known| known == name).ok_or_else(|| {
            let help = nearest(name, &known).map_or_else(
                || format!("known here: {}", known.join(", ")),
                |near| format!("did you mean `{near}`?"),
            );
            StudyError::Input(format!("`{name}` is no figure of a run; {help}"))
        })
    };
    asked.iter().map(place).collect()
}

/// Simulates a machine for the figures `asked`, each as the shortest text that reads back as the same number.
///
/// ```
/// use freeplay::prelude::*;
/// use freeplay::study::evaluate::{figures, names};
/// use std::sync::atomic::AtomicBool;
///
/// let sets = ["simulation.duration=0.01", "simulation.settle=0"].map(str::to_owned);
/// let scenario = Scenario::load(None, &sets)?;
/// assert!(names(&scenario).contains(&"impacts".to_owned()));
/// let asked = ["simulated_s".to_owned()];
/// let known = figures(&scenario, &mut assemble(&scenario)?, &["impcats".to_owned()], &AtomicBool::new(false));
/// assert!(known.unwrap_err().to_string().contains("impacts"), "what was meant");
/// let values = figures(&scenario, &mut assemble(&scenario)?, &asked, &AtomicBool::new(false))?;
/// assert_eq!(values, ["0.01"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`StudyError`] for an unknown name, before anything is simulated; for a run that broke down, does not balance or
/// has no such figure (it ended before `simulation.settle`, or takes no step of its own); once `stop` is true.
pub fn figures(
    scenario: &Scenario,
    machine: &mut Machine,
    asked: &[String],
    stop: &AtomicBool,
) -> Result<Vec<String>, StudyError> {
    let places = places(scenario, asked)?;
    let summary = measured_until(scenario, machine, stop, &mut |_, _, _| {});
    if summary.interrupted {
        return Err(StudyError::Stopped);
    }
    let row = row::of_summary(Vec::new(), &summary, &row::more(scenario));
    if row::said(row.last().map(String::as_str)) != row::Status::Ok {
        return Err(StudyError::Failed(row.last().cloned().unwrap_or_default()));
    }
    let figure = |(place, name): (usize, &String)| match row[place].as_str() {
        "" => Err(StudyError::Failed(format!("this run has no `{name}`"))),
        cell => Ok(cell.to_owned()),
    };
    places.into_iter().zip(asked).map(figure).collect()
}
