//! What is surely wrong with a rig and its logs, each with where it stands and what would be right.
//! Nothing is repaired: a unit that was guessed silently would be a calibration of something else.
//!
//! Undeclared effects move lengths by millimetres and forces by a multiple; a wrong unit moves them by
//! a factor of 1000, and a wrong rig by centimetres. The limits lie between.

use super::recording::{Recording, triple};
use crate::measure::filter::ZeroPhase;
use crate::measure::log::{Channel, Log, LogError};
use crate::mechanism::three_rpr::Geometry;
use crate::scenario::{Drive, DriveMode, Law, Mechanism, Problem, Scenario};
use crate::simulate::assemble;
use nalgebra::Vector3;
use std::f64::consts::PI;

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

/// `predict`: errors are looked at through a low-pass of 25 Hz; four samples a period.
pub const PREDICT: Need = Need {
    command: "predict",
    measured: false,
    rate: 100.0,
    because: "errors are looked at through a low-pass of 25 Hz",
};

/// Shortest log in s: shorter ones hold less than a machine's motion.
const SHORTEST: f64 = 1.0;

/// Root mean square in m by which measured lengths may miss those of the measured pose, and their
/// commands: undeclared offsets and clearances are millimetres.
const MISFIT: f64 = 0.01;

/// Rows at which lengths and poses are held against each other.
const LOOKS: usize = 200;

/// Change of a command in m below which a measured column may stand still: far above any encoder's
/// step.
const MOVES: f64 = 1e-4;

/// Low-passed forces beyond these multiples of the declared model's are in another unit. Downwards
/// nothing physical leads so far; upwards friction might, so that the servo's own law has to agree.
const SMALL: f64 = 1.0 / 100.0;
const LARGE: f64 = 200.0;

/// So many times the force that the servo's law gives is no force in N: gains may be wrong, but not so.
const BEYOND_LAW: f64 = 30.0;

/// Corner of that low-pass in Hz: most of a rattle and of a sensor's noise lies above.
const CORNER: f64 = 25.0;

/// Factors that turn a wrong unit into the right one, with its name, for lengths in m and angles in rad.
const LENGTHS: [(f64, &str); 3] = [(1.0, "m"), (1e-3, "mm"), (1e3, "km")];
const ANGLES: [(f64, &str); 3] = [(1.0, "rad"), (1e-3, "mrad"), (PI / 180.0, "degrees")];

/// What keeps a rig from being calibrated.
pub fn rig(rig: &Scenario) -> Vec<Problem> {
    let mut found = Vec::new();
    let mut complain = |path: &str, message: String, help: &str| {
        found.push(rig.problem(path, message, help));
    };
    if !matches!(rig.mechanism, Mechanism::ThreeRpr(_)) {
        let help = "machines of one joint have a calibration of their own (calibrate::single)";
        complain("mechanism.kind", "is not \"3rpr\"".to_owned(), help);
    }
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
pub fn recording(rig: &Scenario, recording: &Recording, need: Need) -> Vec<LogError> {
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
    }
    found
}

/// Columns that are not there, if any are needed.
fn missing(recording: &Recording, need: Need) -> Option<LogError> {
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
        Channel::Added(_) => false,
    };
    log.channels().filter(|channel| moved(*channel) && range(*channel) == 0.0).collect()
}

