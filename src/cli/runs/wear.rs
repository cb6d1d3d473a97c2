//! `freeplay wear`: bearing rings over many cycles.

use crate::cli::shared::failure::{Failure, refuse_errors};
use crate::cli::shared::options::{CostOptions, FolderOptions, PrintOptions, ScenarioOptions};
use crate::cli::shared::output;
use crate::cli::shared::progress::Progress;
use crate::cli::shared::table::table;
use crate::report::{length, number};
use crate::scenario::Scenario;
use crate::simulate::{assemble, findings};
use crate::study::wear::{PredictedWear, WEAR_PREDICTED_FILE, WearRequest, period_of, wear};
use clap::Args;
use std::fmt::Write as _;

/// Predict how bearing rings wear over many cycles
///
/// Archard's law: a journal removes k times normal force times sliding distance of its ring, k
/// being contact.wear_coefficient in 1/Pa (wear coefficient over hardness; a joint may have its own),
/// over the axial length of the bearing (contact.length, default its diameter). A run says where
/// and how much each ring is rubbed in a cycle; the rings are grown by many cycles at once, and the
/// machine is run again with them. Each jump is made in one and in two halves: the difference is its
/// error, and decides how long jumps are.
///
/// The results go into a new folder: index.html, wear.json, clearances.csv (clearances over cycles),
/// rings.csv (depth and profile round each ring), worn.toml (the worn machine, a scenario like any
/// other), pictures. Only rings wear, not journals.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    #[command(flatten)]
    scenario: ScenarioOptions,
    /// Cycles of the motion
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    cycles: f64,
    /// Time of one cycle in s [default: the period of a circle, or one turn of the joint that turns
    /// at a constant rate; runs become that long where the scenario's count less]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    period: Option<f64>,
    /// Largest error of a jump over cycles, as a share of a joint's clearance
    #[arg(long, value_name = "SHARE", default_value_t = 0.01, allow_negative_numbers = true)]
    tolerance: f64,
    #[command(flatten)]
    cost: CostOptions,
    #[command(flatten)]
    folder: FolderOptions,
    #[command(flatten)]
    print: PrintOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay wear --cycles 1e6 --set contact.wear_coefficient=1e-14
  freeplay wear my-machine.toml --cycles 1e5 --duration 3 --out worn
  freeplay wear my-machine.toml --cycles 1e5 --period 0.5 --engine direct
  freeplay run worn/worn.toml                        the worn machine";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let wrong = |message: String| Failure::Input(vec![message]);
    let Arguments { cycles, tolerance, .. } = *arguments;
    if !(cycles > 0.0 && cycles.is_finite()) {
        return Err(wrong(format!("--cycles: is {cycles}; expected above 0")));
    }
    if !(tolerance > 0.0 && tolerance < 1.0) {
        return Err(wrong(format!("--tolerance: is {tolerance}; expected above 0 and below 1")));
    }
    let mut scenario = arguments.scenario.load()?;
    let Some(period) = arguments.period.or_else(|| period_of(&scenario)) else {
        let message =
            "--period: is missing; the motion does not say how long a cycle is: give it in s";
        return Err(wrong(message.to_owned()));
    };
    let counted = scenario.simulation.duration - scenario.simulation.settle();
    let whole = period > 0.0 && counted >= period * (1.0 - 1e-9);
    // A shorter cycle is no motion that anybody means.
    let shortest = scenario.simulation.output_interval;
    if arguments.period.is_some_and(|period| !whole || period < shortest) {
        let message = format!(
            "--period: is {period:?} s; expected at least the time between two rows, {shortest} s \
             (simulation.output_interval), and at most what a run counts: {} s of duration less its first {} s \
             (simulation.settle); a longer --duration counts more",
            scenario.simulation.duration,
            scenario.simulation.settle()
        );
        return Err(wrong(message));
    }
    if !whole {
        let settle = scenario.simulation.settle();
        scenario.simulation.settle = Some(settle);
        scenario.simulation.duration = settle + period;
        output::complain(&format!(
            "warning: runs take {} s instead of what the scenario says: the first {settle} s, which do not count, and one \
             cycle of {period} s",
            scenario.simulation.duration
        ));
    }
    refuse_errors(findings(&scenario, &mut assemble(&scenario)?))?;
    let folder = arguments.folder.prepare("wear", &scenario.name, WEAR_PREDICTED_FILE)?;
    let request = WearRequest { cycles, period, tolerance };
    let mut progress = Progress::counted(cycles, "cycles", arguments.print.quiet);
    let predicted =
        progress.watched(arguments.cost.yes, |watch| wear(&scenario, request, folder, watch))?;
    warn_of_part_cycles(period, &scenario);
    arguments.print.result(&predicted.json, || text(&predicted))?;
    Ok(())
}

/// Says that a cycle is not a whole number of the motion's own.
fn warn_of_part_cycles(period: f64, scenario: &Scenario) {
    let Some(own) = period_of(scenario) else { return };
    let times = period / own;
    if (times - times.round()).abs() > 1e-6 * times {
        output::complain(&format!(
            "warning: --period: is {period} s, which is no whole number of the motion's own {own} s: a cycle wears what \
             the run wears on average in that time, whatever part of the motion it is; expected {own} s or a multiple"
        ));
    }
}

/// The result for people.
fn text(predicted: &PredictedWear) -> String {
    let s = &predicted.summary;
    let mut text = format!(
        "{}: {} cycles of {} s in {} jumps, computed in {} s\n\n",
        s.provenance.scenario_name,
        number(s.cycles),
        number(s.period_s),
        s.stages.len() - 1,
        number(s.wall_s)
    );
    let heads = ["joint", "clearance new", "wider, mean", "at most", "deepest wear", "error"];
    let rows = s.joints.iter().map(|joint| {
        let lengths = [
            joint.new_clearance_m,
            joint.worn.clearance_m - joint.new_clearance_m,
            joint.worn.largest_clearance_m - joint.new_clearance_m,
            joint.worn.depth_m,
            joint.error_m,
        ];
        let [new, mean, largest, depth, error] = lengths.map(length);
        [joint.joint.clone(), new, mean, largest, depth, error]
    });
    text += &table("lrrrrr", heads, rows);
    // Writing to a string cannot fail.
    let page = predicted.folder.join("index.html");
    let _ = writeln!(text, "\nWritten to {}; open {}", predicted.folder.display(), page.display());
    text
}
