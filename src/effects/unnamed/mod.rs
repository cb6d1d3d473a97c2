//! What a model lacks and nobody can name: forces as a fitted map of what they depend on.

pub(super) mod efforts;
pub(super) mod history;

use super::kind::{defaults, linear};
use super::{Kind, Setting, Targets, Wrong};
use crate::mechanism::{Command, Load, Mechanism, Situation};
use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Its name.
pub const UNNAMED: &str = "unnamed";

pub(super) const KIND: Kind = Kind {
    name: UNNAMED,
    summary: "forces as a map of what they depend on, fitted to data: what has no name here",
    equation: "f_i = sum_k coefficients[i][k] feature_k(depends_on); i: force along x, along y and torque \
               at the platform's centre, or the force on each rod",
    source: "none: a description, not an explanation",
    trace: "wherever it was found",
    targets: Targets::Machine,
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
    /// The output's position and angle: Gaussians over x and y, and φ. Acts on the output.
    Position,
    /// The output's velocity: linear, quadratic with sign, and direction alone. Acts on the output.
    Velocity,
    /// The speed of each actuator by itself: linear, quadratic with sign, direction alone, constant. Acts
    /// on its rod.
    ActuatorVelocity,
    /// The length of each actuator by itself: Gaussians. Acts on its rod.
    ActuatorLength,
    /// The commanded accelerations, by themselves and times the position, and the position. Acts on the
    /// rods.
    Acceleration,
}

impl DependsOn {
    /// All of them, the simplest first.
    pub const ALL: [DependsOn; 5] = [
        DependsOn::ActuatorVelocity,
        DependsOn::ActuatorLength,
        DependsOn::Velocity,
        DependsOn::Acceleration,
        DependsOn::Position,
    ];

    /// Whether such a map acts on the output, rather than on each rod.
    pub fn acts_on_output(self) -> bool {
        matches!(self, DependsOn::Position | DependsOn::Velocity)
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            DependsOn::Position => "the platform's position",
            DependsOn::Velocity => "the platform's velocity",
            DependsOn::ActuatorVelocity => "the speed of each actuator",
            DependsOn::ActuatorLength => "the length of each actuator",
            DependsOn::Acceleration => "the acceleration",
        }
    }
}

/// A fitted map: forces (N, N, N·m at its reference point) on the output, or the force (N) on each rod,
/// outward, from features of the machine's motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Map {
    /// What it is a function of.
    pub depends_on: DependsOn,
    /// Middle of the output's pose (m, m, rad) where it was fitted, and half its range.
    pub middle: [f64; 3],
    /// Half the range of the pose (m, m, rad); at least what a division takes.
    pub reach: [f64; 3],
    /// Middle of the lengths of the actuators in m, and half their range.
    pub lengths: [f64; 2],
    /// N (N·m) per feature: one list for each component of the force on the output, or for each
    /// prismatic joint.
    pub coefficients: Vec<Vec<f64>>,
}

/// Gaussians along x and along y.
const GRID: usize = 5;

/// Gaussians along the length of an actuator: some 10 mm apart, wider than what a screw repeats.
const PLACES: usize = 9;

/// Speeds in m/s (and rad/s) below which a direction is no direction.
const REST: f64 = 5e-3;

/// The motion that a map's features are made of.
#[derive(Clone, Copy, Debug, Default)]
pub struct MapMotion {
    /// Pose of the output (m, m, rad).
    pub pose: Vector3<f64>,
    /// Its velocity (m/s, m/s, rad/s).
    pub rate: Vector3<f64>,
    /// Length (m) and rate (m/s) of the actuator in question.
    pub actuator: [f64; 2],
}

/// Place of the k-th of so many Gaussians between −1 and 1, and a Gaussian as wide as they are apart.
fn place(k: usize, count: usize) -> f64 {
    2.0 * k as f64 / (count - 1) as f64 - 1.0
}

fn gaussian(distance2: f64, count: usize) -> f64 {
    let width = 2.0 / (count - 1) as f64;
    (-0.5 * distance2 / (width * width)).exp()
}

impl Map {
    /// How many components the force has in a machine with so many prismatic joints.
    pub fn components(&self, prismatics: usize) -> usize {
        if self.depends_on.acts_on_output() { 3 } else { prismatics }
    }

