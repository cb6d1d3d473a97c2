//! A rig, its present motion, what is asked, and within which limits: everything that can be wrong is said here.

use super::motions::limits::{self, DriveLimits, GAIN, GivenLimits};
use super::motions::path::held;
use super::motions::search::SearchEffort;
use super::questions::asked::{Question, between, detect, left_open};
use crate::calibrate::record::{RecordingSetup, like};
use crate::calibrate::results::result::{CalibrateError, control, refuse};
use crate::calibrate::sensed::prepare::{CalibratedAs, against_rig};
use crate::calibrate::sensed::recording::Recording;
use crate::calibrate::sensed::start::{commands, machine};
use crate::engine::StepControl;
use crate::measure::bounded;
use crate::mechanism::{BodyState, Command, Drive, Mechanism};
use crate::scenario::{self, Law, Scenario};
use std::path::{Path, PathBuf};

/// Rows a second and length in s of a motion where no recording says: those of `record`.
const RATE: f64 = 1000.0;
const DURATION: f64 = 3.0;

/// Longest motion in s: a search of it takes a quarter of an hour.
const LONGEST: f64 = 30.0;

/// What a user asks for, as texts.
///
/// [`prepare`](prepare()) has an example.
#[derive(Clone, Debug, Default)]
pub struct PlanRequest {
    /// Present recordings.
    pub data: Vec<PathBuf>,
    /// Effects to be told apart, with commas between them.
    pub between: Vec<String>,
    /// Effects to be seen.
    pub detect: Vec<String>,
    /// A report of a calibration that left something open.
    pub report: Option<PathBuf>,
    /// Length of the motion in s.
    pub duration: Option<f64>,
    /// `[JOINT=]LOW..HIGH`.
    pub stroke: Vec<String>,
    /// `[JOINT=]NUMBER`.
    pub speed: Vec<String>,
    /// See there.
    pub acceleration: Vec<String>,
    /// See there.
    pub force: Vec<String>,
    /// Largest gain from a drive's error to the machine's fastest point.
    pub gain: Option<f64>,
    /// Motions that are tried.
    pub candidates: usize,
    /// Seed of the search.
    pub seed: u64,
}

/// What nothing speaks against.
#[derive(Debug)]
pub struct PreparedPlan {
    /// The rig as its file has it.
    pub rig: Scenario,
    /// The same, body by body.
    pub(super) described: Scenario,
    /// The machine as declared.
    pub(super) declared: Mechanism,
    pub(super) control: StepControl,
    /// The present motion, if there is one.
    pub(super) present: Option<Recording>,
    pub(super) questions: Vec<Question>,
    pub(super) limits: Vec<DriveLimits>,
    pub(super) gain: f64,
    pub(super) sign: f64,
    /// Coordinates in m or rad where motions are made about.
    pub(super) home: Vec<f64>,
    /// Time in s between two rows, and rows.
    pub(super) interval: f64,
    pub(super) samples: usize,
    pub(super) effort: SearchEffort,
    pub(super) seed: u64,
}

/// Makes sure that a motion can be planned.
///
/// ```
/// use freeplay::calibrate::plan::{PlanRequest, prepare};
/// use freeplay::scenario::Scenario;
/// use std::path::Path;
///
/// let folder = Path::new("assets/rigs-planar/planar-1");
/// let rig = Scenario::load(Some(&folder.join("rig.toml")), &[])?;
/// let (data, detect) = (vec![folder.join("run-a.csv")], vec!["payload".to_owned()]);
/// let request = PlanRequest { data, detect, candidates: 100, seed: 1, ..PlanRequest::default() };
/// assert!(prepare(rig.clone(), &request).is_ok());
/// let nothing = PlanRequest { detect: Vec::new(), ..request };
/// assert!(prepare(rig, &nothing).is_err(), "a motion shows something");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Everything that is wrong with the rig, its recordings, what is asked, and the limits.
pub fn prepare(rig: Scenario, request: &PlanRequest) -> Result<PreparedPlan, CalibrateError> {
    let described = crate::model::expand(&rig)?;
    let declared: Mechanism = crate::model::parts_of(&described)?;
    let way = CalibratedAs::of(&declared);
    refuse(against_rig(&described, &declared, way, 1))?;
    refuse(not_driven(&rig, &declared, way).into_iter().collect())?;
    refuse(without_noise(&rig, &declared).into_iter().collect())?;
    let paths: Vec<&Path> = request.data.iter().map(PathBuf::as_path).collect();
    let recordings = match paths.is_empty() {
        true => own_motion(&described)?.into_iter().collect(),
        false => crate::calibrate::sensed::prepare(described.clone(), &paths, 1)?.recordings,
    };
    let questions = questions(request, &declared)?;
    let given = given(request, &declared).map_err(CalibrateError::Input)?;
    let limits = limits::limits(&described, &declared, &given, &recordings);
    let limits = limits.map_err(CalibrateError::Input)?;
    let interval = recordings.first().map_or(1.0 / RATE, |recording| recording.interval);
    let duration = match request.duration {
        Some(duration) => duration,
        None => recordings.first().map_or(DURATION, Recording::duration).min(LONGEST),
    };
    let shortest = crate::calibrate::sensed::thresholds::SHORTEST;
    if !(shortest..=LONGEST).contains(&duration) {
        let message =
            format!("--duration: is {duration} s; expected from {shortest} to {LONGEST} s");
        return Err(CalibrateError::Input(vec![message]));
    }
    let samples = (duration / interval).round() as usize + 1;
    let home = home(&declared, &limits, recordings.first());
    let (sign, gain) = at_home(&described, recordings.first())?;
    let gain = request.gain.unwrap_or_else(|| GAIN.max(1.2 * gain));
    if !(gain.is_finite() && gain >= 1.0) {
        let message = format!("--gain: is {gain}; expected a number from 1 up");
        return Err(CalibrateError::Input(vec![message]));
    }
    let control = directly(control(&described));
    let effort = SearchEffort::of(request.candidates);
    let (present, seed) = (recordings.into_iter().next(), request.seed);
    Ok(PreparedPlan {
        rig,
        described,
        declared,
        control,
        present,
        questions,
        limits,
        gain,
        sign,
        home,
        interval,
        samples,
        effort,
        seed,
    })
}

