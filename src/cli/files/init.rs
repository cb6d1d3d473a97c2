//! `freeplay init`: a file to begin with.

use crate::cli::shared::failure::Failure;
use crate::cli::shared::output;
use crate::model::instrumented;
use crate::scenario::{Mechanism, Scenario, annotated};
use clap::Args;
use clap::builder::PossibleValuesParser;

/// Print a scenario or a rig to begin with, every key with its meaning
///
/// A scenario of one of the built-in kinds of machines with every default filled in; keys that are not needed
/// stand there as comments. With --rig, a machine with sensors, whose recordings `calibrate` and `predict` read
/// and `record` makes: a 3-RPR with [sensors], others described body by body with a [[sensor]] of each column.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// Kind of machine
    #[arg(value_name = "KIND", value_parser = PossibleValuesParser::new(Mechanism::KINDS))]
    kind: String,
    /// A rig: the machine with sensors
    #[arg(long)]
    rig: bool,
}

const EXAMPLES: &str = "\
Examples:
  freeplay init four-bar > my-four-bar.toml
  freeplay init 3rpr --rig > rig.toml
  freeplay record rig.toml                       what its sensors would show";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let mut text = format!("name = \"{0}\"\n[mechanism]\nkind = \"{0}\"\n", arguments.kind);
    let read = |text: &str| Scenario::from_text(text, &arguments.kind, &[]);
    let mut scenario = read(&text)?;
    // Nothing else moves what has no drives.
    if !scenario.mechanism.uses("drive") {
        text += "[environment]\ngravity = [0, -9.81]\n";
        scenario = read(&text)?;
    }
    let scenario = if arguments.rig { instrumented(&scenario)? } else { scenario };
    Ok(output::print(&annotated(&scenario))?)
}
