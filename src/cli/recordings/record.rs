//! `freeplay record`: what the sensors of a scenario would record.

use crate::calibrate::quantity;
use crate::calibrate::record::{
    FinishedRecordings, RECORD_FILE, RIG_FILE, RowCount, into_folder, prepare,
};
use crate::calibrate::sensed::thresholds::{LOWEST_RATE, SHORTEST};
use crate::cli::shared::failure::{Failure, refuse_errors};
use crate::cli::shared::options::{FolderOptions, PrintOptions, Sets};
use crate::cli::shared::progress::Spinner;
use crate::cli::shared::table::{paragraph, table};
use crate::scenario::Scenario;
use crate::simulate::{assemble, findings};
use clap::Args;
use std::path::PathBuf;

/// Record what the sensors of a scenario would show: logs for `calibrate` and `predict`
///
/// Would my sensors see 20 µm of wear? The machine is simulated as it is, [[effect]]s included, and recorded
/// through its sensors: their noise, resolution and filters ([[sensor]], or [sensors] of a template). The rig
/// that is written beside the recordings declares everything but the effects, so that `freeplay calibrate` can
/// be asked to find them. A table says by how much the declared rig misses the recordings, beside what noise and
/// rattle leave to any model.
///
/// Two recordings: run-a.csv follows the motion, from rest on; run-b.csv does so at 0.8 of its pace, to validate
/// on. A machine without drives is let go at its start, and at 0.8 of its joints' coordinates.
///
/// The results go into a new folder: index.html, rig.toml, run-a.csv, run-b.csv, truth.toml (the scenario with its
/// effects) and record.json. Noise follows from the scenario's `seed`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// Scenario file (TOML), such as a rig; without one, the built-in scenario
    #[arg(value_name = "SCENARIO")]
    file: Option<PathBuf>,
    #[command(flatten)]
    sets: Sets,
    /// Length in s of each recording
    #[arg(long, value_name = "S", default_value_t = 3.0)]
    duration: f64,
    /// Rows a second
    #[arg(long, value_name = "HZ", default_value_t = 1000.0)]
    rate: f64,
    /// Go on although it may take more than 10 min or write more than 1 GB, as judged by the first half second;
    /// without this nothing is recorded then
    #[arg(long)]
    yes: bool,
    #[command(flatten)]
    folder: FolderOptions,
    #[command(flatten)]
    print: PrintOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay record rig.toml --out synthetic   noise and rattle, nothing hidden
  freeplay record rig.toml --out worn --set effect.0.kind=joint-wear \\
      --set effect.0.joint=A1 \\
    --set effect.0.clearance_m=1.2e-4                      0.02 mm of wear in A1
  freeplay calibrate --rig worn/rig.toml --data worn/run-a.csv \\
      --validate worn/run-b.csv
  freeplay record rig.toml --set seed=2 --json --quiet | jq .shows_floors";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let rows = RowCount { rate: arguments.rate, duration: arguments.duration };
    for (flag, value) in [("rate", rows.rate), ("duration", rows.duration)] {
        if !(value.is_finite() && value > 0.0) {
            let message = format!("--{flag}: is {value}; expected a number above 0");
            return Err(Failure::Input(vec![message]));
        }
    }
    let mut sets = arguments.sets.all();
    if sets.iter().any(|set| set.split('=').next().map(str::trim) == Some("simulation.duration")) {
        let message =
            "--set simulation.duration: is not how long recordings are; give --duration instead";
        return Err(Failure::Input(vec![message.to_owned()]));
    }
    // What is looked at beforehand is the motion up to the recordings' end.
    sets.push(format!("simulation.duration={:?}", rows.duration));
    let scenario = Scenario::load(arguments.file.as_deref(), &sets)?;
    refuse_short(rows)?;
    let mut machine = assemble(&scenario)?;
    refuse_errors(findings(&scenario, &mut machine))?;
    let prepared = prepare(&scenario, &machine, rows)?;
    let folder = arguments.folder.prepare("record", &scenario.name, RECORD_FILE)?;
    if !arguments.yes {
        let forecast = prepared.forecast()?;
        if forecast.is_too_much() {
            let message = format!(
                "recording may {forecast}, judged by its first half second; say --yes if that is meant, or give a \
                 smaller --duration or --rate, or a larger simulation.tolerance"
            );
            return Err(Failure::Input(vec![message]));
        }
    }
    let done = Spinner::during(arguments.print.quiet, |tell| into_folder(&prepared, folder, tell))?;
    Ok(arguments.print.result(&done.json, || text(&done))?)
}

/// Recordings that no calibration would take are not made.
fn refuse_short(rows: RowCount) -> Result<(), Failure> {
    let mut wrong = Vec::new();
    if rows.duration < SHORTEST {
        wrong.push(format!(
            "--duration: is {} s; expected at least {SHORTEST} s, the least that calibrate takes",
            rows.duration
        ));
    }
    if rows.rate < LOWEST_RATE {
        wrong.push(format!(
            "--rate: is {} Hz; expected at least {LOWEST_RATE} Hz, the least that calibrate takes",
            rows.rate
        ));
    }
    if wrong.is_empty() { Ok(()) } else { Err(Failure::Input(wrong)) }
}

/// The result for people.
fn text(done: &FinishedRecordings) -> String {
    let recorded = &done.recorded;
    let rows = recorded.errors.iter().map(|e| {
        let [before, after, floor] =
            [e.before, e.after, e.floor].map(|value| quantity(value, e.unit));
        [e.run.clone(), e.channel.clone(), before, after, floor]
    });
    let heads = ["run", "channel", "as declared", "as it is", "floor"];
    let rows = table("llrrr", heads, rows);
    let folder = done.folder.display();
    let file = |name: &str| done.folder.join(name).display().to_string();
    let [a, b] = [0, 1].map(|i| file(&recorded.runs[i]));
    format!(
        "{}\n{rows}\nWritten to {folder}; open {}\nNow: freeplay calibrate --rig {} --data {a} --validate {b}\n",
        paragraph("", "", &recorded.verdict()),
        file("index.html"),
        file(RIG_FILE),
    )
}
