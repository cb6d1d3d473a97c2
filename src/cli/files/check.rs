//! `freeplay check`: what can be said without simulating.

use super::check_text;
use crate::cli::shared::failure::Failure;
use crate::cli::shared::options::{PrintOptions, ScenarioOptions};
use crate::cli::shared::output;
use crate::scenario::{Problems, Scenario};
use crate::simulate::{Machine, Severity, assemble};
use crate::study::{self, Check, Engines};
use clap::Args;

/// Say everything about a scenario that can be said without simulating
///
/// Geometry and masses, how much of each leg's stroke the motion uses, how near it comes to a
/// singularity (where the platform can turn without any actuator moving), contact stiffness and how
/// long a hit lasts, the longest fixed step, and the forces that the machine would need without
/// clearance. Fails with exit code 2 if a run would be refused.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    #[command(flatten)]
    scenario: ScenarioOptions,
    /// Also run the first 0.2 s with the physics engine and with direct integration, and say by how much they differ
    #[arg(long)]
    engines: bool,
    #[command(flatten)]
    print: PrintOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay check                                     the built-in machine
  freeplay check my-machine.toml --set motion.radius=0.08
  freeplay check my-machine.toml --engines    two ways of stepping, side by side
  freeplay check my-machine.toml --json | jq .legs";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let check = match arguments.scenario.load().and_then(assembled) {
        Ok((scenario, mut machine)) => {
            let mut check = study::check(&scenario, &mut machine);
            if arguments.engines && check.ok {
                let engines = Engines::of(&machine).ok_or_else(|| {
                    let message = "`check --engines` compares steps under error control";
                    scenario.problem(
                        "simulation.step",
                        message,
                        "set simulation.tolerance instead, such as 1e-5",
                    )
                })?;
                if let Some(machine) = &mut check.machine {
                    machine.engines = Some(engines);
                }
            }
            check
        }
        Err(problems) => Check::unreadable(problems.0),
    };
    if arguments.print.json {
        // No input makes this fail: the types have only names for keys, and NaN becomes null.
        let json = serde_json::to_string_pretty(&check).expect("numbers, texts and lists are JSON");
        output::print(&(json + "\n"))?;
    } else if !arguments.print.quiet
        && let Some(machine) = &check.machine
    {
        output::print(&check_text::text(machine))?;
    }
    let (errors, warnings): (Vec<_>, Vec<_>) =
        check.findings.iter().partition(|found| found.severity == Severity::Error);
    for warning in warnings {
        output::complain(&format!("warning: {}", warning.text));
    }
    if errors.is_empty() {
        return Ok(());
    }
    Err(Failure::Input(errors.into_iter().map(|error| error.text.clone()).collect()))
}

fn assembled(scenario: Scenario) -> Result<(Scenario, Machine), Problems> {
    let machine = assemble(&scenario)?;
    Ok((scenario, machine))
}
