//! What is surely wrong with a rig and its logs, each with where it stands and what would be right.
//! Nothing is repaired: a unit that was guessed silently would be a calibration of something else.
//!
//! Undeclared effects move lengths by millimetres and forces by a multiple; a wrong unit moves them by
//! a factor of 1000, and a wrong rig by centimetres. The limits lie between.

mod forces;
mod geometry;

pub use forces::{forces, mixed_up};
pub use geometry::start_pose;

use super::measured::recording::LegsRecording;
use super::sensed::thresholds::LOWEST_RATE;
use crate::measure::log::{Channel, Log, LogError};
use crate::scenario::{Law, Mechanism, Problem, Scenario};
use geometry::geometry;

/// What a command needs of a log.
#[derive(Clone, Copy, Debug)]
pub struct Need {
    /// Name of the command, for messages.
    pub command: &'static str,
    /// Whether lengths, forces and pose have to be there beside the commands.
    pub measured: bool,
    /// Lowest rate of sampling in Hz.
    pub rate: f64,
    /// Why so much.
    pub because: &'static str,
}

/// `calibrate`: its highest residuals reach up to 150 Hz, and a rate of twice that shows them.
pub const CALIBRATE: Need = Need {
    command: "calibrate",
    measured: true,
    rate: 300.0,
    because: "it looks at residuals up to 150 Hz",
};

/// `calibrate` of recordings that lack some of what was measured, with the sensors that they have.
pub const SENSED: Need = Need {
    command: "calibrate",
    measured: false,
    rate: LOWEST_RATE,
    because: "it looks at residuals up to 90 Hz",
};

/// `predict`: errors are looked at through a low-pass of 25 Hz; four samples a period.
pub const PREDICT: Need = Need {
    command: "predict",
    measured: false,
    rate: 100.0,
    because: "errors are looked at through a low-pass of 25 Hz",
};

/// Shortest log in s: shorter ones hold less than a machine's motion.
const SHORTEST: f64 = 1.0;

/// Change of a command in m below which a measured column may stand still: far above any encoder's
/// step.
const MOVES: f64 = 1e-4;

/// Whether a recording has every column that the machine has instruments for.
pub fn is_complete(recording: &LegsRecording) -> bool {
    Channel::all(3).into_iter().all(|channel| recording.log.get(channel).is_some())
}

/// What keeps recordings that are not complete from being calibrated with what they have.
pub fn incomplete(scenario: &Scenario, recordings: &[LegsRecording]) -> Vec<String> {
    let mut found: Vec<String> = rig(scenario).iter().map(Problem::to_string).collect();
    for one in recordings {
        found.extend(recording(scenario, one, SENSED).iter().map(LogError::to_string));
    }
    found
}

/// Complains about a machine other than a 3-RPR whose file does not say what recordings of it hold.
pub fn without_sensors(rig: &Scenario) -> Problem {
    let message = "is missing: nobody knows what the columns of a recording are";
    let help = "add a [[sensor]] for each column (a drive stage or a pendulum with a kind takes [columns], too); \
                `freeplay init four-bar --rig` prints a rig that has them";
    rig.problem("sensor", message, help)
}

/// What keeps a rig from being calibrated.
pub fn rig(rig: &Scenario) -> Vec<Problem> {
    if !matches!(rig.mechanism, Mechanism::ThreeRpr(_)) {
        return vec![without_sensors(rig)];
    }
    let mut found = Vec::new();
    let mut complain = |path: &str, message: String, help: &str| {
        found.push(rig.problem(path, message, help));
    };
    if !rig.effects.is_empty() {
        let message = format!("holds {} effect(s)", rig.effects.len());
        let help = "calibrate starts from what a rig's maker declares: give it the rig without \
                    [[effect]] (`freeplay predict` judges a model with effects)";
        complain("effect", message, help);
    }
    if rig.contact.law == Law::Native {
        let help = "write law = \"hertz-step\": calibrate needs a contact law whose error is known";
        complain("contact.law", "is \"native\"".to_owned(), help);
    }
    let Some(sensors) = &rig.sensors else {
        let message = "is missing: without it pose, angle and forces count as exact (0 m, 0 rad, 0 N) and \
             lengths as not rounded, so that every instrument's noise would be taken for an effect";
        let help = "write [sensors] with pose_std, angle_std, force_std, length_resolution and \
                    force_lowpass, as in assets/rigs/rig-1/rig.toml";
        complain("sensors", message.to_owned(), help);
        return found;
    };
    let deviations = [
        ("pose_std", sensors.pose_std, "m"),
        ("angle_std", sensors.angle_std, "rad"),
        ("force_std", sensors.force_std, "N"),
    ];
    for (key, value, unit) in deviations {
        if value <= 0.0 {
            let help = format!(
                "write the instrument's standard deviation in {unit}: residuals are measured in it"
            );
            complain(&format!("sensors.{key}"), format!("is {value} {unit}, exact"), &help);
        }
    }
    found
}

