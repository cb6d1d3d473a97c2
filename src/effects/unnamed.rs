//! What a model lacks and nobody can name: a force on each rod as a fitted map of what it depends on.

use super::kind::{defaults, linear};
use super::{Joints, Kind, Setting, Wrong};
use crate::mechanism::{Command, Load, Mechanism, Situation};
use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

pub(super) const KIND: Kind = Kind {
    name: "unnamed",
    summary: "a force on each rod as a map of what it depends on, fitted to data: what has no name here",
    equation: "f_i = sum_k coefficients[i][k] feature_k(depends_on)",
    source: "none: a description, not an explanation",
    trace: "wherever it was found",
    joints: Joints::None,
    parameters: &[],
    // Nothing to search for by this way: it is what remains when the search is over.
    variants: &[],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

/// What a map is a function of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DependsOn {
    /// The output's position and angle: Gaussians over x and y, and φ.
    Position,
    /// The output's velocity: linear, quadratic with sign, and direction alone.
    Velocity,
    /// The speed of each actuator by itself: linear, quadratic with sign, direction alone, constant.
    ActuatorVelocity,
    /// The commanded accelerations, by themselves and times the position.
    Acceleration,
}

impl DependsOn {
    /// All of them, the simplest first.
    pub const ALL: [DependsOn; 4] = [
        DependsOn::ActuatorVelocity,
        DependsOn::Velocity,
        DependsOn::Acceleration,
        DependsOn::Position,
    ];

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            DependsOn::Position => "the platform's position",
            DependsOn::Velocity => "the platform's velocity",
            DependsOn::ActuatorVelocity => "the speed of each actuator",
            DependsOn::Acceleration => "the acceleration",
        }
    }
}

/// A fitted map: the force in N on each rod, outward, from features of the machine's motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Map {
    /// What it is a function of.
    pub depends_on: DependsOn,
    /// Middle of the output's pose (m, m, rad) where it was fitted, and half its range.
    pub middle: [f64; 3],
    /// Half the range of the pose (m, m, rad); at least what a division takes.
    pub reach: [f64; 3],
    /// N per feature: one list for each prismatic joint.
    pub coefficients: Vec<Vec<f64>>,
}

/// Gaussians along x and along y.
const GRID: usize = 5;

/// Speeds in m/s (and rad/s) below which a direction is no direction.
const REST: f64 = 5e-3;

/// Value of commands and motion that a map's features are made of.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Pose of the output (m, m, rad).
    pub pose: Vector3<f64>,
    /// Its velocity (m/s, m/s, rad/s).
    pub rate: Vector3<f64>,
}

impl Map {
    /// Features for prismatic joint `leg`, whose rod moves at `speed` m/s.
    pub fn features(&self, motion: Motion, commands: &[Command], speed: f64) -> Vec<f64> {
        let relative = Vector3::from_fn(|i, _| (motion.pose[i] - self.middle[i]) / self.reach[i]);
        let odd = |v: f64| [v, v * v.abs(), (v / REST).tanh()];
        match self.depends_on {
            DependsOn::Position => {
                // Centres from edge to edge, as wide as they are apart.
                let place = |k: usize| 2.0 * k as f64 / (GRID - 1) as f64 - 1.0;
                let width = 2.0 / (GRID - 1) as f64;
                let mut features = vec![1.0, relative.z];
                for i in 0..GRID {
                    for j in 0..GRID {
                        let from = Vector2::new(place(i), place(j));
                        let distance2 = (relative.xy() - from).norm_squared();
                        features.push((-0.5 * distance2 / (width * width)).exp());
                    }
                }
                features
            }
            DependsOn::Velocity => motion.rate.iter().flat_map(|v| odd(*v)).collect(),
            DependsOn::ActuatorVelocity => [[1.0].as_slice(), &odd(speed)].concat(),
            DependsOn::Acceleration => commands
                .iter()
                .flat_map(|c| {
                    let a = c.acceleration;
                    [a, a * relative.x, a * relative.y, a * relative.z]
                })
                .collect(),
        }
    }

    /// Reads the keys of an `[[effect]]` of this kind.
    pub(super) fn from_table(table: &toml::Table) -> Result<Self, Wrong> {
        Map::deserialize(table.clone()).map_err(|error| Wrong {
            key: "coefficients".to_owned(),
            message: error.message().to_owned(),
            help: "this effect is written by `freeplay calibrate`: copy it whole".to_owned(),
        })
    }
}

#[derive(Debug)]
struct Applied {
    map: Arc<Map>,
}

impl Load for Applied {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let state = at.mechanism.output_state(at.states);
        let pose = state.position.push(state.rotation.angle());
        let motion = Motion { pose, rate: state.twist };
        let mut commands = vec![Command::default(); at.mechanism.prismatics.len()];
        if self.map.depends_on == DependsOn::Acceleration {
            at.mechanism.commands.at(at.t, &mut commands);
        }
        for (leg, coefficients) in self.map.coefficients.iter().enumerate() {
            let [_, speed] = at.length(leg);
            let features = self.map.features(motion, &commands, speed);
            let force = features.iter().zip(coefficients).map(|(f, c)| f * c).sum();
            at.push_rod(leg, force, wrenches);
        }
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let Some(map) = &setting.map else { return Ok(()) };
    if map.coefficients.len() != mechanism.prismatics.len() {
        return Err(Wrong {
            key: "coefficients".to_owned(),
            message: format!("holds {} lists", map.coefficients.len()),
            help: format!("expected one for each of {} actuators", mechanism.prismatics.len()),
        });
    }
    mechanism.loads.push(Arc::new(Applied { map: Arc::clone(map) }));
    Ok(())
}
