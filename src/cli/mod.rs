//! The command line: one file per command. Commands parse, call and print; what they call is in the
//! rooms below.
//!
//! Exit codes: 0 done, 2 wrong input (what, where, what would be right), 129, 130 and 143 ended by SIGHUP,
//! Ctrl-C and SIGTERM, or 75 where the same command goes on from there, 1 anything else. Results go
//! to standard output, everything else to standard error.

mod calibrate;
mod catalogue;
mod check;
mod check_text;
mod compare;
mod compare_laws;
mod compare_options;
mod completions;
mod diff;
mod effects;
mod evaluate;
mod expand;
mod failure;
mod init;
mod laws;
mod man;
mod merge;
mod options;
mod output;
mod paper;
mod parts;
mod plan;
mod predict;
mod progress;
mod record;
mod run;
mod schema;
mod self_test;
mod signals;
mod study;
mod sweep;
mod table;
mod wear;

pub use compare::steps as compare_steps;
pub use compare_laws::kinds as laws_to_compare;
pub use effects::described as effect_described;
pub use laws::described as law_described;
pub use parts::threads_of_queue;

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
  freeplay run                             the built-in machine
  freeplay run --set joints.clearance=1e-4       with 0.1 mm of clearance
  freeplay compare                         contact law, native contacts, ideal
  freeplay diff a.toml b.toml              what differs by more than chance
  freeplay paper                           the paper's claims, each checked
  freeplay check my-machine.toml           what can be said without simulating
  freeplay sweep --vary joints.clearance=1e-8..1e-3:log:100
  freeplay evaluate --figures impacts      one line, for other programs
  freeplay calibrate --rig rig.toml --data run.csv
  freeplay record rig.toml                 what a rig's sensors would show
  freeplay plan --rig rig.toml --detect payload
  freeplay expand                          the same machine, body by body
  freeplay init four-bar                   a scenario, every key explained
  freeplay effects payload                 what can be added to a machine
  freeplay laws hunt-crossley              contact laws, what they are and do
  freeplay wear mine.toml --cycles 1e6     how rings wear

Exit codes: 0 done, 2 wrong input, 129, 130 and 143 ended by SIGHUP, Ctrl-C
and SIGTERM (75 where the same command goes on from there: sweep, calibrate
--self-test), 1 anything else.";

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Arguments),
    Evaluate(evaluate::Arguments),
    Study(study::Arguments),
    Compare(compare_options::Arguments),
    Paper(paper::Arguments),
    Diff(diff::Arguments),
    Calibrate(calibrate::Arguments),
    Predict(predict::Arguments),
    Record(record::Arguments),
    Plan(plan::Arguments),
    Check(check::Arguments),
    Sweep(sweep::Arguments),
    Merge(merge::Arguments),
    Effects(effects::Arguments),
    Laws(laws::Arguments),
    Wear(wear::Arguments),
    Expand(expand::Arguments),
    Init(init::Arguments),
    Schema(schema::Arguments),
    Man(man::Arguments),
    Completions(completions::Arguments),
}

/// Runs the command that the process was called with.
pub fn main() -> ExitCode {
    let command = Cli::parse().command;
    signals::watch();
    let done = match command {
        Command::Run(arguments) => run::main(&arguments),
        Command::Evaluate(arguments) => evaluate::main(&arguments),
        Command::Study(arguments) => study::main(&arguments),
        Command::Compare(arguments) => compare::main(&arguments),
        Command::Paper(arguments) => paper::main(&arguments),
        Command::Diff(arguments) => diff::main(&arguments),
        Command::Calibrate(arguments) => calibrate::main(&arguments),
        Command::Predict(arguments) => predict::main(&arguments),
        Command::Record(arguments) => record::main(&arguments),
        Command::Plan(arguments) => plan::main(&arguments),
        Command::Check(arguments) => check::main(&arguments),
        Command::Sweep(arguments) => sweep::main(&arguments),
        Command::Merge(arguments) => merge::main(&arguments),
        Command::Effects(arguments) => effects::main(&arguments),
        Command::Laws(arguments) => laws::main(&arguments),
        Command::Wear(arguments) => wear::main(&arguments),
        Command::Expand(arguments) => expand::main(&arguments),
        Command::Init(arguments) => init::main(&arguments),
        Command::Schema(arguments) => schema::main(&arguments),
        Command::Man(arguments) => man::main(&arguments),
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
