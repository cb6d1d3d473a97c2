//! What sensors would record of a machine: without noise, through the start that calibrations know.

use super::pace::passed;
use crate::calibrate::sensed::problem::Stopped;
use crate::calibrate::sensed::recording::Recording;
use crate::calibrate::sensed::released::released;
use crate::calibrate::sensed::simulate::record;
use crate::effects::Setting;
use crate::engine::StepControl;
use crate::mechanism::{BodyState, Command, Mechanism, Reads};
use crate::scenario::Scenario;
use rayon::prelude::*;
use std::time::Instant;

/// The replica that is recorded, of those that calibrations do not have: its tolerance is a fifth of theirs.
const RECORDED: u64 = 16;

/// What sensors without noise show of a rig's machine with these effects along the commands of `like`, so many
/// replicas; `first` says where it is let go.
///
/// # Errors
/// Effects that the machine cannot take, a run that broke down.
pub fn clean(
    (rig, effects): (&Scenario, &[Setting]),
    first: &Recording,
    like: &Recording,
    control: StepControl,
    replicas: u64,
) -> Result<Vec<Recording>, Stopped> {
    let machine = released(rig, effects, first, control)?.machine;
    (0..replicas)
        .into_par_iter()
        .map(|replica| Ok(record(&machine, control, like, RECORDED + replica)?))
        .collect()
}

/// Times in s that it takes to let such a machine go, and to record `like` from there, once.
///
/// # Errors
/// As of [`clean`].
pub fn timed(
    rig: &Scenario,
    first: &Recording,
    like: &Recording,
    control: StepControl,
) -> Result<[f64; 2], Stopped> {
    let started = Instant::now();
    let machine = released(rig, &[], first, control)?.machine;
    let let_go = started.elapsed().as_secs_f64();
    record(&machine, control, like, RECORDED)?;
    Ok([let_go, started.elapsed().as_secs_f64() - let_go])
}

/// How a recording is made.
#[derive(Clone, Copy, Debug)]
pub struct RecordingSetup {
    /// Its file.
    pub name: &'static str,
    /// Time in s between two rows.
    pub interval: f64,
    /// Length in s.
    pub duration: f64,
    /// How fast the motion is followed, and, of a machine without drives, how far it is let go from zero, as a share of
    /// what the scenario says.
    pub pace: f64,
}

/// What a machine is recorded like: its commands along its motion, from rest on, to nine decimals as logs have them, and
/// for what sensors will show where the machine stands at the start.
pub fn like(mechanism: &Mechanism, made: RecordingSetup) -> Recording {
    let RecordingSetup { name, interval, duration, pace } = made;
    let samples = (duration / interval).round() as usize + 1;
    let falls = mechanism.actuators.is_empty();
    let mut told = vec![Vec::with_capacity(samples); mechanism.actuators.len()];
    let mut commands = vec![Command::default(); mechanism.actuators.len()];
    for row in 0..samples {
        let t = pace * passed(row as f64 * interval);
        mechanism.commands.at(t, &mut commands);
        for (told, command) in told.iter_mut().zip(&commands) {
            told.push((command.position * 1e9).round() * 1e-9);
        }
    }
    let share = if falls { pace } else { 1.0 };
    let states: Vec<BodyState> = mechanism.bodies.iter().map(|body| body.start).collect();
    let stands = |reads: Reads| match reads {
        Reads::Position(joint) => share * mechanism.start_coordinate(joint),
        Reads::Angle(Some(body), angle) => share * (mechanism.bodies[body].angle + angle),
        Reads::X(mark) => mark.attachment(mechanism).centre(&states).x,
        Reads::Y(mark) => mark.attachment(mechanism).centre(&states).y,
        _ => 0.0,
    };
    let column = |reads: Reads| match reads {
        Reads::Command(drive) => told[drive].clone(),
        reads => vec![stands(reads); samples],
    };
    let columns = mechanism.sensors.iter().map(|sensor| Some(column(sensor.reads)));
    Recording::of(name, interval, samples, columns.collect())
}