/// Lengths and poses held against each other and against the rig, as (message, help).
fn geometry(rig: &Scenario, log: &Log) -> Vec<(String, String)> {
    let Mechanism::ThreeRpr(machine) = &rig.mechanism else { return Vec::new() };
    let geometry = Geometry { base_side: machine.base_side, platform_side: machine.platform_side };
    let Some(commands) = triple(log, Channel::Command) else { return Vec::new() };
    let lengths = triple(log, Channel::Length);
    let rows: Vec<usize> = (0..log.samples).step_by((log.samples / LOOKS).max(1)).collect();
    let mut found = Vec::new();
    // The column that poses are held against, and what it is called.
    let (base, name): (_, fn(usize) -> Channel) = match lengths {
        Some(lengths) => (lengths, Channel::Length),
        None => (commands, Channel::Command),
    };
    let mut scales = [1.0; 3];
    if let Some(pose) = triple(log, Channel::Pose) {
        let fit = fit(&geometry, &rows, base, pose);
        if fit.misfit > MISFIT {
            let message = format!(
                "columns `{}` and `x`, `y`, `phi` do not close: the length of leg {} misses the one of \
                 the measured pose by {:.3} m (rms)",
                name(fit.leg),
                fit.leg + 1,
                fit.misfit
            );
            let help = format!(
                "is this the rig of that log (base_side {} m, platform_side {} m), are columns \
                 exchanged?",
                machine.base_side, machine.platform_side
            );
            return vec![(message, help)];
        }
        for (leg, (factor, unit)) in fit.lengths.into_iter().enumerate() {
            scales[leg] = factor;
            if factor != 1.0 {
                found.push(unit_error(name(leg), base[leg], factor, unit));
            }
        }
        for (k, (factor, unit)) in fit.pose.into_iter().enumerate() {
            if factor != 1.0 {
                found.push(unit_error(Channel::Pose(k), pose[k], factor, unit));
            }
        }
    } else {
        found.extend(reachable(rig, &geometry, base, name));
        if !found.is_empty() {
            return found;
        }
    }
    if lengths.is_some() {
        for leg in 0..3 {
            let distance = |factor: f64| {
                let squares = rows.iter().map(|&row| {
                    (factor * commands[leg][row] - scales[leg] * base[leg][row]).powi(2)
                });
                (squares.sum::<f64>() / rows.len() as f64).sqrt()
            };
            if distance(1.0) <= MISFIT {
                continue;
            }
            let channel = Channel::Command(leg);
            found.push(match LENGTHS.into_iter().find(|(factor, _)| distance(*factor) <= MISFIT) {
                Some((factor, unit)) => unit_error(channel, commands[leg], factor, unit),
                None => (
                    format!(
                        "columns `{channel}` and `{}` differ by {:.3} m (rms)",
                        Channel::Length(leg),
                        distance(1.0)
                    ),
                    "a drive follows its command within millimetres: are columns exchanged?"
                        .to_owned(),
                ),
            });
        }
    }
    found
}

