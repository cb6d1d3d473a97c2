//! What both comparisons are told, that of contact models and that of contact laws.

use crate::cli::shared::options::{CostOptions, FolderOptions, PrintOptions, ScenarioOptions};
use crate::cli::shared::output;
use crate::scenario::Scenario;
use crate::simulate::Finding;
use clap::Args;

/// Compare the contact law with the physics engine's own contacts and with ideal joints
///
/// One scenario is simulated under hertz-step, native and ideal joints, at every step of a list (and
/// at its tolerance), from several starts. The results go into a new folder: index.html (look at this
/// first; it begins with a plain answer: what native contacts may be used for in this machine, and what
/// not), compare.json, compare.csv (a row per law and step, means over the starts with their standard
/// errors, SI units), table.md (the main figures, to be pasted), scenario.toml and pictures (SVG).
///
/// The native contacts are given a spring that lasts as long and returns as much speed in one hit as
/// the law; [native] in the scenario sets them otherwise.
///
/// With --laws, the scenario is simulated under each of these laws instead, at its tolerance and at equal
/// restitution where that can be matched: `index.html`, `compare-laws.json` and `compare-laws.csv` say which results depend on the
/// law by more than chaos makes them differ from start to start.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    #[command(flatten)]
    pub(in crate::cli) scenario: ScenarioOptions,
    /// Fixed steps in seconds, separated by commas; at most 8, each from 1e-7 to 1e-4
    #[arg(
        long,
        value_name = "S,S,…",
        default_value = "1e-4,5e-5,2e-5,1e-5,5e-6",
        allow_hyphen_values = true
    )]
    pub(super) steps: String,
    /// Starts over which statistics are taken: points around a circle, otherwise tiny displacements
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u16).range(2..=1000))]
    pub(super) starts: u16,
    /// Compare contact laws with each other instead: `all`, or names separated by commas
    #[arg(long, value_name = "LAW,…", conflicts_with = "steps")]
    pub(super) laws: Option<String>,
    #[command(flatten)]
    pub(super) cost: CostOptions,
    #[command(flatten)]
    pub(super) folder: FolderOptions,
    #[command(flatten)]
    pub(in crate::cli) print: PrintOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay compare   the built-in machine, 8 starts of 1 s
  freeplay compare --steps 2e-5,1e-5,5e-6,2e-6 --starts 32
  freeplay compare my-machine.toml --set joints.clearance=1e-4
  freeplay compare --set native.restitution=0.7       another native setting
  freeplay compare --laws all   every contact law, at equal restitution
  freeplay compare --laws hertz-step,flores,liu --starts 16
  freeplay compare --json --quiet | jq -r '.answer[]'";

/// Says that a comparison does not take the scenario's own step, and what it takes.
pub(super) fn warn_of_step(scenario: &Scenario, taken: &str) {
    if scenario.simulation.step.is_some() {
        let problem = scenario.problem("simulation.step", "is not used", taken);
        output::complain(&Finding::warning(problem).to_string());
    }
}