/// The same tolerance without the physics engine: the same hits (docs/method.md), two to four times as fast, and a search
/// is a thousand simulations.
fn directly(control: StepControl) -> StepControl {
    match control {
        StepControl::Tolerance(tolerance) => StepControl::Direct(tolerance),
        other => other,
    }
}

/// Why no motion of commands moves a machine.
fn not_driven(rig: &Scenario, declared: &Mechanism, way: CalibratedAs) -> Option<String> {
    let forced = |drive: &&crate::mechanism::Actuator| drive.drive == Drive::Effort;
    if rig.contact.law == Law::Native {
        let help = "write law = \"hertz-step\": residuals are simulated with a contact law whose error is known";
        return Some(rig.problem("contact.law", "is \"native\"", help).to_string());
    }
    let (key, message) = if declared.actuators.is_empty() {
        (
            "drive",
            "is missing: nothing drives this machine, so that there is no motion to plan"
                .to_owned(),
        )
    } else if let Some(drive) = declared.actuators.iter().find(forced) {
        (
            "drive",
            format!(
                "{}: takes a force over time, and plan makes motions that drives follow",
                drive.name
            ),
        )
    } else if way != CalibratedAs::Residuals {
        let message = "has a sampled controller and no clearance: such a machine is calibrated by what its controllers \
                       ask for, and plan looks at residuals";
        ("drive", message.to_owned())
    } else {
        return None;
    };
    let help = "a drive of kind \"servo\" or \"prescribed\" follows a planned motion";
    Some(rig.problem(key, message, help).to_string())
}

/// Which sensors a machine is not to be planned with, because anything would show in what has no noise.
fn without_noise(rig: &Scenario, declared: &Mechanism) -> Option<String> {
    let exact = |sensor: &&crate::mechanism::Sensor| {
        !sensor.tells() && sensor.std == 0.0 && sensor.resolution == 0.0
    };
    let exact: Vec<&str> =
        declared.sensors.iter().filter(exact).map(|sensor| sensor.column.as_str()).collect();
    if exact.is_empty() {
        return None;
    }
    let message = format!(
        "{}: has neither noise nor resolution, so that anything would show",
        exact.join(", ")
    );
    let help = match rig.mechanism {
        scenario::Mechanism::Described(_) => "write the std of its [[sensor]], or its resolution",
        scenario::Mechanism::ThreeRpr(_) => "write its noise in [sensors], or its resolution",
        _ => {
            "`freeplay expand FILE` writes this machine with its [[sensor]]s: declare the std of each, or its resolution"
        }
    };
    Some(rig.problem("sensor", &message, help).to_string())
}

/// The motion of a rig's own file as a recording of its commands; none where it only holds still.
fn own_motion(rig: &Scenario) -> Result<Option<Recording>, CalibrateError> {
    if rig.motion == scenario::Motion::Rest {
        return Ok(None);
    }
    let mechanism = crate::model::assemble(rig)?.mechanism;
    let made = RecordingSetup {
        name: "the rig's own motion",
        interval: 1.0 / RATE,
        duration: DURATION,
        pace: 1.0,
    };
    Ok(Some(like(&mechanism, made)))
}

