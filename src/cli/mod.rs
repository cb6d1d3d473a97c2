//! The command line: one file per command. Commands parse, call and print; what they call is in the
//! rooms below.
//!
//! Exit codes: 0 done, 2 wrong input (what, where, what would be right), 130 and 143 ended by Ctrl-C and
//! SIGTERM, 1 anything else. Results go
//! to standard output, everything else to standard error.

mod calibrate;
mod check;
mod check_text;
mod compare;
mod compare_laws;
mod completions;
mod effects;
mod expand;
mod failure;
mod laws;
mod merge;
mod options;
mod output;
mod paper;
mod predict;
mod progress;
mod run;
mod self_test;
mod signals;
mod study;
mod sweep;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Simulate mechanisms whose revolute joints have clearance (free play).
///
/// The journals of such joints fly and hit inside their bearing rings; the motion turns chaotic, and
/// the drives and the machine's accuracy feel it. Machines are described by scenario files (TOML);
/// without one, commands take the built-in scenario, a 3-RPR planar parallel manipulator with 0.5 mm
/// of clearance in all six revolute joints. SI units everywhere: m, kg, s, N, rad.
#[derive(Debug, Parser)]
#[command(name = "freeplay", version, arg_required_else_help = true, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  freeplay run                                  the built-in machine, into ./freeplay-run-default
  freeplay run --set joints.clearance=1e-4      the same with 0.1 mm of clearance
  freeplay compare                              contact law, native contacts, no clearance
  freeplay paper                                the paper's figures and claims, each checked
  freeplay check my-machine.toml                what can be said without simulating
  freeplay sweep --vary joints.clearance=1e-8..1e-3:log:100     many clearances, one table
  freeplay calibrate --rig rig.toml --data run.csv   what a declared model lacks, by measured data
  freeplay expand                               the same machine, body by body, to be changed
  freeplay effects payload                      what a scenario can add to a machine
  freeplay laws hunt-crossley                   contact laws, what they are and do

Exit codes: 0 done, 2 wrong input, 130 and 143 ended by Ctrl-C and SIGTERM, 1 anything else.";

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Arguments),
    Study(study::Arguments),
    Compare(compare::Arguments),
    Paper(paper::Arguments),
    Calibrate(calibrate::Arguments),
    Predict(predict::Arguments),
    Check(check::Arguments),
    Sweep(sweep::Arguments),
    Merge(merge::Arguments),
    Effects(effects::Arguments),
    Laws(laws::Arguments),
    Expand(expand::Arguments),
    Completions(completions::Arguments),
}

/// Runs the command that the process was called with.
pub fn main() -> ExitCode {
    let command = Cli::parse().command;
    signals::watch();
    let done = match command {
        Command::Run(arguments) => run::main(&arguments),
        Command::Study(arguments) => study::main(&arguments),
        Command::Compare(arguments) => compare::main(&arguments),
        Command::Paper(arguments) => paper::main(&arguments),
        Command::Calibrate(arguments) => calibrate::main(&arguments),
        Command::Predict(arguments) => predict::main(&arguments),
        Command::Check(arguments) => check::main(&arguments),
        Command::Sweep(arguments) => sweep::main(&arguments),
        Command::Merge(arguments) => merge::main(&arguments),
        Command::Effects(arguments) => effects::main(&arguments),
        Command::Laws(arguments) => laws::main(&arguments),
        Command::Expand(arguments) => expand::main(&arguments),
        Command::Completions(arguments) => completions::main(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.print();
            failure.code()
        }
    }
}
