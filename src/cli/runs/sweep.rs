//! `freeplay sweep`: many variants of a scenario.

use crate::cli::shared::failure::Failure;
use crate::cli::shared::options::{FolderOptions, PrintOptions, ScenarioOptions};
use crate::cli::shared::output;
use crate::cli::shared::parts::{PartOptions, list, named};
use crate::cli::shared::progress::RunsProgress;
use crate::cli::shared::signals;
use crate::cli::shared::table::paragraph;
use crate::report::number;
use crate::study::StudyError;
use crate::study::sweep::{Plan, Shard, Standing, SweepOutcome, forecast, on_threads, sweep};
use clap::Args;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant as Clock};

/// Run many variants of a scenario in parallel, one row of a table each
///
/// Lists and ranges combine as a product: every value with every other. All random keys together are
/// one joint sample, a low-discrepancy sequence shifted by the scenario's `seed`.
///
/// The results go into a folder: index.html (look at this first), sweep.csv (one row a run: the varied
/// values, the figures of `freeplay run`'s summary.json, and `status`: ok, or halted or refused with
/// the reason), sweep.parquet (the same with types, if this program was built with the feature
/// `parquet`), sweep.json, and pictures. A sweep that was interrupted, in whatever way, goes on where
/// it was when the same command is given again. `freeplay merge` joins the parts that --shard makes; a `{}` in --out
/// is the number of the part.
///
/// Exit codes: 0 done, 1 runs halted (their rows say why), 2 wrong input, 75 ended by Ctrl-C or SIGTERM: finished rows
/// are kept, and the same command goes on.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    #[command(flatten)]
    scenario: ScenarioOptions,
    /// Vary one value of the scenario; may be given many times
    ///
    /// PATH=a,b,c takes these values (TOML; a bare word is a string); PATH=lo..hi:N takes N values
    /// evenly spaced, both ends among them; PATH=lo..hi:log:N evenly in the logarithm;
    /// PATH=lo..hi:random:N and PATH=lo..hi:log:random:N draw N.
    #[arg(long = "vary", value_name = "PATH=VALUES", required = true)]
    vary: Vec<String>,
    #[command(flatten)]
    parts: PartOptions,
    #[command(flatten)]
    folder: FolderOptions,
    #[command(flatten)]
    print: PrintOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay sweep --vary joints.clearance=1e-4,2e-4,5e-4
  freeplay sweep --vary joints.clearance=1e-8..1e-3:log:1000
  freeplay sweep --vary joints.clearance=1e-4,5e-4 --vary motion.phase=0..5.5:12
  freeplay sweep --vary mechanism.platform_mass=0.15..0.25:random:200 \\
                 --vary joints.friction=0..0.2:random:200   200 runs
  freeplay sweep --vary motion.period=0.5..2:100 --dry-run   how long?
  freeplay sweep --vary motion.period=0.5..2:100 --shard 1/4 --out part-{}
  freeplay sweep --vary motion.period=0.5..2:100 --missing 4 --out part-{}
  freeplay merge part-1 part-2 part-3 part-4 --out all";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let parts = &arguments.parts;
    let asked = parts.asked_for("--out", arguments.folder.out.as_deref())?;
    let source = arguments.scenario.source()?;
    let sets = arguments.scenario.sets();
    on_threads(parts.threads(), || {
        let plan = Plan::new(source, &sets, &arguments.vary, parts.shard)?;
        for warning in plan.warnings() {
            output::complain(&format!("warning: {warning}"));
        }
        let out = folder(&plan, &arguments.folder);
        match asked {
            Some(shards) => print_missing(&plan, &shards, &out),
            None if parts.dry_run => print_forecast(&plan, &named(&out, parts.shard), arguments),
            None => make(&plan, &named(&out, parts.shard), arguments),
        }
    })?
}

/// Where the rows of a sweep go. A name that nobody chose counts up past other sweeps, to one that holds this sweep or
/// nothing: the same command goes on where it was.
fn folder(plan: &Plan, options: &FolderOptions) -> PathBuf {
    let first = options.path("sweep", &plan.base().name);
    if options.out.is_some() || options.force {
        return first;
    }
    let others = |path: &PathBuf| {
        let there = named(path, plan.shard());
        matches!(Standing::of(plan, plan.shard(), &there), Err(StudyError::Another(_)))
    };
    let mut names = options.numbered(&first);
    names.find(|path| !others(path)).unwrap_or_else(|| first.clone())
}