/// What is wrong with a log, by itself and beside the rig that it should be of.
pub fn recording(rig: &Scenario, recording: &LegsRecording, need: Need) -> Vec<LogError> {
    let log = &recording.log;
    let wrong =
        |message: String, help: String| LogError { place: recording.path.clone(), message, help };
    if let Some(error) = missing(recording, need) {
        return vec![error];
    }
    let rate = 1.0 / log.interval;
    if rate < need.rate * 0.999 {
        let message = format!("rows are {:.4} s apart, {rate:.4} a second", log.interval);
        let help = format!(
            "{} needs at least {} a second, because {}; if column `t` is in ms, write it in s",
            need.command, need.rate, need.because
        );
        return vec![wrong(message, help)];
    }
    if log.duration() < SHORTEST {
        let message = format!("lasts {:.4} s", log.duration());
        return vec![wrong(message, format!("expected at least {SHORTEST} s of motion"))];
    }
    let mut found: Vec<LogError> = still(log)
        .into_iter()
        .map(|channel| {
            wrong(
                format!("column `{channel}` never changes while the commands do"),
                "is the sensor connected? leave out the columns that were not measured".to_owned(),
            )
        })
        .collect();
    if found.is_empty() {
        found = geometry(rig, log).into_iter().map(|(m, h)| wrong(m, h)).collect();
        found.extend(mixed_up(&recording.path, log, &rig.drive));
    }
    found
}

/// Columns that are not there, if any are needed.
fn missing(recording: &LegsRecording, need: Need) -> Option<LogError> {
    let needed = Channel::all(3).into_iter();
    let needed = needed.filter(|channel| need.measured || matches!(channel, Channel::Command(_)));
    let absent: Vec<String> = needed
        .filter(|channel| recording.log.get(*channel).is_none())
        .map(|channel| format!("`{channel}`"))
        .collect();
    let help = if need.measured {
        "calibrate needs the commands (q1_cmd q2_cmd q3_cmd, m), the lengths (q1 q2 q3, m), the \
         actuator forces (F1 F2 F3, N) and the pose (x y, m; phi, rad); `freeplay predict` takes logs \
         that lack measured columns"
    } else {
        "predict needs the commands q1_cmd q2_cmd q3_cmd (m); everything measured may be left out"
    };
    (!absent.is_empty()).then(|| LogError {
        place: format!("{}:1", recording.path),
        message: format!("no column {}", absent.join(", ")),
        help: help.to_owned(),
    })
}

/// Measured columns that stand still although a command moves.
fn still(log: &Log) -> Vec<Channel> {
    let range = |channel: Channel| {
        let values = log.get(channel).unwrap_or_default();
        let extremes = |f: fn(f64, f64) -> f64| values.iter().copied().reduce(f);
        extremes(f64::max).zip(extremes(f64::min)).map_or(0.0, |(high, low)| high - low)
    };
    let moves = |leg: usize| range(Channel::Command(leg)) > MOVES;
    let moved = |channel: Channel| match channel {
        Channel::Command(_) => false,
        Channel::Length(leg) => moves(leg),
        Channel::Force(_) | Channel::Pose(_) => (0..3).any(moves),
    };
    log.channels().filter(|channel| moved(*channel) && range(*channel) == 0.0).collect()
}

/// Logs that hold the same samples: a model judged on what it was fitted to is not judged.
pub fn twins(recordings: &[LegsRecording]) -> Vec<LogError> {
    let mut found = Vec::new();
    for (i, one) in recordings.iter().enumerate() {
        for other in &recordings[..i] {
            let same = one.log.samples == other.log.samples
                && one.log.channels().all(|channel| one.log.get(channel) == other.log.get(channel));
            if same {
                found.push(LogError {
                    place: one.path.clone(),
                    message: format!("holds the same samples as {}", other.path),
                    help: "validate on another run: on the one that was fitted nothing is proved"
                        .to_owned(),
                });
            }
        }
    }
    found
}
