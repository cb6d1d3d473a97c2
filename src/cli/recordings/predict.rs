//! `freeplay predict`: hold a model against a recording.

use crate::calibrate::errors::ChannelError;
use crate::calibrate::predicted::ERRORS_FILE;
use crate::calibrate::quantity;
use crate::calibrate::sensed::predict::{into_folder, prepare};
use crate::calibrate::sensed::windows::predict::{self as windows, AskedWindows};
use crate::cli::shared::failure::{Failure, say_how_written, say_remarks, warn_of_doubts};
use crate::cli::shared::options::{FolderOptions, PrintOptions, Sets};
use crate::cli::shared::progress::Spinner;
use crate::cli::shared::table::{paragraph, table};
use crate::scenario::Scenario;
use crate::simulate::Provenance;
use clap::Args;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Drive a model by a recorded log's commands and report how far it is off
///
/// The model, declared or calibrated, is simulated along the commands of the log (q1_cmd q2_cmd q3_cmd);
/// errors are reported for whatever else was measured. Where joints rattle by more than sensors see,
/// the prediction is a mean over several simulations.
///
/// A drive stage is driven by the recorded reference, its own controller closing the loop. A machine that
/// nothing holds is predicted over windows, the start of each fitted to its first part. Recordings keep their
/// own columns and units: [columns] of a template or [[sensor]]s say which is which.
///
/// The results go into a new folder: index.html, predicted.csv (the log's rows and columns; what was not
/// measured is added) and errors.json.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// Scenario file (TOML), such as a rig or its calibrated.toml
    #[arg(value_name = "MODEL.toml")]
    model: PathBuf,
    /// Recorded run (CSV; t in s, q1_cmd… in m, and any of q1… in m, F1… in N, x y in m, phi in rad)
    #[arg(long, value_name = "RUN.csv")]
    data: PathBuf,
    /// Of a machine that nothing holds: length in s of the windows that are predicted, each from its own start
    #[arg(long, value_name = "S")]
    window: Option<f64>,
    /// First part in s of each window, which its start is fitted to
    #[arg(long, value_name = "S")]
    fit: Option<f64>,
    /// Where in s after the first row the first window begins
    #[arg(long, value_name = "S")]
    from: Option<f64>,
    #[command(flatten)]
    sets: Sets,
    #[command(flatten)]
    folder: FolderOptions,
    #[command(flatten)]
    print: PrintOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay predict rig.toml --data run-b.csv                  the declared model
  freeplay predict calibrated.toml --data run-c.csv   the calibrated one
  freeplay predict rig.toml --data run-b.csv --set joints.clearance=2e-4
  freeplay predict assets/pendulum-calibrated.toml --data swings.csv
  freeplay predict rig.toml --data run-b.csv --json --quiet | jq .errors";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let model = Scenario::load(Some(&arguments.model), &arguments.sets.all())?;
    warn_of_doubts(&model);
    say_how_written([arguments.data.as_path()]);
    let asked = AskedWindows { window: arguments.window, fit: arguments.fit, from: arguments.from };
    if let Some(prepared) = windows::prepare(&model, &arguments.data, asked)? {
        say_remarks(prepared.remarks());
        return by_windows(arguments, &model, &prepared);
    }
    refuse_windows(arguments)?;
    let prepared = prepare(&model, &arguments.data)?;
    say_remarks(prepared.remarks());
    let folder = arguments.folder.prepare("predict", &model.name, ERRORS_FILE)?;
    let predicted =
        Spinner::during(arguments.print.quiet, |tell| into_folder(&prepared, folder, tell))?;
    let p = &predicted.prediction;
    Ok(arguments.print.result(&predicted.json, || {
        text(&p.provenance, &p.run, &p.effects, &p.errors, &predicted.folder)
    })?)
}

/// Windows belong to machines that nothing holds.
fn refuse_windows(arguments: &Arguments) -> Result<(), Failure> {
    for (flag, given) in
        [("window", arguments.window), ("fit", arguments.fit), ("from", arguments.from)]
    {
        if given.is_some() {
            let message = format!(
                "--{flag}: this machine is predicted from its first row on, not over windows; leave it out"
            );
            return Err(Failure::Input(vec![message]));
        }
    }
    Ok(())
}

/// A machine that nothing holds, predicted over windows.
fn by_windows(
    arguments: &Arguments,
    model: &Scenario,
    prepared: &windows::PreparedWindows,
) -> Result<(), Failure> {
    let folder = arguments.folder.prepare("predict", &model.name, ERRORS_FILE)?;
    let predicted = Spinner::during(arguments.print.quiet, |tell| {
        windows::into_folder(model, prepared, folder, tell)
    })?;
    let p = &predicted.prediction;
    Ok(arguments.print.result(&predicted.json, || {
        let mut text = String::new();
        for of in &p.windows {
            let horizon = of.horizon;
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{} windows of {} s from {} s on, starts fitted to the first {} s:",
                of.windows, horizon.window_s, horizon.from_s, horizon.fit_s
            );
            text += &errors_table(&of.errors);
        }
        let page = predicted.folder.join("index.html");
        let name = &p.provenance.scenario_name;
        format!(
            "{name} along {}\n\n{text}\nWritten to {}; open {}\n",
            p.run,
            predicted.folder.display(),
            page.display()
        )
    })?)
}

/// The result for people.
fn text(
    model: &Provenance,
    run: &str,
    effects: &[String],
    errors: &[ChannelError],
    folder: &Path,
) -> String {
    let effects = if effects.is_empty() { "none".to_owned() } else { effects.join(", ") };
    let name = &model.scenario_name;
    let head = paragraph("", "", &format!("{name} along {run}; effects: {effects}"));
    let found = match errors {
        [] => "Nothing was measured to compare with: what the machine would do is written.\n"
            .to_owned(),
        _ => errors_table(errors),
    };
    let mut text = format!("{head}\n{found}");
    let page = folder.join("index.html");
    // Writing to a string cannot fail.
    let _ = writeln!(text, "\nWritten to {}; open {}", folder.display(), page.display());
    text
}

/// What a model misses, column by column.
fn errors_table(errors: &[ChannelError]) -> String {
    let rows = errors.iter().map(|e| {
        let [before, after, floor] = [e.before, e.after, e.floor].map(|v| quantity(v, e.unit));
        [e.channel.clone(), before, after, floor]
    });
    table("lrrr", ["channel", "without effects", "predicted", "floor"], rows)
}
