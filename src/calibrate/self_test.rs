//! The method held against what it should find: known effects of random size, hidden in synthetic
//! recordings.

use super::model::SearchError;
use super::model::{Case, Run};
use super::outcome::{Outcome, Verdict, calibrate, canonical};
use super::replica;
use crate::effects::{Setting, named};
use crate::engine::StepControl;
use crate::measure::log::{Channel, Log};
use crate::mechanism::motion::PathPoint;
use crate::mechanism::three_rpr::Geometry;
use crate::scenario::{Problems, Scenario};
use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde::Serialize;
use std::f64::consts::{FRAC_PI_6, TAU};

/// The rig: the paper's machine with servos, joints of 0.1 mm, and sensors of a good laboratory.
const RIG: &str = include_str!("self_test.toml");

/// How an effect is hidden: name, joints to choose from, and for each value its smallest size, whether
/// it takes either sign, and whether it grows with the size of the trial.
struct Hidden {
    kind: &'static str,
    joints: &'static [&'static str],
    values: &'static [(&'static str, Draw)],
}

/// How a value is drawn.
#[derive(Clone, Copy)]
enum Draw {
    /// At least so much, times the size of the trial.
    Size(f64),
    /// The same, of either sign.
    Either(f64),
    /// As declared (the first) plus a size of either sign.
    Around(f64, f64),
    /// As declared plus a size.
    Above(f64, f64),
    /// Anything between.
    Between(f64, f64),
}

const P: &[&str] = &["P1", "P2", "P3"];
const A: &[&str] = &["A1", "A2", "A3"];
const ALL_JOINTS: &[&str] = &["A1", "A2", "A3", "C1", "C2", "C3"];

use Draw::{Above, Around, Between, Either, Size};

/// Every effect with a name that rigs may hide, at a size of one about three times what sensors and
/// rattle would hide.
const HIDDEN: &[Hidden] = &[
    Hidden {
        kind: "payload",
        joints: &[],
        values: &[
            ("mass_kg", Size(0.02)),
            ("com_x_m", Between(-0.03, 0.03)),
            ("com_y_m", Between(-0.03, 0.03)),
        ],
    },
    Hidden {
        kind: "gravity",
        joints: &[],
        values: &[("gx_m_s2", Either(0.15)), ("gy_m_s2", Around(f64::NAN, 0.15))],
    },
    Hidden {
        kind: "actuator-friction",
        joints: P,
        values: &[("coulomb_N", Size(0.3)), ("viscous_Ns_m", Size(1.0))],
    },
    Hidden { kind: "journal-friction", joints: &[], values: &[("mu", Size(0.03))] },
    Hidden {
        kind: "anchor-offset",
        joints: A,
        values: &[("dx_m", Either(5e-5)), ("dy_m", Either(5e-5))],
    },
    Hidden {
        kind: "joint-wear",
        joints: ALL_JOINTS,
        values: &[("clearance_m", Above(1e-4, 4e-5))],
    },
    Hidden { kind: "command-delay", joints: &[], values: &[("delay_s", Size(2e-4))] },
    Hidden { kind: "servo-lag", joints: &[], values: &[("time_constant_s", Size(4e-4))] },
    Hidden { kind: "actuator-scale", joints: P, values: &[("relative", Either(1e-3))] },
    Hidden {
        kind: "screw-ripple",
        joints: P,
        values: &[
            ("amplitude_m", Size(1e-5)),
            ("pitch_m", Between(3e-3, 8e-3)),
            ("phase_rad", Between(0.0, TAU)),
        ],
    },
    Hidden {
        kind: "tether",
        joints: &[],
        values: &[
            ("stiffness_N_m", Size(4.0)),
            ("anchor_x_m", Between(-0.3, 0.3)),
            ("anchor_y_m", Between(0.15, 0.4)),
            ("rest_length_m", Between(0.02, 0.12)),
        ],
    },
    Hidden {
        kind: "drag",
        joints: &[],
        values: &[("force_Ns_m", Size(0.8)), ("torque_Nms", Size(2e-3))],
    },
    Hidden {
        kind: "base-vibration",
        joints: &[],
        values: &[
            ("ax_m_s2", Either(0.2)),
            ("ay_m_s2", Either(0.2)),
            ("frequency_Hz", Between(4.0, 40.0)),
            ("phase_rad", Between(0.0, TAU)),
        ],
    },
    Hidden {
        kind: "unbalance",
        joints: &[],
        values: &[
            ("mass_radius_kg_m", Size(2e-5)),
            ("frequency_Hz", Between(10.0, 40.0)),
            ("phase_rad", Between(0.0, TAU)),
        ],
    },
];

/// Sizes of hidden effects, in units of about three floors.
pub const SIZES: [f64; 3] = [1.0, 3.0, 8.0];

