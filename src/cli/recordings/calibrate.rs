//! `freeplay calibrate`: close the loop with measured data.

use super::self_test::SelfTest;
use crate::calibrate::quantity;
use crate::calibrate::result::FinishedCalibration;
use crate::calibrate::result::{CalibrateError, REPORT_FILE};
use crate::calibrate::sensed::report::Report;
use crate::calibrate::sensed::{into_folder, prepare};
use crate::cli::shared::failure::{Failure, say_how_written, say_remarks, warn_of_doubts};
use crate::cli::shared::options::{FolderOptions, PrintOptions, Sets};
use crate::cli::shared::parts::PartOptions;
use crate::cli::shared::progress::Spinner;
use crate::cli::shared::table::{paragraph, table};
use crate::effects::{ALL, named};
use crate::measure::spelling::nearest;
use crate::report::{known_to, number};
use crate::scenario::Scenario;
use clap::Args;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Find out what a declared model lacks, from recorded runs of the machine
///
/// A rig file is a scenario with [sensors], or a described mechanism with [[sensor]]s. The declared model is simulated along the recorded commands;
/// what remains between measurement and model is searched for the trace of every effect at every joint
/// (`freeplay effects` lists them), values are fitted on --data and judged on --validate (without it,
/// on the second half of --data). The verdict: nothing-missing, explained (by which effects, with values
/// and 95 % intervals), or unexplained (something without a name is missing: what depends on what stands
/// in its place).
///
/// The results go into a new folder: index.html (look at this first), report.json, calibrated.toml (the
/// rig with what was found: a scenario like any other), predicted-RUN.csv for each log, and pictures.
/// It takes a minute or two for runs of three seconds. Measured columns may be missing: what is there is
/// looked at through its own sensor, as those of described mechanisms are.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// What its maker declares: a scenario file (TOML) with [sensors]
    #[arg(long, value_name = "RIG.toml", required_unless_present = "self_test")]
    rig: Option<PathBuf>,
    /// Recorded run to calibrate on (CSV; t in s, q1_cmd… q1… in m, F1… in N, x y in m, phi in rad);
    /// of a machine that nothing holds it may be given many times, all are fitted together
    #[arg(long, value_name = "RUN.csv", required_unless_present = "self_test")]
    data: Vec<PathBuf>,
    /// Another recorded run, to validate on; may be given many times
    #[arg(long, value_name = "RUN.csv")]
    validate: Vec<PathBuf>,
    /// Do not look for this kind of effect, nor for what contains it; may be given many times
    #[arg(long, value_name = "KIND")]
    without: Vec<String>,
    /// Instead of all this: hide known effects of random size in synthetic recordings of several machines,
    /// calibrate each, and print how often the answer is right, and every wrong one (a minute a trial)
    #[arg(long, conflicts_with_all = ["rig", "data", "validate", "without", "sets", "engine", "out", "force"])]
    self_test: bool,
    /// Hide this kind of effect only, or `nothing`, `noise`, or `a+b`; may be given many times
    #[arg(long, value_name = "KIND", requires = "self_test", conflicts_with = "rig")]
    hidden: Vec<String>,
    /// Try this machine only; may be given many times
    #[arg(long, value_name = "NAME", requires = "self_test", conflicts_with = "rig")]
    machine: Vec<String>,
    /// Number of trials; with 0 the rates of the table that --trials names
    #[arg(
        long,
        value_name = "N",
        requires = "self_test",
        conflicts_with = "rig",
        default_value_t = 100
    )]
    count: usize,
    /// Another set of random machines, effects, motions and noise
    #[arg(
        long,
        value_name = "N",
        requires = "self_test",
        conflicts_with = "rig",
        default_value_t = 1
    )]
    seed: u64,
    /// Keep finished trials in this file, one JSON object a line, and go on from there; a `{}` in its name is the number
    /// of the part that --shard makes
    #[arg(long, value_name = "FILE.jsonl", requires = "self_test", conflicts_with = "rig")]
    trials: Option<PathBuf>,
    /// Take finished trials from these files, too, such as those of all parts
    #[arg(long, value_name = "FILE.jsonl", requires = "self_test", conflicts_with = "rig", num_args = 1..)]
    from: Vec<PathBuf>,
    #[command(flatten)]
    parts: PartOptions,
    /// Keep the rig and the recordings of each trial in a folder in this one, to calibrate them by themselves
    #[arg(long, value_name = "DIR", requires = "self_test", conflicts_with = "rig")]
    keep: Option<PathBuf>,
    #[command(flatten)]
    sets: Sets,
    #[command(flatten)]
    folder: FolderOptions,
    #[command(flatten)]
    print: PrintOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay calibrate --rig rig.toml --data run-a.csv --validate run-b.csv
  freeplay calibrate --rig rig.toml --data run-a.csv --without payload
  freeplay calibrate --rig rig.toml --data run-a.csv \\
      --set 'environment.gravity=[0,-9.81]'
  freeplay calibrate --rig rig.toml --data run-a.csv --json | jq .verdict
  freeplay calibrate --self-test --count 100 --shard 1/4 --trials part-{}.jsonl
  freeplay calibrate --self-test --count 100 --trials all.jsonl \\
      --from part-*.jsonl";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let (Some(rig), false) = (&arguments.rig, arguments.data.is_empty()) else {
        let PrintOptions { json, quiet } = arguments.print;
        let Arguments { hidden: only, machine: machines, count, seed, trials, from, .. } =
            arguments;
        let (count, seed, parts) = (*count, *seed, &arguments.parts);
        let (table, keep) = (trials.as_deref(), arguments.keep.as_deref());
        let test = SelfTest { only, machines, count, seed, table, from, parts, keep, json, quiet };
        return super::self_test::main(&test);
    };
    if let Some(flag) = arguments.parts.given().first() {
        let message = format!("{flag}: is about the trials of --self-test; leave it out");
        return Err(Failure::Input(vec![message]));
    }
    let without = without(&arguments.without)?;
    let rig = Scenario::load(Some(rig), &arguments.sets.all())?;
    warn_of_doubts(&rig);
    let paths: Vec<&Path> =
        arguments.data.iter().chain(&arguments.validate).map(PathBuf::as_path).collect();
    say_how_written(paths.iter().copied());
    let name = rig.name.clone();
    let prepared = prepare(rig, &paths, arguments.data.len())?;
    say_remarks(prepared.remarks());
    let folder = arguments.folder.prepare("calibrate", &name, REPORT_FILE)?;
    let calibrated = Spinner::during(arguments.print.quiet, |tell| {
        into_folder(prepared, &without, folder, tell)
    })?;
    Ok(arguments.print.result(&calibrated.json, || text(&calibrated))?)
}

