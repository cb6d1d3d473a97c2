//! `freeplay paper`: the paper's study.

use crate::cli::shared::failure::{Failure, refuse_faults};
use crate::cli::shared::options::{CostOptions, FolderOptions, Overrides, PrintOptions};
use crate::cli::shared::progress::Progress;
use crate::cli::shared::table::{paragraph, table};
use crate::report::number;
use crate::scenario::Source;
use crate::study::paper::{PAPER_FILE, Studied, paper, scenarios, simulated_time};
use clap::Args;

/// Repeat the paper's study: figures 4 to 9, the table, and every claim checked
///
/// The built-in machine at the paper's clearances, 0.5 mm and 0.00001 mm, and three between them, from
/// several starts. Each claim of the paper is judged by the 95 % interval of a mean or a ratio over the
/// starts, not by one run: the motion is chaotic. What the paper does not give (damping, trajectory,
/// platform angle, …) is varied, ADAMS' own defaults included, and every claim judged again.
///
/// The results go into a new folder: index.html (look at this first), paper.json, figure-4.svg to
/// figure-9.svg, pictures of the claims over the assumptions, and scenario.toml.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    #[command(flatten)]
    overrides: Overrides,
    /// Starts over which statistics are taken: points around a circle, directions of a line
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u16).range(2..=1000))]
    phases: u16,
    #[command(flatten)]
    cost: CostOptions,
    #[command(flatten)]
    folder: FolderOptions,
    #[command(flatten)]
    print: PrintOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay paper                                      8 starts of 1 s
  freeplay paper --phases 32 --duration 2.2           narrower intervals
  freeplay paper --set drive.mode=servo   the same claims of another machine
  freeplay paper --json --quiet | jq '.claims[].verdict'";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let phases = arguments.phases.into();
    let scenarios = scenarios(&Source::read(None)?, &arguments.overrides.sets(), phases)?;
    let folder = arguments.folder.prepare("paper", &scenarios[0].1.name, PAPER_FILE)?;

    let simulated = simulated_time(&scenarios, phases);
    let (yes, quiet) = (arguments.cost.yes, arguments.print.quiet);
    let studied =
        Progress::during(simulated, yes, quiet, |watch| paper(&scenarios, phases, folder, watch))?;
    arguments.print.result(&studied.json, || text(&studied))?;
    refuse_faults(&studied.paper.faults())
}

/// The result for people.
fn text(studied: &Studied) -> String {
    let p = &studied.paper;
    let counted = format!(
        "{} claims of the paper, {} sets of assumptions, {} starts of {} s, in {} s",
        p.claims.len(),
        p.variants.len(),
        p.phases,
        number(p.duration_s),
        number(p.wall_s)
    );
    let heads = ["claim", "verdict", "value", "95 % interval", "limit", "over the assumptions"];
    let rows = p.claims.iter().map(|claim| {
        let (judged, moves) = (&claim.judged, &claim.over_variants);
        let [low, high] = judged.estimate.ci95.map(number);
        [
            claim.label.to_string(),
            judged.verdict.in_words().to_string(),
            number(judged.estimate.value),
            format!("{low} to {high}"),
            claim.limit.to_string(),
            format!("{} yes, {} no, {} open", moves.supported, moves.contradicted, moves.undecided),
        ]
    });
    let (counted, rows) = (paragraph("", "", &counted), table("llrrrl", heads, rows));
    let folder = studied.folder.display();
    let page = studied.folder.join("index.html");
    format!("{counted}\n{rows}\nWritten to {folder}; open {}\n", page.display())
}
