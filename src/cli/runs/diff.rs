//! `freeplay diff`: what differs between two models, or two results.

use crate::cli::shared::failure::{Failure, refuse_errors};
use crate::cli::shared::options::{CostOptions, FolderOptions, PrintOptions, Sets};
use crate::cli::shared::output;
use crate::cli::shared::progress::Progress;
use crate::cli::shared::table::{paragraph, table};
use crate::simulate::{assemble, findings};
use crate::study::diff::{
    DIFF_FILE, FinishedDiff, Side, diff_models, diff_results, simulated_time,
};
use clap::Args;
use std::path::{Path, PathBuf};

/// Say what differs between two models, or between two results, and by how much more than chance
///
/// Two scenario files (calibrated models among them) are simulated from several starts each: means, their
/// difference, and its floor, half of the 95 % interval that chance leaves. Two folders of `freeplay run` are
/// compared as they lie there: figures of their summaries, and columns of their time series as long as the
/// motion can be predicted. Peaks of a single chaotic run are one draw; diff says so. A folder beside a scenario
/// file stands for the scenario in it.
///
/// The results go into a new folder: index.html (both over one another), diff.json and diff.csv.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// Folder of a run, or scenario file (TOML)
    #[arg(value_name = "A")]
    first: PathBuf,
    /// The other one
    #[arg(value_name = "B")]
    second: PathBuf,
    /// Starts over which means of models are taken: points around a circle, otherwise tiny displacements
    /// [default: 8]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(2..=1000))]
    starts: Option<u16>,
    #[command(flatten)]
    sets: Sets,
    #[command(flatten)]
    cost: CostOptions,
    #[command(flatten)]
    folder: FolderOptions,
    #[command(flatten)]
    print: PrintOptions,
}

/// Starts where none are asked for: a mean's interval over eight is less than half as wide again as over many.
const STARTS: u16 = 8;

const EXAMPLES: &str = "\
Examples:
  freeplay diff tight.toml worn.toml                   two models, 8 starts each
  freeplay diff rig.toml calibrated.toml --starts 32 --set simulation.duration=2
  freeplay diff freeplay-run-default freeplay-run-default-2   two results
  freeplay diff a b --json --quiet | jq '.rows[] | select(.differs)'";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let sets = arguments.sets.all();
    let paths = [arguments.first.as_path(), arguments.second.as_path()];
    let sides = [Side::read(paths[0], &sets)?, Side::read(paths[1], &sets)?];
    let names = names(paths);
    let prepare = || {
        let [a, b] = names.each_ref().map(|name| name.replace(['/', '\\'], "-"));
        arguments.folder.prepare("diff", &format!("{a}-{b}"), DIFF_FILE)
    };
    let done = match &sides {
        [Side::Result(a, _), Side::Result(b, _)] => {
            let mut idle = arguments.sets.given();
            idle.extend(arguments.starts.map(|_| "--starts"));
            if !idle.is_empty() {
                let message = format!(
                    "{}: two results lie there as they are; give the scenario.toml in one of them instead",
                    idle.join(", ")
                );
                return Err(Failure::Input(vec![message]));
            }
            diff_results(&sides, [a, b], names.clone(), prepare()?)?
        }
        _ => {
            for side in &sides {
                let scenario = side.scenario();
                refuse_errors(findings(scenario, &mut assemble(scenario)?))?;
            }
            let starts = usize::from(arguments.starts.unwrap_or(STARTS));
            let folder = prepare()?;
            let (yes, quiet) = (arguments.cost.yes, arguments.print.quiet);
            Progress::during(simulated_time(&sides, starts), yes, quiet, |watch| {
                diff_models(&sides, names.clone(), starts, folder, watch)
            })?
        }
    };
    arguments.print.result(&done.json, || text(&done))?;
    for warning in &done.diff.warnings {
        output::complain(&format!("warning: {warning}"));
    }
    Ok(())
}

/// What the two are called: the last parts of their paths in which they differ.
fn names(paths: [&Path; 2]) -> [String; 2] {
    let parts = paths.map(|path| {
        path.components()
            .map(|part| part.as_os_str().to_string_lossy().into_owned())
            .collect::<Vec<_>>()
    });
    let last =
        |n: usize| parts.each_ref().map(|parts| parts[parts.len().saturating_sub(n)..].join("/"));
    let most = parts.iter().map(Vec::len).max().unwrap_or(1);
    let apart = (1..=most).map(last).find(|[a, b]| a != b);
    apart.unwrap_or_else(|| ["the first".to_owned(), "the second".to_owned()])
}

/// The result for people.
fn text(done: &FinishedDiff) -> String {
    let diff = &done.diff;
    let [a, b] = &diff.names;
    let heads = ["figure", a, b, "difference", "floor", "differs"];
    let rows = table("lrrrrl", heads, diff.rows.iter().map(|row| row.cells()));
    let page = done.folder.join("index.html");
    format!(
        "{}\n{rows}\nWritten to {}; open {}\n",
        paragraph("", "", &diff.answer),
        done.folder.display(),
        page.display()
    )
}