/// Makes the runs, and prints what came out.
fn make(plan: &Plan, out: &Path, arguments: &Arguments) -> Result<(), Failure> {
    let started = Clock::now();
    signals::work_is(format!(
        "finished rows are kept in `{}`; the same command goes on from there",
        out.display()
    ));
    let progress = RunsProgress::new(arguments.print.quiet);
    // A signal ends the process: rows are in the journal as soon as they are finished.
    let never = AtomicBool::new(false);
    let outcome = sweep(plan, out, arguments.folder.force, &never, &|finished, runs| {
        progress.finished(finished, runs);
    });
    progress.clear();
    let title = format!("swept in {} s", number(started.elapsed().as_secs_f64()));
    print(&outcome?, &title, &arguments.print)
}

/// Prints which parts have to be made, as a job array takes them.
fn print_missing(plan: &Plan, shards: &[Shard], out: &Path) -> Result<(), Failure> {
    let mut missing = Vec::new();
    for &shard in shards {
        let folder = named(out, shard);
        let standing = Standing::of(plan, shard, &folder)?;
        if standing.busy {
            let message = "is at work, and not listed";
            output::complain(&format!("note: `{}` (shard {shard}) {message}", folder.display()));
        } else if !standing.complete {
            missing.push(shard.index());
        }
    }
    Ok(output::print(&(list(&missing) + "\n"))?)
}

/// What a sweep would be, for programs.
#[derive(Serialize)]
struct Foreseen {
    runs: usize,
    finished: usize,
    missing: usize,
    /// Runs that were tried.
    tried: usize,
    /// Mean time of one of them.
    run_s: Option<f64>,
    threads: usize,
    /// Time of all that are missing.
    rest_s: Option<f64>,
}

/// Longest time that one run is tried for: three of them keep nobody waiting.
const TRIAL: Duration = Duration::from_secs(3);

/// Prints how many runs there are and what they will take.
fn print_forecast(plan: &Plan, out: &Path, arguments: &Arguments) -> Result<(), Failure> {
    let shard = plan.shard();
    let missing = Standing::of(plan, shard, out)?.missing;
    let runs = shard.runs(plan.identity().runs).count();
    let forecast = forecast(plan, &missing, TRIAL);
    let threads = rayon::current_num_threads();
    let run_s = forecast.map(|forecast| forecast.run_s);
    // The last runs leave threads idle: whole rounds.
    let rest_s = run_s.map(|run_s| run_s * missing.len().div_ceil(threads) as f64);
    let (finished, missing) = (runs - missing.len(), missing.len());
    let tried = forecast.map_or(0, |forecast| forecast.tried);
    let foreseen = Foreseen { runs, finished, missing, tried, run_s, threads, rest_s };
    let json = serde_json::to_string_pretty(&foreseen).unwrap_or_default() + "\n";
    let text = || {
        let time = run_s.zip(rest_s).map_or(String::new(), |(run_s, rest_s)| {
            let (run_s, rest_s) = (number(run_s), number(rest_s));
            format!(
                "; a run takes {run_s} s ({tried} tried), the rest {rest_s} s on {threads} threads"
            )
        });
        paragraph("", "", &format!("{runs} runs, {finished} of them done{time}"))
    };
    Ok(arguments.print.result(&json, text)?)
}

/// Prints what came out, as the user wants it.
pub(in crate::cli) fn print(
    outcome: &SweepOutcome,
    title: &str,
    options: &PrintOptions,
) -> Result<(), Failure> {
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
    options.result(&outcome.json, text)?;
    match outcome.record.halted {
        0 => Ok(()),
        halted => Err(Failure::Other(format!(
            "{halted} of {} runs halted; the column `status` of `{}` says why",
            outcome.record.finished,
            outcome.folder.join("sweep.csv").display()
        ))),
    }
}