/// One rig to be understood.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Hidden effects by name; none in a rig that lacks nothing.
    pub hidden: Vec<&'static str>,
    /// Their size.
    pub size: f64,
    /// Whether gravity keeps the joints loaded.
    pub gravity: bool,
    /// Whether the hidden effects are no candidates.
    pub withheld: bool,
    /// Everything random follows from it.
    pub seed: u64,
}

/// What became of a trial.
#[derive(Clone, Debug, Serialize)]
pub struct Result {
    /// Hidden effects.
    pub hidden: Vec<Setting>,
    /// With gravity.
    pub gravity: bool,
    /// Size.
    pub size: f64,
    /// Withheld from the candidates.
    pub withheld: bool,
    /// Verdict.
    pub verdict: Verdict,
    /// Effects found.
    pub found: Vec<Setting>,
    /// Whether the verdict and the names are right.
    pub right: bool,
    /// For each hidden value found by name: name, truth, estimate, standard deviation.
    pub values: Vec<(String, f64, f64, f64)>,
    /// How large what is hidden is: the declared model's largest error on the validation run, in floors.
    pub floors: f64,
    /// The same of the calibrated model.
    pub worst_ratio: f64,
    /// Simulations it took.
    pub simulations: usize,
}

/// The names of all effects that can be hidden.
pub fn kinds() -> impl Iterator<Item = &'static str> {
    HIDDEN.iter().map(|hidden| hidden.kind)
}

/// A number between 0 and 1.
fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

fn hide(hidden: &Hidden, trial: &Trial, random: &mut ChaCha8Rng) -> Option<Setting> {
    let kind = named(hidden.kind)?;
    let joint = (!hidden.joints.is_empty())
        .then(|| hidden.joints[(uniform(random) * hidden.joints.len() as f64) as usize]);
    let mut size = |at_least: f64| at_least * trial.size * (1.0 + 0.5 * uniform(random));
    let mut values = Vec::new();
    let mut signs = ChaCha8Rng::seed_from_u64(trial.seed ^ 0x5151);
    let mut sign = || if uniform(&mut signs) < 0.5 { -1.0 } else { 1.0 };
    let declared_y = if trial.gravity { -9.81 } else { 0.0 };
    for (name, draw) in hidden.values {
        let value = match *draw {
            Size(s) => size(s),
            Either(s) => sign() * size(s),
            Around(declared, s) => {
                let declared = if declared.is_nan() { declared_y } else { declared };
                declared + sign() * size(s)
            }
            Above(declared, s) => declared + size(s),
            Between(low, high) => low + (high - low) * (size(1.0) / trial.size - 1.0) / 0.5,
        };
        values.push((*name, value));
    }
    Some(Setting::new(kind, joint, &values))
}

/// Motions of the two runs: at rest for 0.05 s, then up to full speed in 0.25 s.
fn path(run: usize, random: [f64; 4], t: f64) -> Vector3<f64> {
    let s = (t - 0.05).max(0.0);
    let ramp = 0.25;
    // ∫ of a smooth rise of the speed from 0 to 1 over `ramp`.
    let x = (s / ramp).min(1.0);
    let phase = ramp * (x * x * x - 0.5 * x.powi(4)) + (s - ramp).max(0.0);
    let [a, b, c, d] = random;
    let wave = |f: f64, p: f64| (TAU * (f * phase + p)).sin();
    if run == 0 {
        let (fx, fy, fp) = (1.1 + 0.3 * a, 1.5 + 0.4 * b, 1.2 + 0.2 * c);
        Vector3::new(0.035 * wave(fx, 0.0), 0.03 * wave(fy, d), FRAC_PI_6 + 0.16 * wave(fp, 0.1))
    } else {
        let f = 1.1 + 0.3 * a;
        let (x, y) = (0.04 * wave(f, 0.25), 0.04 * wave(f, 0.0));
        Vector3::new(x, y, FRAC_PI_6 + 0.1 * wave(1.3 + 0.3 * b, c))
    }
}

