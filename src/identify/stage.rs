//! A recorded drive stage: its controller, its closed loop, and inverse models as effects of a scenario.

use super::inverse::{Model, Motion, Term};
use super::plausible;
use super::recorded::{Missing, Recorded};
use crate::effects::{Setting, named};
use crate::engine::{self, Schedule, StepControl};
use crate::measure::log::{Channel, Log};
use crate::measure::splice;
use crate::mechanism::{Cascade, Command, Commands, Drive, Held, Mechanism, drive_stage};
use crate::scenario::{DriveMode, Scenario};
use crate::simulate::drive;
use nalgebra::Vector2;
use std::f64::consts::PI;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// Pitch of the ball screw in m (README of the data).
pub const PITCH: f64 = 2.5e-3;

/// Speed in m/s at which dry friction is near its full value: a 200th of the slowest working speed.
const SIGN_SPEED: f64 = 1e-4;

/// Fixed step in s of the closed loop: a fifth of its sampling, half of what dry friction stands.
const STEP: f64 = 2e-4;

/// What a recording of a stage has to have for its parameters to be found, and what it may have.
pub const NEEDED: [Channel; 3] = [Channel::Command(0), Channel::Length(0), Channel::Force(0)];
/// See [`NEEDED`].
pub const KNOWN: [Channel; 4] =
    [Channel::Command(0), Channel::Length(0), Channel::Force(0), Channel::Added(0)];

/// A recording of the stage.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Name of its file.
    pub name: String,
    /// Its samples.
    pub log: Log,
    /// The same for the regression.
    pub motion: Motion,
    /// The controller that made it.
    pub cascade: Cascade,
}

impl Recording {
    /// Reads a recording of a rig: reference, length and force, and a voltage on top of the controller's
    /// where the file has its column.
    ///
    /// # Errors
    /// Files that are not there or not what they should be.
    pub fn read(path: &Path, rig: &Scenario) -> Result<Recording, Missing> {
        let recorded = Recorded::read(path, rig, &NEEDED, &KNOWN)?;
        let Some(cascade) = cascade(rig) else {
            let help =
                "the rig needs mechanism.kind = \"drive-stage\" and drive.mode = \"sampled\"";
            return Err(Missing::Wrong(help.to_owned()));
        };
        plausible(rig, &recorded)?;
        Ok(Recording::of(recorded.log, cascade))
    }

    /// A recording of a controller's.
    pub fn of(log: Log, cascade: Cascade) -> Recording {
        let column = |channel| log.get(channel).unwrap_or_default();
        let motion =
            Motion::new(column(Channel::Length(0)), column(Channel::Force(0)), log.interval);
        Recording { name: log.name.clone(), motion, log, cascade }
    }
}

/// The sampled controller of a rig, if it has one.
pub fn cascade(rig: &Scenario) -> Option<Cascade> {
    match drive(rig) {
        Drive::Sampled(cascade) => Some(cascade),
        Drive::Prescribed | Drive::Servo { .. } | Drive::Effort => None,
    }
}

/// Share by which a recording's rate may differ from its controller's: more is another machine.
const RATE: f64 = 1e-3;

/// Makes sure that a recording can be one run of this stage, in the units that it is said to be in: the
/// length neither jumps nor changes its speed at once, and the controller's law says the force.
///
/// # Errors
/// What speaks against it.
pub fn plausible(rig: &Scenario, recorded: &Recorded) -> Result<(), Missing> {
    let (log, sources) = (&recorded.log, &recorded.sources);
    for (channel, source) in sources {
        if matches!(channel, Channel::Length(_)) {
            splice::one_run(splice::Samples {
                place: &log.name,
                column: &source.column,
                unit: channel.unit(),
                start: log.start,
                interval: log.interval,
                values: log.get(*channel).unwrap_or_default(),
            })?;
        }
    }
    let Some(cascade) = cascade(rig) else { return Ok(()) };
    if (log.interval / cascade.interval - 1.0).abs() > RATE {
        let message = format!(
            "{} has a sample every {:.6} s, and the controller takes one every {} s",
            recorded.path, log.interval, cascade.interval
        );
        let help = "write drive.sampled.interval as it is, or a scale for columns.t: a recording needs \
                    every sample of its controller";
        return Err(Missing::Wrong(format!("{message}; {help}")));
    }
    if log.get(Channel::Force(0)).is_none() || log.get(Channel::Length(0)).is_none() {
        return Ok(());
    }
    let [q, command, force] = [Channel::Length(0), Channel::Command(0), Channel::Force(0)];
    let disagreement = |channels: &[Channel], factor: f64| {
        let scaled = |channel: Channel| -> Vec<f64> {
            let factor = if channels.contains(&channel) { factor } else { 1.0 };
            log.get(channel).unwrap_or_default().iter().map(|value| value * factor).collect()
        };
        let told = told(&cascade, log, &scaled(command), &scaled(q));
        let recorded = scaled(force);
        let square = |sum: f64, x: f64| sum + x * x;
        let error = told.iter().zip(&recorded).map(|(a, b)| a - b).fold(0.0, square);
        (error / told.iter().copied().fold(0.0, square)).sqrt()
    };
    let law = "the controller of [drive.sampled] says the force from the lengths";
    let suspects: [&[Channel]; 4] = [&[force], &[q], &[command], &[q, command]];
    Ok(plausible::scale(log, law, sources, &suspects, disagreement)?)
}