fn questions(request: &PlanRequest, declared: &Mechanism) -> Result<Vec<Question>, CalibrateError> {
    let (mut found, mut wrong) = (Vec::new(), Vec::new());
    let mut add = |asked: Result<Vec<Question>, String>| match asked {
        Ok(asked) => {
            for one in asked {
                if !found.contains(&one) {
                    found.push(one);
                }
            }
        }
        Err(message) => wrong.push(message),
    };
    request.between.iter().for_each(|text| add(between(text, declared)));
    request.detect.iter().for_each(|text| add(detect(text, declared)));
    if let Some(path) = &request.report {
        let shown = path.display().to_string();
        let text =
            bounded::text(path, bounded::REPORT).map_err(|error| format!("{shown}: {error}"));
        add(text.and_then(|text| left_open(&text, &shown, declared)));
    }
    refuse(wrong)?;
    if found.is_empty() {
        let message = "nothing is asked: give --report report.json of a calibration that left something open, \
                       --between EFFECT,EFFECT, or --detect EFFECT";
        return Err(CalibrateError::Input(vec![message.to_owned()]));
    }
    Ok(found)
}

/// Sets a limit of one drive to what a text says.
type Set = fn(&mut GivenLimits, &str) -> Option<()>;

/// Limits as flags give them, drive by drive.
fn given(request: &PlanRequest, declared: &Mechanism) -> Result<Vec<GivenLimits>, Vec<String>> {
    let names: Vec<&str> =
        declared.actuators.iter().map(|drive| declared.joint_name(drive.joint)).collect();
    let mut given = vec![GivenLimits::default(); names.len()];
    let mut wrong = Vec::new();
    let stroke: Set = |given, text| {
        let (low, high) = text.split_once("..")?;
        given.stroke = Some([number(low)?, number(high)?]);
        Some(())
    };
    let flags: [(&str, &[String], &str, Set); 4] = [
        ("stroke", &request.stroke, "LOW..HIGH", stroke),
        ("speed", &request.speed, "a number", |given, text| {
            given.speed = Some(number(text)?);
            Some(())
        }),
        ("acceleration", &request.acceleration, "a number", |given, text| {
            given.acceleration = Some(number(text)?);
            Some(())
        }),
        ("drive-force", &request.force, "a number", |given, text| {
            given.force = Some(number(text)?);
            Some(())
        }),
    ];
    for (flag, texts, expected, set) in flags {
        for text in texts {
            let (joint, value) = match text.split_once('=') {
                Some((joint, value)) => (Some(joint.trim()), value),
                None => (None, text.as_str()),
            };
            let of = |place: &usize| joint.is_none_or(|joint| names[*place] == joint);
            let places: Vec<usize> = (0..names.len()).filter(of).collect();
            if places.is_empty() {
                wrong.push(format!(
                    "--{flag} {text}: no such drive; this machine drives {}",
                    names.join(", ")
                ));
            }
            for place in places {
                if set(&mut given[place], value.trim()).is_none() {
                    wrong.push(format!(
                        "--{flag} {text}: expected {expected} in SI units, or JOINT={expected}"
                    ));
                    break;
                }
            }
        }
    }
    if wrong.is_empty() { Ok(given) } else { Err(wrong) }
}

fn number(text: &str) -> Option<f64> {
    text.trim().parse::<f64>().ok().filter(|number| number.is_finite())
}

/// Where motions are made about: where the present one begins, else where the file puts the machine, within strokes.
fn home(declared: &Mechanism, limits: &[DriveLimits], present: Option<&Recording>) -> Vec<f64> {
    let mut first: Vec<Command> = vec![Command::default(); declared.actuators.len()];
    if let Some(present) = present {
        commands(declared, present).at(0.0, &mut first);
    }
    let drives = declared.actuators.iter().zip(limits).zip(first);
    drives
        .map(|((drive, limit), first)| {
            let own = match present {
                Some(_) => first.position,
                None => declared.start_coordinate(drive.joint),
            };
            own.clamp(limit.stroke[0], limit.stroke[1])
        })
        .collect()
}

/// Sign and gain of the machine where its present motion begins, or where its file puts it.
fn at_home(rig: &Scenario, present: Option<&Recording>) -> Result<(f64, f64), CalibrateError> {
    let mechanism = match present {
        Some(present) => machine(rig, &[], present)?,
        None => crate::model::assemble(rig)?.mechanism,
    };
    let ideal = mechanism.without_clearance();
    let states: Vec<BodyState> = ideal.bodies.iter().map(|body| body.start).collect();
    // Where joints say the same twice nothing is known of singular poses.
    Ok(held(&ideal, &states).unwrap_or((1.0, 1.0)))
}
