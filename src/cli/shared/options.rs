//! Options that commands share.

use super::output;
use crate::results::{Folder, FolderError, default_name};
use crate::scenario::{Problems, Scenario, Source};
use clap::Args;
use std::io;
use std::path::{Path, PathBuf};

/// Which scenario.
#[derive(Debug, Args)]
pub(in crate::cli) struct ScenarioOptions {
    /// Scenario file (TOML); without one, the built-in scenario
    #[arg(value_name = "SCENARIO")]
    file: Option<PathBuf>,
    #[command(flatten)]
    overrides: Overrides,
}

/// Values that are changed in a scenario.
#[derive(Debug, Args)]
pub(in crate::cli) struct Sets {
    /// Set one value of the scenario; may be given many times
    ///
    /// PATH is section.key, VALUE is TOML (a bare word is a string), SI units:
    /// `joints.clearance=1e-4` (m), `drive.mode=servo`, `environment.gravity=[0,-9.81]` (m/s²),
    /// `motion.period=0.5` (s), `contact.law=native`, `simulation.output_interval=1e-4` (s).
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
    /// What steps the machine: the physics engine, or the equations of motion integrated directly, two to
    /// four times as fast for the same error; short for --set simulation.engine=ENGINE
    #[arg(long, value_parser = ["rapier", "direct"])]
    engine: Option<String>,
}

impl Sets {
    /// The options that were given, for messages.
    pub fn given(&self) -> Vec<&'static str> {
        let given = [("--set", !self.sets.is_empty()), ("--engine", self.engine.is_some())];
        given.into_iter().filter(|(_, given)| *given).map(|(flag, _)| flag).collect()
    }

    /// All of them, in their order.
    pub fn all(&self) -> Vec<String> {
        let engine = self.engine.as_ref().map(|engine| format!("simulation.engine={engine}"));
        self.sets.iter().cloned().chain(engine).collect()
    }
}

/// A time that somebody typed.
///
/// # Errors
/// What would be right, of what is no number.
pub(super) fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds: &f64| !seconds.is_nan());
    seconds.ok_or_else(|| "expected a number of seconds without a unit, such as 0.5".to_owned())
}

/// What is changed in a scenario.
#[derive(Debug, Args)]
pub(in crate::cli) struct Overrides {
    #[command(flatten)]
    sets: Sets,
    /// Simulated time in seconds; short for --set simulation.duration=S
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = seconds)]
    duration: Option<f64>,
}

impl ScenarioOptions {
    /// Reads the scenario.
    pub fn load(&self) -> Result<Scenario, Problems> {
        self.source()?.scenario(&self.sets())
    }

    /// Reads the text of the scenario.
    pub fn source(&self) -> Result<Source, Problems> {
        Source::read(self.file.as_deref())
    }

    /// All overrides, in their order.
    pub fn sets(&self) -> Vec<String> {
        self.overrides.sets()
    }
}

impl Overrides {
    /// All of them, in their order.
    pub fn sets(&self) -> Vec<String> {
        let duration = self.duration.map(|s| format!("simulation.duration={s:?}"));
        self.sets.all().into_iter().chain(duration).collect()
    }
}

/// Results of one name in one folder beyond which no number is tried.
const MOST_RESULTS: usize = 1000;

impl FolderOptions {
    /// Where the results of a command on a scenario go.
    pub fn path(&self, command: &str, scenario: &str) -> PathBuf {
        self.out.clone().unwrap_or_else(|| default_name(command, scenario))
    }

    /// Makes sure that the results of a command on a scenario can be written; they are known by `marker`. A name
    /// that nobody chose counts up where it is taken: the first run stays beside the second.
    pub fn prepare(
        &self,
        command: &str,
        scenario: &str,
        marker: &'static str,
    ) -> Result<Folder, FolderError> {
        let first = self.path(command, scenario);
        let mut prepared = Folder::prepare(&first, marker, self.force);
        for name in self.numbered(&first).skip(1) {
            let taken = matches!(prepared, Err(FolderError::Taken(_) | FolderError::Busy { .. }));
            if self.out.is_some() || !taken {
                break;
            }
            prepared = Folder::prepare(&name, marker, self.force);
        }
        prepared
    }

    /// A name, and those that count up from it: `run`, `run-2`, `run-3`.
    pub fn numbered(&self, first: &Path) -> impl Iterator<Item = PathBuf> {
        let first = first.to_owned();
        (1..=MOST_RESULTS).map(move |count| {
            let mut name = first.clone().into_os_string();
            if count > 1 {
                name.push(format!("-{count}"));
            }
            name.into()
        })
    }
}

impl PrintOptions {
    /// Prints a result as the user wants it: its JSON, its text for people, or nothing.
    pub fn result(&self, json: &str, text: impl FnOnce() -> String) -> io::Result<()> {
        if self.json {
            output::print(json)
        } else if self.quiet {
            Ok(())
        } else {
            output::print(&text())
        }
    }
}

/// Where files go.
#[derive(Debug, Args)]
pub(in crate::cli) struct FolderOptions {
    /// Folder for the results [default: named after command and scenario, in the working directory, and
    /// numbered where that is taken]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace a result that is already there (never any other files)
    #[arg(long)]
    pub force: bool,
}

/// Whether it matters how long it takes.
#[derive(Debug, Args)]
pub(in crate::cli) struct CostOptions {
    /// Go on although it will take more than 10 min, as judged by its first minute; without this it
    /// ends there, with exit code 2
    #[arg(long)]
    pub yes: bool,
}

/// What is printed.
#[derive(Debug, Args)]
pub(in crate::cli) struct PrintOptions {
    /// Print no progress and no result; errors and warnings still go to standard error
    #[arg(long, short)]
    pub quiet: bool,
    /// Print the result as JSON on standard output, and nothing else there
    #[arg(long)]
    pub json: bool,
}