/// What a controller tells the drive when it sees these lengths under these commands (m), with the
/// voltage that a log says was added: `G u` in N at each sample.
fn told(drive: &Cascade, log: &Log, commands: &[f64], lengths: &[f64]) -> Vec<f64> {
    let added = log.get(Channel::Added(0)).unwrap_or_default();
    let mut held = Held::default();
    (commands.iter().zip(lengths).enumerate())
        .map(|(k, (length, q))| {
            let command = Command { position: *length, ..Command::default() };
            let added = added.get(k).copied().unwrap_or(0.0);
            let t = k as f64 * drive.interval;
            drive.force_gain * drive.sample(&mut held, t, &command, *q, added)
        })
        .collect()
}

/// What a controller tells the drive when it sees these lengths (m) under a log's commands: `G u` in N.
pub fn controller_force(cascade: &Cascade, log: &Log, lengths: &[f64]) -> Vec<f64> {
    told(cascade, log, log.get(Channel::Command(0)).unwrap_or_default(), lengths)
}

/// A log's reference and added voltage, held from sample to sample as a sampled controller sees them.
#[derive(Debug)]
pub struct Samples {
    interval: f64,
    lengths: Vec<f64>,
    added: Vec<f64>,
}

impl Samples {
    /// Of a log.
    pub fn of(log: &Log) -> Self {
        let column = |channel| log.get(channel).unwrap_or_default().to_vec();
        let [lengths, added] = [Channel::Command(0), Channel::Added(0)].map(column);
        Self { interval: log.interval, lengths, added }
    }

    fn at(&self, samples: &[f64], t: f64) -> f64 {
        let last = samples.len().saturating_sub(1);
        samples.get(((t / self.interval).round() as usize).min(last)).copied().unwrap_or(0.0)
    }
}

impl Commands for Samples {
    fn at(&self, t: f64, commands: &mut [Command]) {
        for command in commands {
            *command = Command { position: self.at(&self.lengths, t), ..Command::default() };
        }
    }

    fn added(&self, _: usize, t: f64) -> f64 {
        self.at(&self.added, t)
    }
}

/// Where a log begins: its first length, or the first command where no length was measured, in m.
pub fn first_length(log: &Log) -> f64 {
    let first = |channel| log.get(channel).and_then(|values| values.first().copied());
    first(Channel::Length(0)).or_else(|| first(Channel::Command(0))).unwrap_or(0.0)
}

/// The stage that a model describes: what is linear in its force as effects, and a lag beyond half a
/// sample, which holding takes by itself.
///
/// # Errors
/// An effect that the stage cannot take.
pub fn stage(model: &Model, recording: &Recording) -> Result<Mechanism, Missing> {
    let lag = lag(model, &recording.cascade);
    let start = [first_length(&recording.log), 0.0];
    let drive = Drive::Sampled(Cascade { lag, ..recording.cascade });
    let commands = Arc::new(Samples::of(&recording.log));
    let mass = model.factor(Term::Mass);
    let mut mechanism = drive_stage::build(mass, drive, start, commands, Vector2::zeros());
    for effect in effects(model) {
        effect.apply(&mut mechanism).map_err(|wrong| Missing::Wrong(wrong.message))?;
    }
    Ok(mechanism)
}

/// The lag in s of a model's drive, half a sample less than its term says: holding takes that much.
pub fn lag(model: &Model, cascade: &Cascade) -> f64 {
    (model.factor(Term::Lag) / model.factor(Term::Mass) - 0.5 * cascade.interval).max(0.0)
}

/// A rig with a model in place of its mass, its lag and its effects.
pub fn scenario(rig: &Scenario, model: &Model) -> Scenario {
    let mut found = rig.clone();
    if let crate::scenario::Mechanism::DriveStage(stage) = &mut found.mechanism {
        stage.mass = model.factor(Term::Mass);
    }
    if let (DriveMode::Sampled, Some(cascade)) = (rig.drive.mode, cascade(rig)) {
        let lag = if model.factor(Term::Lag) == 0.0 { cascade.lag } else { lag(model, &cascade) };
        found.drive.sampled = Some(crate::scenario::Sampled { lag, ..rig.drive.sampled() });
    }
    found.effects = effects(model);
    found
}