/// A rig's recordings with what a trial hides in them, and that.
///
/// # Errors
/// A hidden effect that gives no machine.
pub fn recorded(trial: &Trial) -> std::result::Result<(Case, Vec<Setting>), SearchError> {
    let mut random = ChaCha8Rng::seed_from_u64(trial.seed);
    let gravity = if trial.gravity { "-9.81" } else { "0.0" };
    let set = [format!("environment.gravity=[0.0,{gravity}]")];
    let wrong = |problems: Problems| SearchError::from(problems.0.into_iter().next().expect("one"));
    let rig = Scenario::from_text(RIG, "self-test rig", &set).map_err(wrong)?;
    let sensors = rig.sensors.clone().unwrap_or_default();
    let hidden: Vec<Setting> = trial
        .hidden
        .iter()
        .filter_map(|name| HIDDEN.iter().find(|hidden| hidden.kind == *name))
        .filter_map(|hidden| hide(hidden, trial, &mut random))
        .map(|effect| canonical(&effect))
        .collect();
    let geometry = Geometry { base_side: 0.66, platform_side: 0.1 };
    let (interval, samples) = (1e-3, 3001);
    let runs = (0..2).map(|run| {
        let shape = [(); 4].map(|()| uniform(&mut random));
        let pose = |i: usize| path(run, shape, i as f64 * interval);
        let length = |i: usize, leg: usize| {
            geometry.inverse(&PathPoint { pose: pose(i), ..PathPoint::default() })[leg].length
        };
        let channels = Channel::all(3).into_iter().map(|channel| {
            let values = (0..samples).map(|i| match channel {
                // Nine decimals, as logs have them.
                Channel::Command(leg) => (length(i, leg) * 1e9).round() * 1e-9,
                Channel::Length(leg) => length(i, leg),
                Channel::Force(_) | Channel::Added(_) => 0.0,
                Channel::Pose(k) => pose(i)[k],
            });
            (channel, values.collect())
        });
        let name = ["run-a.csv", "run-b.csv"][run];
        Log::new(name, 0.0, interval, channels.collect())
    });
    let templates: Vec<Log> = runs.collect();
    let control = StepControl::Tolerance(1e-5);
    let chaotic = !trial.gravity;
    let replicas = if chaotic { 6 } else { 1 };
    let mut logs = Vec::new();
    for (i, template) in templates.into_iter().enumerate() {
        let runs = vec![Run::new(template).map_err(missing)?];
        let case =
            Case { rig: rig.clone(), sensors: sensors.clone(), runs, control, replicas, chaotic };
        let machine = case.released(&hidden)?.remove(0);
        let log = &case.runs[0].log;
        // Another start of the rattle than any replica's.
        let clean =
            replica::simulate(&machine, &sensors, control, log, trial.seed + 1000 + i as u64)?;
        logs.push(replica::with_noise(&clean, &sensors, trial.seed + 77 + i as u64));
    }
    let runs = logs
        .into_iter()
        .map(|log| Run::new(log).map_err(missing))
        .collect::<std::result::Result<_, _>>()?;
    Ok((Case { rig, sensors, runs, control, replicas, chaotic }, hidden))
}

fn missing(channel: Channel) -> SearchError {
    unreachable!("a synthetic log has every channel, {channel} too")
}

/// Hides, calibrates, compares.
///
/// # Errors
/// A rig that cannot be simulated.
pub fn run(trial: &Trial) -> std::result::Result<Result, SearchError> {
    let (case, hidden) = recorded(trial)?;
    let without: &[&str] = if trial.withheld { &trial.hidden } else { &[] };
    let outcome = calibrate(&case, without, &|_| {})?;
    Ok(judge(trial, hidden, &outcome))
}

fn judge(trial: &Trial, hidden: Vec<Setting>, outcome: &Outcome) -> Result {
    let found: Vec<Setting> = outcome.effects.iter().map(|(effect, _)| effect.clone()).collect();
    let named = || outcome.effects.iter().filter(|(effect, _)| effect.map().is_none());
    let right = if trial.withheld {
        outcome.verdict == Verdict::Unexplained
    } else if hidden.is_empty() {
        outcome.verdict == Verdict::NothingMissing
    } else {
        outcome.verdict == Verdict::Explained
            && named().count() == hidden.len()
            && hidden.iter().all(|h| named().any(|(effect, _)| effect.is(h)))
    };
    let mut values = Vec::new();
    for truth in &hidden {
        let Some((_, estimates)) = named().find(|(effect, _)| effect.is(truth)) else {
            continue;
        };
        for (name, true_value) in truth.values() {
            if let Some(e) = estimates.iter().find(|e| e.name == name) {
                // Phases on both sides of a whole turn are near each other.
                let turns = match name {
                    "phase_rad" => ((e.value - true_value) / TAU).round(),
                    _ => 0.0,
                };
                let value = e.value - turns * TAU;
                values.push((format!("{}.{name}", truth.kind.name), true_value, value, e.std));
            }
        }
    }
    let validation = || outcome.errors.iter().filter(|error| error.role == "validation");
    Result {
        gravity: trial.gravity,
        size: trial.size,
        withheld: trial.withheld,
        verdict: outcome.verdict,
        right,
        values,
        floors: validation().map(|e| e.before / e.floor).fold(0.0, f64::max),
        worst_ratio: validation().map(|e| e.after / e.floor).fold(0.0, f64::max),
        simulations: outcome.simulations,
        hidden,
        found,
    }
}
