//! The rig of the self-test and its recordings.

use super::LegsTrial;
use super::hidden::{hide, uniform};
use crate::calibrate::measured::replica;
use crate::calibrate::results::outcome::canonical;
use crate::calibrate::values::model::{LegsCase, LegsRun, SearchError};
use crate::effects::Setting;
use crate::engine::StepControl;
use crate::measure::log::{Channel, Log};
use crate::mechanism::motion::PathPoint;
use crate::mechanism::three_rpr::Geometry;
use crate::scenario::{Problems, Scenario};
use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::f64::consts::{FRAC_PI_6, TAU};

/// The rig: the paper's machine with servos, joints of 0.1 mm, and sensors of a good laboratory.
const RIG: &str = include_str!("rig.toml");

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
pub fn recorded(trial: &LegsTrial) -> Result<(LegsCase, Vec<Setting>), SearchError> {
    let mut random = ChaCha8Rng::seed_from_u64(trial.seed);
    let gravity = if trial.gravity { "-9.81" } else { "0.0" };
    let set = [format!("environment.gravity=[0.0,{gravity}]")];
    let wrong = |problems: Problems| SearchError::from(problems.0.into_iter().next().expect("one"));
    let rig = Scenario::from_text(RIG, "self-test rig", &set).map_err(wrong)?;
    let sensors = rig.sensors.clone().unwrap_or_default();
    let hidden: Vec<Setting> = trial
        .hidden
        .iter()
        .filter_map(|name| hide(name, trial, &mut random))
        .map(|effect| canonical(&effect))
        .collect();
    let geometry = Geometry { base_side: 0.66, platform_side: 0.1 };
    let (interval, samples) = (1e-3, 3001);
    let runs = (0..2).map(|run| {
        let shape = [(); 4].map(|()| uniform(&mut random));
        let pose = |i: usize| path(run, shape, i as f64 * interval);
        let length = |i: usize, leg: usize| {
            geometry.inverse(&PathPoint { pose: pose(i), ..PathPoint::default() })[leg].position
        };
        let channels = Channel::all(3).into_iter().map(|channel| {
            let values = (0..samples).map(|i| match channel {
                // Nine decimals, as logs have them.
                Channel::Command(leg) => (length(i, leg) * 1e9).round() * 1e-9,
                Channel::Length(leg) => length(i, leg),
                Channel::Force(_) => 0.0,
                Channel::Pose(k) => pose(i)[k],
            });
            (channel, values.collect())
        });
        let name = ["run-a.csv", "run-b.csv"][run];
        Log::new(name, 0.0, interval, channels.collect())
    });
    let templates: Vec<Log> = runs.collect();
    let control = StepControl::Tolerance(1e-5);
    let mut logs = Vec::new();
    for (i, template) in templates.into_iter().enumerate() {
        let runs = vec![LegsRun::new(template).map_err(missing)?];
        let case = LegsCase::new(rig.clone(), sensors.clone(), runs, control);
        let machine = case.released(&hidden)?.remove(0);
        let log = &case.runs[0].log;
        // Another start of the rattle than any replica's.
        let clean = case.simulator.record(&machine, log, trial.seed + 1000 + i as u64)?;
        logs.push(replica::with_noise(&clean, &sensors, trial.seed + 77 + i as u64));
    }
    let runs =
        logs.into_iter().map(|log| LegsRun::new(log).map_err(missing)).collect::<Result<_, _>>()?;
    let mut case = LegsCase::new(rig, sensors, runs, control);
    case.chaotic = !trial.gravity;
    Ok((case, hidden))
}

fn missing(channel: Channel) -> SearchError {
    unreachable!("a synthetic log has every channel, {channel} too")
}
