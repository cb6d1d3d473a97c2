//! The method held against what it should find, on many machines: effects from the catalogue, instruments that are
//! wrong, or nothing, hidden in synthetic recordings of machines of several kinds and sizes.
//!
//! [`Trial`] says what is hidden where, [`Trial::draw`] what of it a seed draws (machines in `families`, `rig` and `motion`),
//! `hidden` which changes an effect of the catalogue may make, `sized` how large it is so that it shows by as much as was
//! drawn, `record` what sensors saw of it, `judge` whether the answer is right, and [`rates`] what all trials come to.

mod dice;
mod draw;
mod families;
mod hidden;
mod judge;
mod motion;
mod rates;
mod record;
mod rig;
mod sized;
mod trial;

pub use draw::trials;
pub use families::machines;
pub use rates::rates;
pub use trial::{Case, HiddenValue, NOISE, Trial, TrialAnswer, TriedTrial};

use super::residuals::problem::{RigProblem, Stopped};
use super::results::outcome::calibrate;
use judge::{judge, stopped_short};
use record::TrialBench;
use sized::hide;
use std::time::Instant;

/// Hides, calibrates, judges; `version` of the program goes into the row. `show` sees rig and recordings before they are
/// calibrated.
pub fn run(trial: &Trial, version: &str, show: &dyn Fn(&RigProblem)) -> TriedTrial {
    let (answer, unasked) = match asked(trial, show) {
        Ok(Some(answer)) => (Some(answer), None),
        Ok(None) => (None, Some("shows in no size".to_owned())),
        Err(stopped) => (None, Some(stopped.to_string())),
    };
    TriedTrial { trial: trial.clone(), version: version.to_owned(), unasked, answer }
}

/// What the method answers; none where what is hidden shows in no size. A method that stops has answered wrong.
///
/// # Errors
/// A rig that cannot be recorded.
fn asked(trial: &Trial, show: &dyn Fn(&RigProblem)) -> Result<Option<TrialAnswer>, Stopped> {
    let bench = TrialBench::new(trial)?;
    let Some(hidden) = hide(trial, &bench)? else { return Ok(None) };
    let mut problem = bench.problem(&hidden)?;
    show(&problem);
    let withheld: Vec<&str> = match trial.case {
        Case::Withheld => trial.hidden.iter().map(String::as_str).collect(),
        _ => Vec::new(),
    };
    let started = Instant::now();
    let outcome = calibrate(&mut problem, &withheld, &|_| {});
    let seconds = started.elapsed().as_secs_f64();
    let answer = match &outcome {
        Ok(outcome) => judge(trial, &hidden, &problem, outcome),
        Err(stopped) => stopped_short(&hidden, stopped),
    };
    Ok(Some(TrialAnswer { seconds, simulations: problem.simulations(), ..answer }))
}
