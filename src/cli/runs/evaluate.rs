//! `freeplay evaluate`: one run for a program that drives many: parameters in, one line of figures out.

use crate::cli::shared::failure::{Failure, refuse_errors, warn_of_seed};
use crate::cli::shared::options::ScenarioOptions;
use crate::cli::shared::output;
use crate::scenario::{Location, Problem, Problems};
use crate::simulate::{assemble, findings};
use crate::study::evaluate::{self, Parameters};
use clap::Args;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Simulate once for a program that drives many runs: parameters in, one line of figures out
///
/// For Dakota, OpenMOLE, a shell, or whatever else chooses parameters. The parameters are paths of the scenario with
/// their values: by --set, or in a file that --parameters names, one a line as `PATH = VALUE`, as JSON (`{\"PATH\": VALUE}`), or as
/// Dakota writes them (`VALUE PATH`, or with --aprepro `{ PATH = VALUE }`). The figures are those of
/// summary.json, and the line has them in the order of --figures, separated by blanks.
///
/// Where there are no figures (the machine cannot do what is asked, the run breaks down, the input is wrong) the line is
/// `FAIL`; the reason goes to standard error. No file is written but that of --results;
/// where that cannot be written, nothing is simulated and `FAIL` goes to standard output. The figures are those of
/// `freeplay sweep` and `freeplay run`, to the last digit.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    #[command(flatten)]
    scenario: ScenarioOptions,
    /// Figures of summary.json, separated by commas
    #[arg(long, value_name = "NAME,…", required = true, value_delimiter = ',')]
    figures: Vec<String>,
    /// Read parameters from this file
    #[arg(long, value_name = "FILE")]
    parameters: Option<PathBuf>,
    /// Write the line into this file instead of to standard output
    #[arg(long, value_name = "FILE")]
    results: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  freeplay evaluate --figures peak_contact_force_N --set joints.clearance=1e-4
  freeplay evaluate my.toml --figures rms_path_error_m,impacts \\
                 --parameters params.in --results results.out

Exit codes: 0 figures, 1 FAIL because of the run, 2 FAIL because of the input.";

/// What stands in place of figures: Dakota's word for it.
const FAIL: &str = "FAIL";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(file) = &arguments.results
        && let Err(error) = output::can_hold(file)
    {
        output::print(&format!("{FAIL}\n"))?;
        let message = format!("--results {}: cannot be written: {error}", file.display());
        return Err(Failure::Input(vec![message]));
    }
    let figures = figures(arguments);
    let line = figures.as_deref().unwrap_or(FAIL);
    match &arguments.results {
        None => output::print(&format!("{line}\n"))?,
        Some(file) => output::whole(file, &format!("{line}\n")).map_err(|error| {
            Failure::Other(format!("cannot write the results `{}`: {error}", file.display()))
        })?,
    }
    figures.map(drop)
}

/// The figures in one line.
fn figures(arguments: &Arguments) -> Result<String, Failure> {
    let mut sets = arguments.scenario.sets();
    if let Some(file) = &arguments.parameters {
        sets.extend(Parameters::read(file)?.sets());
    }
    let own = arguments.scenario.sets().len();
    let read = arguments.scenario.source()?.scenario(&sets);
    let scenario = read.map_err(|problems| match &arguments.parameters {
        Some(file) => named(problems, &sets[own..], file),
        None => problems.into(),
    })?;
    warn_of_seed(&scenario);
    let mut machine = assemble(&scenario)?;
    refuse_errors(findings(&scenario, &mut machine))?;
    // A signal ends the process: there is nothing to be kept.
    let never = AtomicBool::new(false);
    Ok(evaluate::figures(&scenario, &mut machine, &arguments.figures, &never)?.join(" "))
}

/// Problems with a scenario; those of keys that a file of parameters sets name that file.
fn named(problems: Problems, sets: &[String], file: &Path) -> Failure {
    let text = |problem: &Problem| match &problem.location {
        Location::Set { path } if sets.iter().any(|set| set.starts_with(&format!("{path}="))) => {
            problem.to_string().replacen("--set", &format!("--parameters {}:", file.display()), 1)
        }
        _ => problem.to_string(),
    };
    Failure::Input(problems.0.iter().map(text).collect())
}
