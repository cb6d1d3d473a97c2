//! `freeplay plan`: what to record next.

use crate::calibrate::plan::{FinishedPlan, PLAN_FILE, PlanRequest, into_folder, prepare};
use crate::cli::shared::failure::{Failure, say_how_written, warn_of_doubts};
use crate::cli::shared::options::{FolderOptions, PrintOptions, Sets};
use crate::cli::shared::progress::Spinner;
use crate::cli::shared::table::{paragraph, table};
use crate::report::number;
use crate::scenario::Scenario;
use clap::Args;
use std::path::PathBuf;

/// Plan the motion that tells rivals apart, or shows an effect
///
/// A calibration may end with effects that explain its recordings as well as each other, and with detection limits. This
/// searches a motion within the machine's limits along which a calibration of its recordings would tell the rivals
/// apart, or name the effect: as many standard deviations of its residuals' noise (sensors and rattle) as can be had. By
/// how many, and which of the rig's sensors carries it, is said beside what the present motion gives; and which one more
/// sensor would help most.
///
/// EFFECT is a kind of `freeplay effects`, with what it acts on behind a colon: payload, anchor-offset:A1,
/// joint-friction:A+B. Limits of the drives are those that are given, else ranges that the file declares, else what the
/// present recordings (--data; without them the rig's own [motion]) go through.
///
/// The results go into a new folder: index.html (look at this first), motion.csv (a table motion: t, q_JOINT of each drive,
/// pose of the output body), planned.toml (the rig with it: run or record that), plan.json, pictures. It takes a minute or
/// two; the same seed gives the same motion.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// What its maker declares: a scenario file (TOML) with [sensors] or [[sensor]]s
    #[arg(long, value_name = "RIG.toml")]
    rig: PathBuf,
    /// Present recordings, as `calibrate` takes them; the first one's motion is what the planned one is compared with
    #[arg(long, value_name = "RUN.csv", num_args = 1..)]
    data: Vec<PathBuf>,
    /// Effects to be told apart, two or more; of the first a size may be given behind a = [default: twice what the present
    /// motion would just show]
    #[arg(long, value_name = "EFFECT[=SIZE],EFFECT")]
    between: Vec<String>,
    /// An effect to be seen; its first parameter's distance from what is declared behind a = [default: what the present
    /// motion would just show]
    #[arg(long, value_name = "EFFECT[=SIZE]")]
    detect: Vec<String>,
    /// The report.json of a calibration: plan for what it left open
    #[arg(long, value_name = "report.json")]
    report: Option<PathBuf>,
    /// Length of the motion in s [default: that of the first recording, else 3]
    #[arg(long, value_name = "S")]
    duration: Option<f64>,
    /// From where to where a drive may go, m or rad; of all drives where no joint is named
    #[arg(long, value_name = "[JOINT=]LOW..HIGH", allow_hyphen_values = true)]
    stroke: Vec<String>,
    /// Largest speed of a drive, m/s or rad/s
    #[arg(long, value_name = "[JOINT=]V", allow_hyphen_values = true)]
    speed: Vec<String>,
    /// Largest acceleration of a drive, m/s² or rad/s²
    #[arg(long, value_name = "[JOINT=]A", allow_hyphen_values = true)]
    acceleration: Vec<String>,
    /// Largest force or torque of a drive, N or N m
    #[arg(long, value_name = "[JOINT=]F", allow_hyphen_values = true)]
    drive_force: Vec<String>,
    /// Distance from singular poses: how many times as far as a drive's error the machine's fastest point may move
    /// [default: 50]
    #[arg(long, value_name = "GAIN", allow_hyphen_values = true)]
    gain: Option<f64>,
    /// Motions that are tried: more may be better, and take longer
    #[arg(long, value_name = "N", default_value_t = 240, value_parser = clap::value_parser!(u32).range(8..=100_000))]
    candidates: u32,
    /// Another search
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    sets: Sets,
    #[command(flatten)]
    folder: FolderOptions,
    #[command(flatten)]
    print: PrintOptions,
}

const EXAMPLES: &str = "\
Examples:
  freeplay plan --rig rig.toml --data run-a.csv --report calibrated/report.json
  freeplay plan --rig rig.toml --data run-a.csv \\
                --between payload:piston,joint-friction:slide
  freeplay plan --rig rig.toml --data run-a.csv --detect joint-wear
  freeplay plan --rig rig.toml --detect payload=0.02 \\
                --stroke O=-1..1 --speed O=10 --acceleration O=200
  freeplay record planned/planned.toml    what the sensors would show of it";

pub(in crate::cli) fn main(arguments: &Arguments) -> Result<(), Failure> {
    let rig = Scenario::load(Some(&arguments.rig), &arguments.sets.all())?;
    warn_of_doubts(&rig);
    say_how_written(arguments.data.iter().map(PathBuf::as_path));
    let request = PlanRequest {
        data: arguments.data.clone(),
        between: arguments.between.clone(),
        detect: arguments.detect.clone(),
        report: arguments.report.clone(),
        duration: arguments.duration,
        stroke: arguments.stroke.clone(),
        speed: arguments.speed.clone(),
        acceleration: arguments.acceleration.clone(),
        force: arguments.drive_force.clone(),
        gain: arguments.gain,
        candidates: arguments.candidates as usize,
        seed: arguments.seed,
    };
    let name = rig.name.clone();
    let prepared = prepare(rig, &request)?;
    let folder = arguments.folder.prepare("plan", &name, PLAN_FILE)?;
    let done = Spinner::during(arguments.print.quiet, |tell| into_folder(&prepared, folder, tell))?;
    Ok(arguments.print.result(&done.json, || text(&done))?)
}

/// The result for people.
fn text(done: &FinishedPlan) -> String {
    let planned = &done.planned;
    let rows = planned.questions.iter().map(|question| {
        let before = question.before.as_ref();
        let carried = question.after.carried_by.first();
        [
            question.question.clone(),
            before.map_or_else(|| "-".to_owned(), |answer| number(answer.sigma)),
            number(question.after.sigma),
            number(question.wanted_sigma),
            carried.map_or_else(String::new, |carried| carried.residual.clone()),
        ]
    });
    let heads = ["question", "present", "planned", "answers it", "carried by"];
    let questions = table("lrrrl", heads, rows);
    let sensors = planned.sensors.iter().take(5).map(|sensor| {
        let sigma: Vec<String> = sensor.sigma.iter().map(|sigma| number(*sigma)).collect();
        [sensor.sensor.clone(), sigma.join("; ")]
    });
    let sensors = match planned.sensors.is_empty() {
        true => String::new(),
        false => format!("\n{}", table("ll", ["one more sensor", "planned, with it"], sensors)),
    };
    let file = |name: &str| done.folder.join(name).display().to_string();
    let written = format!(
        "In standard deviations of the residuals' noise. Written to {}; open {}",
        done.folder.display(),
        file("index.html")
    );
    let next = format!("Now: follow {}, and calibrate what it shows", file("motion.csv"));
    let [summary, written, next] =
        [&planned.summary, &written, &next].map(|text| paragraph("", "", text));
    format!("{summary}\n{questions}{sensors}\n{written}{next}")
}