/// Units in which lengths and poses fit each other.
struct Fit {
    lengths: [(f64, &'static str); 3],
    pose: [(f64, &'static str); 3],
    /// Worst misfit of a leg, root mean square in m, and the leg.
    misfit: f64,
    leg: usize,
}

/// The units with the fewest surprises in which measured lengths are those of the measured poses; if
/// none are, the declared ones with their misfit.
fn fit(geometry: &Geometry, rows: &[usize], lengths: [&[f64]; 3], pose: [&[f64]; 3]) -> Fit {
    let wrong = |units: &[(f64, &str)]| units.iter().filter(|(factor, _)| *factor != 1.0).count();
    let mut best: Option<Fit> = None;
    let mut declared: Option<Fit> = None;
    for x in LENGTHS {
        for y in LENGTHS {
            for phi in ANGLES {
                let spans: Vec<[f64; 3]> = rows
                    .iter()
                    .map(|&row| {
                        let pose = Vector3::new(
                            x.0 * pose[0][row],
                            y.0 * pose[1][row],
                            phi.0 * pose[2][row],
                        );
                        [0, 1, 2].map(|leg| geometry.leg(pose, leg).norm())
                    })
                    .collect();
                let units = [0, 1, 2].map(|leg| {
                    let misfit = |factor: f64| {
                        let squares = rows
                            .iter()
                            .zip(&spans)
                            .map(|(&row, span)| (factor * lengths[leg][row] - span[leg]).powi(2));
                        (squares.sum::<f64>() / rows.len() as f64).sqrt()
                    };
                    let fits = LENGTHS.into_iter().find(|(f, _)| misfit(*f) <= MISFIT);
                    let unit = fits.unwrap_or(LENGTHS[0]);
                    (unit, misfit(unit.0))
                });
                let (leg, misfit) = units
                    .iter()
                    .map(|(_, misfit)| *misfit)
                    .enumerate()
                    .max_by(|a, b| a.1.total_cmp(&b.1))
                    .unwrap_or((0, 0.0));
                let fit =
                    Fit { lengths: units.map(|(unit, _)| unit), pose: [x, y, phi], misfit, leg };
                let surprises = |fit: &Fit| wrong(&fit.lengths) + wrong(&fit.pose);
                if fit.misfit <= MISFIT
                    && best.as_ref().is_none_or(|best| surprises(&fit) < surprises(best))
                {
                    best = Some(fit);
                } else if wrong(&fit.pose) == 0 {
                    declared = Some(fit);
                }
            }
        }
    }
    best.or(declared).unwrap_or(Fit {
        lengths: [LENGTHS[0]; 3],
        pose: [LENGTHS[0], LENGTHS[0], ANGLES[0]],
        misfit: 0.0,
        leg: 0,
    })
}

fn unit_error(channel: Channel, values: &[f64], factor: f64, unit: &str) -> (String, String) {
    let first = values.first().copied().unwrap_or_default();
    (
        format!("column `{channel}` starts with {first}, which fits the others if it is in {unit}"),
        format!("write it in {}: multiply by {factor}", channel.unit()),
    )
}

/// Whether some pose of the machine has the lengths of the first row.
fn reachable(
    rig: &Scenario,
    geometry: &Geometry,
    lengths: [&[f64]; 3],
    name: fn(usize) -> Channel,
) -> Option<(String, String)> {
    let guess = start_pose(rig);
    let reaches = |factor: f64| {
        let first = lengths.map(|column| factor * column[0]);
        first.iter().all(|q| *q > 0.0) && geometry.forward(first, guess).is_some()
    };
    if reaches(1.0) {
        return None;
    }
    if let Some((factor, unit)) = LENGTHS.into_iter().find(|(factor, _)| reaches(*factor)) {
        return Some(unit_error(name(0), lengths[0], factor, unit));
    }
    let [a, b, c] = lengths.map(|column| column[0]);
    Some((
        format!("no pose of the machine has the lengths of the first row, {a}, {b}, {c} m"),
        format!(
            "is this the rig of that log (base_side {} m, platform_side {} m)?",
            geometry.base_side, geometry.platform_side
        ),
    ))
}

/// A pose (m, m, rad) near which a machine is sought whose tracker says nothing: where its scenario's
/// motion starts.
pub fn start_pose(rig: &Scenario) -> Vector3<f64> {
    // A rig that cannot be assembled is refused elsewhere; π/6 is far from the machine's singularities.
    assemble(rig).map_or(Vector3::new(0.0, 0.0, PI / 6.0), |machine| machine.motion.at(0.0).pose)
}

/// Logs that hold the same samples: a model judged on what it was fitted to is not judged.
pub fn twins(recordings: &[Recording]) -> Vec<LogError> {
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

/// Forces of another order of magnitude than the declared model's, whose noiseless log is given.
pub fn forces(path: &str, log: &Log, declared: &Log, drive: &Drive) -> Vec<LogError> {
    let filter = ZeroPhase::butterworth(4, CORNER, log.interval);
    let size = |values: &[f64]| {
        let filtered = filter.apply(values);
        (filtered.iter().map(|v| v * v).sum::<f64>() / filtered.len().max(1) as f64).sqrt()
    };
    let mut found = Vec::new();
    for leg in 0..3 {
        let channel = Channel::Force(leg);
        let (Some(measured), Some(expected)) = (log.get(channel), declared.get(channel)) else {
            continue;
        };
        let (measured, expected) = (size(measured), size(expected));
        let by_law = servo(log, drive, leg).map(|force| size(&force));
        let unit = if measured < SMALL * expected {
            Some(("kN", 1e3))
        } else if measured > LARGE * expected
            && by_law.is_none_or(|by_law| measured > BEYOND_LAW * by_law)
        {
            Some(("mN", 1e-3))
        } else {
            None
        };
        if let Some((unit, factor)) = unit {
            found.push(LogError {
                place: path.to_owned(),
                message: format!(
                    "column `{channel}` is of the order of {measured:.1e}, where the declared model \
                     takes {expected:.1e} N: is it in {unit}?"
                ),
                help: format!("write it in N: multiply by {factor}"),
            });
        }
    }
    found
}

/// The force of a servo in N by its own law, `k_p (q_cmd − q)`; its damping is small where motion is slow.
fn servo(log: &Log, drive: &Drive, leg: usize) -> Option<Vec<f64>> {
    if drive.mode != DriveMode::Servo {
        return None;
    }
    let (command, length) = (log.get(Channel::Command(leg))?, log.get(Channel::Length(leg))?);
    Some(command.iter().zip(length).map(|(c, q)| drive.stiffness * (c - q)).collect())
}