/// A model's terms as effects of a scenario.
pub fn effects(model: &Model) -> Vec<Setting> {
    let effect = |name: &str, values: &[(&'static str, f64)]| {
        named(name).map(|kind| Setting::new(kind, Some("P1"), values))
    };
    let mut found = Vec::new();
    let both = |term: Term| model.factor(term);
    let ways = model.terms.iter().any(|(t, _)| matches!(t, Term::ViscousWay(_)));
    let mut friction = if ways {
        vec![
            ("coulomb_pos_N", both(Term::CoulombWay(true))),
            ("coulomb_neg_N", both(Term::CoulombWay(false))),
            ("viscous_pos_Ns_m", both(Term::ViscousWay(true))),
            ("viscous_neg_Ns_m", both(Term::ViscousWay(false))),
        ]
    } else {
        vec![("coulomb_N", both(Term::Coulomb)), ("viscous_Ns_m", both(Term::Viscous))]
    };
    // On the rod, where the regression has the force that the drive gives against it.
    if model.terms.iter().any(|(t, _)| *t == Term::Offset) {
        friction.push(("offset_N", -both(Term::Offset)));
    }
    friction.push(("velocity_m_s", SIGN_SPEED));
    found.extend(effect("actuator-friction", &friction));
    for (term, factor) in &model.terms {
        match term {
            Term::Film(speed) => {
                let values = [("force_N", *factor), ("speed_m_s", *speed)];
                found.extend(effect("film-friction", &values));
            }
            Term::Stribeck(speed) => {
                // What falls away over v_s from the top of nothing.
                let values = [
                    ("coulomb_N", 0.0),
                    ("static_N", *factor),
                    ("stribeck_m_s", *speed),
                    ("velocity_m_s", SIGN_SPEED),
                ];
                found.extend(effect("stribeck-friction", &values));
            }
            Term::Drag => {
                let drag = named("air-drag");
                found.extend(drag.map(|k| Setting::new(k, None, &[("force_Ns2_m2", *factor)])));
            }
            _ => {}
        }
    }
    if let Some((pitch, amplitude, phase)) = ripple(model) {
        let values = [("amplitude_N", amplitude), ("pitch_m", pitch), ("phase_rad", phase)];
        found.extend(effect("screw-ripple", &values));
    }
    found
}

/// Pitch (m), amplitude (N) and phase (rad) of a model's ripple as a force on the rod.
pub fn ripple(model: &Model) -> Option<(f64, f64, f64)> {
    let pitch = model.terms.iter().find_map(|(term, _)| match term {
        Term::Ripple(pitch, _) => Some(*pitch),
        _ => None,
    })?;
    let [sin, cos] = [true, false].map(|sine| model.factor(Term::Ripple(pitch, sine)));
    Some((pitch, sin.hypot(cos), cos.atan2(sin) + PI))
}

/// Force in N that the controller of a recording asks for when its reference drives a mechanism.
///
/// # Errors
/// A run that breaks down.
pub fn simulated_force(mechanism: &Mechanism, recording: &Recording) -> Result<Vec<f64>, Missing> {
    let rows = simulate(mechanism, StepControl::Fixed(STEP), &recording.log)?;
    let lengths: Vec<f64> = rows.into_iter().map(|[length, _]| length).collect();
    Ok(controller_force(&recording.cascade, &recording.log, &lengths))
}

/// Simulates a stage at the samples of a log: read length in m and force of the drive in N.
///
/// # Errors
/// A run that breaks down.
pub fn simulate(
    mechanism: &Mechanism,
    control: StepControl,
    log: &Log,
) -> Result<Vec<[f64; 2]>, engine::Halt> {
    let schedule = Schedule { duration: log.duration(), interval: log.interval };
    let mut rows = Vec::with_capacity(log.samples);
    let actuator = &mechanism.actuators[0];
    engine::run(mechanism, control, schedule, &mut |instant| {
        let [length, _] = actuator.read(instant.evaluation.coordinates[0], 0.0);
        rows.push([length, instant.evaluation.drive_forces[0]]);
    })?;
    rows.resize(log.samples, [f64::NAN; 2]);
    Ok(rows)
}

/// The first and the second half of some rows.
pub fn halves(rows: &Range<usize>) -> [Range<usize>; 2] {
    let middle = (rows.start + rows.end) / 2;
    [rows.start..middle, middle..rows.end]
}
