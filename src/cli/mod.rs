//! The command line: one file per command. Commands parse, call and print; what they call is in the
//! rooms below.
//!
//! * `files`: commands that simulate nothing; `runs`: those that simulate scenarios; `recordings`: those on recorded machines.
//! * `shared`: options, failures, printing, tables, progress, signals.
//!
//! Exit codes: 0 done, 2 wrong input (what, where, what would be right), 129, 130 and 143 ended by SIGHUP,
//! Ctrl-C and SIGTERM, or 75 where the same command goes on from there, 1 anything else. Results go
//! to standard output, everything else to standard error.

mod files;
mod recordings;
mod runs;
mod shared;

pub use files::effects::described as effect_described;
pub use files::laws::described as law_described;
pub use runs::compare::steps as compare_steps;
pub use runs::compare_laws::kinds as laws_to_compare;
pub use shared::parts::threads_of_queue;

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
    command: CliCommand,
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
enum CliCommand {
    Run(runs::run::Arguments),
    Evaluate(runs::evaluate::Arguments),
    Study(recordings::study::Arguments),
    Compare(runs::compare_options::Arguments),
    Paper(runs::paper::Arguments),
    Diff(runs::diff::Arguments),
    Calibrate(recordings::calibrate::Arguments),
    Predict(recordings::predict::Arguments),
    Record(recordings::record::Arguments),
    Plan(recordings::plan::Arguments),
    Check(files::check::Arguments),
    Sweep(runs::sweep::Arguments),
    Merge(runs::merge::Arguments),
    Effects(files::effects::Arguments),
    Laws(files::laws::Arguments),
    Wear(runs::wear::Arguments),
    Expand(files::expand::Arguments),
    Init(files::init::Arguments),
    Schema(files::schema::Arguments),
    Man(files::man::Arguments),
    Completions(files::completions::Arguments),
}

/// Runs the command that the process was called with.
pub fn main() -> ExitCode {
    let command = Cli::parse().command;
    shared::signals::watch();
    let done = match command {
        CliCommand::Run(arguments) => runs::run::main(&arguments),
        CliCommand::Evaluate(arguments) => runs::evaluate::main(&arguments),
        CliCommand::Study(arguments) => recordings::study::main(&arguments),
        CliCommand::Compare(arguments) => runs::compare::main(&arguments),
        CliCommand::Paper(arguments) => runs::paper::main(&arguments),
        CliCommand::Diff(arguments) => runs::diff::main(&arguments),
        CliCommand::Calibrate(arguments) => recordings::calibrate::main(&arguments),
        CliCommand::Predict(arguments) => recordings::predict::main(&arguments),
        CliCommand::Record(arguments) => recordings::record::main(&arguments),
        CliCommand::Plan(arguments) => recordings::plan::main(&arguments),
        CliCommand::Check(arguments) => files::check::main(&arguments),
        CliCommand::Sweep(arguments) => runs::sweep::main(&arguments),
        CliCommand::Merge(arguments) => runs::merge::main(&arguments),
        CliCommand::Effects(arguments) => files::effects::main(&arguments),
        CliCommand::Laws(arguments) => files::laws::main(&arguments),
        CliCommand::Wear(arguments) => runs::wear::main(&arguments),
        CliCommand::Expand(arguments) => files::expand::main(&arguments),
        CliCommand::Init(arguments) => files::init::main(&arguments),
        CliCommand::Schema(arguments) => files::schema::main(&arguments),
        CliCommand::Man(arguments) => files::man::main(&arguments),
        CliCommand::Completions(arguments) => files::completions::main(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.print();
            failure.code()
        }
    }
}
