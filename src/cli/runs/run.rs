//! `freeplay run`: simulate a scenario.

use crate::cli::shared::failure::{Failure, refuse_errors, refuse_faults, warn_of_seed};
use crate::cli::shared::options::{FolderOptions, PrintOptions, ScenarioOptions};
use crate::cli::shared::output;
use crate::cli::shared::progress::Progress;
use crate::cli::shared::signals;
use crate::cli::shared::table::paragraph;
use crate::report::{length, number};
use crate::results::RunError;
use crate::scenario::Motion;
use crate::simulate::unacting;
use crate::simulate::{Summary, assemble, findings};
use crate::study::chaos::chaotic;
use crate::study::{self, RunOutcome, SUMMARY_FILE, Terms};
use clap::Args;
use std::fmt::Write as _;

/// Simulate a scenario and write time series, summary, pictures and a page
///
/// The results go into a new folder: index.html (look at this first), player.html (the machine and
/// its joints in slow motion), animation.svg (the first 0.15 s of that as a picture), timeseries.csv (one row each
/// simulation.output_interval: pose, velocity, acceleration, actuator lengths and forces, and for
/// each joint the eccentricity in m and the contact force in N), summary.json (the main figures),
/// scenario.toml (the scenario with every default filled in: `freeplay run` on it repeats the run),
/// wear.csv (normal force times sliding distance in J round each ring, degree by degree) and pictures
/// (SVG).
///
/// Ctrl-C and SIGTERM end a run early: what was computed is kept, and summary.json says
/// `"interrupted": true`.
///
/// Peaks, means and fractions leave out the first simulation.settle seconds, in which the journals,
/// centred at the start, find their rings.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    #[command(flatten)]
    scenario: ScenarioOptions,
    /// Go on although the run will take more than 10 min or write more than 1 GB, as judged by its
    /// beginning; without this it ends there, with exit code 2
    #[arg(long)]
    yes: bool,
    #[command(flatten)]
    folder: FolderOptions,
    #[command(flatten)]
    print: PrintOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay run   the built-in machine for 1 s
  freeplay run --duration 5 --out long               5 s, into ./long
  freeplay run my-machine.toml --set joints.clearance=1e-4
  freeplay run --set contact.law=ideal   the same machine without clearance
  freeplay run --set drive.mode=servo --set 'environment.gravity=[0,-9.81]'
  freeplay run --set motion.kind=line --set 'motion.velocity=[0.05,0]'
  freeplay run --json --quiet | jq .peak_contact_force_N";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let scenario = arguments.scenario.load()?;
    warn_of_seed(&scenario);
    let mut machine = assemble(&scenario)?;
    let mut found = findings(&scenario, &mut machine);
    found.extend(unacting(&scenario, &machine));
    refuse_errors(found)?;
    let folder = arguments.folder.prepare("run", &scenario.name, SUMMARY_FILE)?;

    let mut progress = Progress::new(scenario.simulation.duration, arguments.print.quiet);
    let terms = Terms { stop: signals::looked_at(), at_any_cost: arguments.yes };
    let outcome = study::run(&scenario, &mut machine, folder, terms, &mut |_, instant| {
        progress.reached(instant.t);
    });
    progress.clear();
    let outcome = match outcome {
        Err(dropped @ RunError::Dropped) => {
            output::complain(&dropped.to_string());
            return Err(signals::interrupted());
        }
        outcome => outcome?,
    };
    // The file as it is written has [motion] where the machine follows one.
    let has_phase = scenario.to_toml().lines().any(|line| line.starts_with("phase = "))
        && matches!(scenario.motion, Motion::Circle(_));
    arguments.print.result(&outcome.json, || text(&outcome, has_phase))?;
    let summary = &outcome.recorded.summary;
    let watched = &summary.watched;
    for doubt in &watched.doubts {
        output::complain(&format!("warning: {doubt}"));
    }
    match summary.halted.clone() {
        None if summary.interrupted => Err(signals::interrupted()),
        None => refuse_faults(&watched.faults),
        Some(reason) => Err(Failure::Other(reason)),
    }
}

/// The result for people; `has_phase` says whether the motion is one that can begin elsewhere.
fn text(outcome: &RunOutcome, has_phase: bool) -> String {
    let s = &outcome.recorded.summary;
    let mut text = format!(
        "{}: {} s simulated in {} s, {} steps\n\n",
        s.provenance.scenario_name,
        number(s.simulated_s),
        number(s.wall_s),
        s.steps
    );
    if s.interrupted {
        let (reached, asked) = (number(s.simulated_s), number(outcome.duration));
        let _ = writeln!(text, "  interrupted at {reached} of {asked} s\n");
    }
    if !s.has_figures() {
        let _ = writeln!(text, "  no figures: the run ended within the first {} s", s.settle_s);
    }
    for (label, value, note) in figures(s) {
        // Writing to a string cannot fail, here and below.
        let line = format!("  {label:<28}{value:>12}   {note}");
        let _ = writeln!(text, "{}", line.trim_end());
    }
    if s.has_figures() && s.settle_s > 0.0 {
        let _ = writeln!(text, "\n  (the first {} s left out)", number(s.settle_s));
    }
    if s.lyapunov_exponent_1_s.is_some_and(|rate| chaotic(rate, s.simulated_s)) {
        text += &format!("\n{}", paragraph("  ", "  ", &one_draw(has_phase)));
    }
    let folder = outcome.folder.display();
    let page = outcome.folder.join("index.html");
    let _ = writeln!(text, "\nWritten to {folder}; open {}", page.display());
    text
}

/// What the peaks of a chaotic run are worth.
fn one_draw(has_phase: bool) -> String {
    let sweep = if has_phase { "`freeplay sweep` over motion.phase and " } else { "" };
    let take = if has_phase { "take" } else { "takes" };
    format!(
        "(chaotic: peaks and counts are one draw; {sweep}`freeplay diff` of scenario files {take} means over starts)"
    )
}

fn figures(s: &Summary) -> Vec<(&'static str, String, String)> {
    if !s.has_figures() {
        return Vec::new();
    }
    let newton = |value: f64| format!("{} N", number(value));
    let acceleration = |value: f64| format!("{} m/s²", number(value));
    let mut figures = vec![
        ("peak contact force", newton(s.peak_contact_force), String::new()),
        (
            "peak acceleration",
            acceleration(s.peak_platform_acceleration_m_s2),
            format!("ideal: {}", acceleration(s.ideal_peak_platform_acceleration_m_s2)),
        ),
    ];
    figures.extend(s.drive_peaks().into_iter().map(|(peak, ideal, unit)| {
        let label = if unit == "N" { "peak actuator force" } else { "peak actuator torque" };
        (label, format!("{} {unit}", number(peak)), format!("ideal: {} {unit}", number(ideal)))
    }));
    figures.push((
        "largest path error",
        length(s.max_path_error_m),
        format!("rms: {}", length(s.rms_path_error_m)),
    ));
    if !s.without_play() {
        let fraction = format!("{} %", number(100.0 * s.contact_fraction));
        figures.extend([
            ("time in contact", fraction, "mean of all joints".to_owned()),
            ("impacts", s.impacts.to_string(), format!("{} per s", number(s.impacts_per_s))),
        ]);
    }
    figures
}