    /// Features of a motion; `commands` are those of all actuators.
    pub fn features(&self, motion: MapMotion, commands: &[Command]) -> Vec<f64> {
        let relative = Vector3::from_fn(|i, _| (motion.pose[i] - self.middle[i]) / self.reach[i]);
        let odd = |v: f64| [v, v * v.abs(), (v / REST).tanh()];
        let [length, speed] = motion.actuator;
        match self.depends_on {
            DependsOn::Position => {
                let mut features = vec![1.0, relative.z];
                for i in 0..GRID {
                    for j in 0..GRID {
                        let from = Vector2::new(place(i, GRID), place(j, GRID));
                        features.push(gaussian((relative.xy() - from).norm_squared(), GRID));
                    }
                }
                features
            }
            DependsOn::Velocity => motion.rate.iter().flat_map(|v| odd(*v)).collect(),
            DependsOn::ActuatorVelocity => [[1.0].as_slice(), &odd(speed)].concat(),
            DependsOn::ActuatorLength => {
                let [middle, reach] = self.lengths;
                let relative = (length - middle) / reach;
                let places =
                    (0..PLACES).map(|k| gaussian((relative - place(k, PLACES)).powi(2), PLACES));
                [1.0].into_iter().chain(places).collect()
            }
            DependsOn::Acceleration => {
                let with_place = |a: f64| [a, a * relative.x, a * relative.y, a * relative.z];
                let moving = commands.iter().flat_map(|c| with_place(c.acceleration));
                moving.chain(with_place(1.0)).collect()
            }
        }
    }

    /// Reads the keys of an `[[effect]]` of this kind.
    pub(in crate::effects) fn from_table(table: &toml::Table) -> Result<Self, Wrong> {
        let wrong = |message: &str| Wrong {
            key: "coefficients".to_owned(),
            message: message.to_owned(),
            help: "this effect is written by `freeplay calibrate`: copy it whole".to_owned(),
        };
        let map = Map::deserialize(table.clone()).map_err(|error| wrong(error.message()))?;
        if map.reach.iter().chain(&map.lengths[1..]).any(|reach| *reach <= 0.0) {
            return Err(wrong("stands beside a reach that is not positive"));
        }
        Ok(map)
    }
}

#[derive(Debug)]
struct AppliedMap {
    map: Arc<Map>,
}

impl Load for AppliedMap {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let state = at.mechanism.output_state(at.states);
        let pose = state.position.push(state.rotation.angle());
        let mut commands = vec![Command::default(); at.mechanism.actuators.len()];
        if self.map.depends_on == DependsOn::Acceleration {
            at.mechanism.commands.at(at.t, &mut commands);
        }
        let force = |coefficients: &Vec<f64>, actuator: [f64; 2]| -> f64 {
            let motion = MapMotion { pose, rate: state.twist, actuator };
            let features = self.map.features(motion, &commands);
            features.iter().zip(coefficients).map(|(f, c)| f * c).sum()
        };
        if self.map.depends_on.acts_on_output() {
            let [x, y, torque] =
                [0, 1, 2].map(|i| force(&self.map.coefficients[i], Default::default()));
            at.push_output(Vector2::new(x, y), torque, wrenches);
            return;
        }
        for (leg, coefficients) in self.map.coefficients.iter().enumerate() {
            at.push_rod(leg, force(coefficients, at.length(leg)), wrenches);
        }
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    if let Some(history) = &setting.history {
        return super::unnamed::history::apply(history, setting, mechanism);
    }
    let Some(map) = &setting.map else { return super::unnamed::efforts::apply(setting, mechanism) };
    let components = map.components(mechanism.prismatics.len());
    let commands = vec![Command::default(); mechanism.actuators.len()];
    let features = map.features(MapMotion::default(), &commands).len();
    if map.coefficients.len() != components || map.coefficients.iter().any(|l| l.len() != features)
    {
        let lengths: Vec<usize> = map.coefficients.iter().map(Vec::len).collect();
        return Err(Wrong {
            key: "coefficients".to_owned(),
            message: format!("holds lists of {lengths:?} numbers"),
            help: format!(
                "expected {components} lists of {features}: this effect is copied whole or not at all"
            ),
        });
    }
    mechanism.loads.push(Arc::new(AppliedMap { map: Arc::clone(map) }));
    Ok(())
}