impl From<CalibrateError> for Failure {
    fn from(error: CalibrateError) -> Self {
        match error {
            CalibrateError::Input(messages) => Failure::Input(messages),
            CalibrateError::Halted(halt) => Failure::Other(halt.to_string()),
            CalibrateError::Files(error) => error.into(),
        }
    }
}

/// Kinds of effects by name.
fn without(names: &[String]) -> Result<Vec<&'static str>, Failure> {
    let known: Vec<&str> = ALL.iter().map(|kind| kind.name).collect();
    let kind = |name: &String| {
        named(name).map(|kind| kind.name).ok_or_else(|| {
            let help = nearest(name, &known).map_or_else(
                || format!("known: {} (`freeplay effects` explains them)", known.join(", ")),
                |near| format!("did you mean `{near}`?"),
            );
            format!("--without: `{name}` is not an effect; {help}")
        })
    };
    let (good, bad): (Vec<_>, Vec<_>) = names.iter().map(kind).partition(Result::is_ok);
    if bad.is_empty() {
        return Ok(good.into_iter().flatten().collect());
    }
    Err(Failure::Input(bad.into_iter().filter_map(Result::err).collect()))
}

/// The result for people.
fn text(done: &FinishedCalibration<Report>) -> String {
    let FinishedCalibration { report, folder, .. } = done;
    let summary = format!("{}: {}", report.provenance.scenario_name, report.summary);
    let mut text = paragraph("", "", &summary);
    // Writing to a string cannot fail, here and below.
    for effect in &report.effects {
        let joint = effect.on.words();
        let _ = writeln!(text, "\n  {}{joint}", effect.kind);
        for (name, fitted) in &effect.params {
            let [low, high] = fitted.ci95.map(|end| known_to(end, fitted.std));
            let value = known_to(fitted.value, fitted.std);
            let _ = writeln!(text, "    {name:<20} {value:>10}  (95 %: {low} to {high})");
        }
        if !effect.evidence.is_empty() {
            text += &paragraph("    ", "    ", &effect.evidence);
        }
    }
    let heads = ["run", "role", "channel", "before", "after", "floor"];
    let rows = report.errors.iter().map(|e| {
        let [before, after, floor] = [e.before, e.after, e.floor].map(|v| quantity(v, e.unit));
        [e.run.clone(), e.role.to_owned(), e.channel.clone(), before, after, floor]
    });
    let _ = write!(text, "\n{}", table("lllrrr", heads, rows));
    let page = folder.join("index.html");
    // A machine that is calibrated by windows is not simulated along a whole run.
    let simulations = match report.windows {
        Some(_) => String::new(),
        None => format!("{} simulations in ", report.simulations),
    };
    let _ = writeln!(
        text,
        "\n{simulations}{} s\nWritten to {}; open {}",
        number(report.wall_s),
        folder.display(),
        page.display()
    );
    text
}
