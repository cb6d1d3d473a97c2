//! `freeplay sweep`: many variants of a scenario.

use super::failure::Failure;
use super::options::{FolderOptions, PrintOptions, ScenarioOptions};
use super::output;
use super::progress::RunsProgress;
use super::signals;
use crate::report::number;
use crate::study::sweep::{Outcome, Plan, Shard, SweepError, on_threads, sweep};
use clap::Args;
use std::time::Instant as Clock;

/// Run many variants of a scenario in parallel, one row of a table each
///
/// Lists and ranges combine as a product: every value with every other. All random keys together are
/// one joint sample, a low-discrepancy sequence shifted by the scenario's `seed`.
///
/// The results go into a folder: index.html (look at this first), sweep.csv (one row a run: the varied
/// values, the figures of `freeplay run`'s summary.json, and `status`: ok, or halted or refused with
/// the reason), sweep.parquet (the same with types, if this program was built with the feature
/// `parquet`), sweep.json, and pictures. A sweep that was interrupted, in whatever way, goes on where
/// it was when the same command is given again.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Arguments {
    #[command(flatten)]
    scenario: ScenarioOptions,
    /// Vary one value of the scenario; may be given many times
    ///
    /// PATH=a,b,c takes these values (TOML; a bare word is a string); PATH=lo..hi:N takes N values
    /// evenly spaced, both ends among them; PATH=lo..hi:log:N evenly in the logarithm;
    /// PATH=lo..hi:random:N and PATH=lo..hi:log:random:N draw N.
    #[arg(long = "vary", value_name = "PATH=VALUES", required = true)]
    vary: Vec<String>,
    /// Run part I of N, counted from 1; `freeplay merge` joins the parts
    #[arg(long, value_name = "I/N", default_value_t = Shard::WHOLE)]
    shard: Shard,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    #[command(flatten)]
    folder: FolderOptions,
    #[command(flatten)]
    print: PrintOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay sweep --vary joints.clearance=1e-4,2e-4,5e-4
  freeplay sweep --vary joints.clearance=1e-8..1e-3:log:1000 --set simulation.tolerance=1e-4
  freeplay sweep --vary joints.clearance=1e-4,5e-4 --vary motion.phase=0..5.5:12    24 runs
  freeplay sweep --vary mechanism.platform_mass=0.15..0.25:random:200 \\
                 --vary joints.friction=0..0.2:random:200                          200 runs
  freeplay sweep --vary motion.period=0.5..2:100 --shard 1/4 --out part-1
  freeplay merge part-1 part-2 part-3 part-4 --out all";

pub(super) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let threads = arguments.threads.map(usize::from);
    let source = arguments.scenario.source()?;
    let sets = arguments.scenario.sets();
    let quiet = arguments.print.quiet;
    let started = Clock::now();
    let outcome = on_threads(threads, || {
        let plan = Plan::new(source, &sets, &arguments.vary, arguments.shard)?;
        for warning in plan.warnings() {
            output::complain(&format!("warning: {warning}"));
        }
        let name = &plan.base().name;
        let out = arguments.folder.path("sweep", name);
        signals::work_is(format!(
            "finished rows are kept in `{}`; the same command goes on from there",
            out.display()
        ));
        let progress = RunsProgress::new(quiet);
        let outcome = sweep(&plan, &out, arguments.folder.force, &|finished, runs| {
            progress.finished(finished, runs);
        });
        progress.clear();
        outcome
    })
    .and_then(|outcome: Result<Outcome, SweepError>| outcome)?;
    let title = format!("swept in {} s", number(started.elapsed().as_secs_f64()));
    print(&outcome, &title, &arguments.print)
}

/// Prints what came out, as the user wants it.
pub(super) fn print(outcome: &Outcome, title: &str, options: &PrintOptions) -> Result<(), Failure> {
    let text = || {
        let record = &outcome.record;
        let page = outcome.folder.join("index.html");
        format!(
            "{}: {} of {} runs, {title}: {} ok, {} halted, {} refused\n\nWritten to {}; open {}\n",
            record.identity.provenance.scenario_name,
            record.finished,
            record.runs_of_shard,
            record.ok,
            record.halted,
            record.refused,
            outcome.folder.display(),
            page.display()
        )
    };
    Ok(options.result(&outcome.json, text)?)
}
