//! Commands of a trial's runs: smooth, at rest at first, as `assets/rigs-planar` has them.

use super::Trial;
use super::dice::Dice;
use super::families::MovedBy;
use crate::calibrate::record::passed;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::mechanism::{JointIndex, Mechanism, Reads};
use std::f64::consts::TAU;

/// Frequencies in Hz of waves and turns at size one; accelerations are alike at all sizes, so that they go with the
/// root of the size.
const FREQUENCIES: [f64; 2] = [0.7, 2.2];

/// A drive's way: a rate of turning and two waves.
struct DriveWaves {
    middle: f64,
    turning: f64,
    waves: [[f64; 3]; 2],
}

impl DriveWaves {
    fn draw(dice: &mut Dice, moves: MovedBy, middle: f64, length: f64, pace: f64) -> Self {
        let [low, high] = FREQUENCIES.map(|frequency| TAU * frequency * pace);
        let (turning, size) = match moves {
            MovedBy::Turns => {
                let sign = if dice.chance(0.5) { 1.0 } else { -1.0 };
                (sign * dice.between(low, high), 0.3)
            }
            MovedBy::Waves(size) => (0.0, size * length),
            MovedBy::Falls(_) => (0.0, 0.0),
        };
        let mut wave = |share: f64| {
            let amplitude = share * size * dice.between(0.5, 1.0);
            [amplitude, dice.between(low, high), dice.between(0.0, TAU)]
        };
        Self { middle, turning, waves: [wave(0.7), wave(0.3)] }
    }

    /// The command in rad or m, to nine decimals as logs have it.
    fn at(&self, t: f64) -> f64 {
        let s = passed(t);
        let waves: f64 =
            self.waves.iter().map(|[a, rate, phase]| a * (rate * s + phase).sin()).sum();
        ((self.middle + self.turning * s + waves) * 1e9).round() * 1e-9
    }
}

/// What run `run` of a trial is recorded like: its commands, and zeros for what sensors will show. Of a machine that
/// falls the sensors of its joints hold where it is let go.
pub(super) fn like(trial: &Trial, mechanism: &Mechanism, run: usize) -> Recording {
    let mut dice = Dice::new(trial.seed, 10 + run as u64);
    let interval = 1.0 / trial.rate;
    let samples = (trial.duration_s * trial.rate).round() as usize + 1;
    let family = trial.family();
    let pace = trial.size.sqrt().recip();
    let ways: Vec<DriveWaves> = mechanism
        .actuators
        .iter()
        .map(|drive| {
            let length = match drive.joint {
                JointIndex::Prismatic(_) => trial.size,
                JointIndex::Revolute(_) => 1.0,
            };
            let middle = mechanism.start_coordinate(drive.joint);
            DriveWaves::draw(&mut dice, family.moves, middle, length, pace)
        })
        .collect();
    let angles = family.let_go_at(&mut dice, mechanism.revolutes.len());
    let columns = mechanism.sensors.iter().map(|sensor| {
        let value = |row: usize| match sensor.reads {
            Reads::Command(drive) => ways[drive].at(row as f64 * interval),
            Reads::Position(JointIndex::Revolute(joint)) => {
                angles.get(joint).copied().unwrap_or_default()
            }
            _ => 0.0,
        };
        Some((0..samples).map(value).collect())
    });
    Recording::of(["run-a.csv", "run-b.csv"][run], interval, samples, columns.collect())
}
