//! `freeplay expand`: the mechanism file that a template stands for.

use crate::cli::shared::failure::{Failure, warn_of_doubts};
use crate::cli::shared::options::ScenarioOptions;
use crate::cli::shared::output;
use crate::model::expand;
use clap::Args;

/// Print the mechanism file that a scenario stands for
///
/// Machines with a `[mechanism] kind` are templates: they stand for bodies, joints and drives that a file
/// may also list itself. This prints that file, every default filled in, to be changed and added to; running
/// it gives the same bytes as running the template. A file that lists its bodies itself is printed as it is
/// read.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    #[command(flatten)]
    scenario: ScenarioOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay expand > three-rpr.toml   the built-in machine, body by body
  freeplay expand my-four-bar.toml --set mechanism.rocker=0.14
  freeplay expand my-four-bar.toml > mine.toml && freeplay run mine.toml";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let scenario = arguments.scenario.load()?;
    warn_of_doubts(&scenario);
    output::print(&expand(&scenario)?.to_toml())?;
    Ok(())
}
