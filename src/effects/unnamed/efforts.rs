//! What a mechanism lacks and nobody can name: efforts in its joints, or forces on its output, as a fitted table of what
//! they depend on.

use crate::effects::Wrong;
use crate::mechanism::{JointIndex, Load, Mechanism, Situation, angle_near};
use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::sync::Arc;

/// What efforts in joints, or forces on the output, are a function of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Over {
    /// The rate of each joint by itself: constant, linear, quadratic with sign, direction alone.
    JointRate,
    /// The coordinate of each joint by itself: Gaussians; harmonics of a joint that turns over.
    JointPosition,
    /// The coordinates of all joints together: Gaussians over a grid of two, or those of each in a sum.
    Position,
    /// The velocity of the output, each part by itself: linear, quadratic with sign, direction alone. Acts on the output.
    OutputVelocity,
    /// Where the output is, as it may stand in machines of more than two freedoms: Gaussians over a grid of its x and y, and
    /// its angle. Acts on the output.
    OutputPosition,
}

impl Over {
    /// All of them, the simplest first.
    pub const ALL: [Over; 5] = [
        Over::JointRate,
        Over::JointPosition,
        Over::OutputVelocity,
        Over::Position,
        Over::OutputPosition,
    ];

    /// Whether forces act on the output, rather than efforts on each joint.
    pub fn acts_on_output(self) -> bool {
        matches!(self, Over::OutputVelocity | Over::OutputPosition)
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Over::JointRate => "the speed of each joint",
            Over::JointPosition => "the coordinate of each joint",
            Over::Position => "the machine's position",
            Over::OutputVelocity => "the output's velocity",
            Over::OutputPosition => "the output's position",
        }
    }
}

/// A fitted table: the effort (N or N·m) on the slider or the journal's body of each joint, from features of
/// the joints' motion; or the force (N) and torque (N·m) at the output's reference point, from features of its motion, whose
/// coordinates are its place (m) and angle (rad).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Efforts {
    /// What it is a function of.
    pub depends_on: Over,
    /// The joints; none where it acts on the output.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joints: Vec<String>,
    /// Middle of each coordinate (m or rad) where it was fitted.
    pub middle: Vec<f64>,
    /// Half the range of each coordinate.
    pub reach: Vec<f64>,
    /// Largest rate of each (m/s or rad/s) there.
    pub rates: Vec<f64>,
    /// N or N·m per feature, one list for each joint or coordinate of the output.
    pub coefficients: Vec<Vec<f64>>,
}

/// Gaussians along each of two coordinates: what varies over a third of a working space is held.
const GRID: usize = 7;

/// Harmonics of a joint that turns over.
const HARMONICS: usize = 6;

/// Gaussians along one coordinate, about half as far apart as on a grid: as many as numbers of harmonics, so that joints that
/// turn over and joints that do not stand in one table.
const PLACES: usize = 2 * HARMONICS;

/// Share of the largest rate below which a direction is no direction.
const REST: f64 = 0.01;

/// Places between −1 and 1, evenly, and a Gaussian as wide as they are apart around each.
pub(super) fn gaussians(relative: f64, count: usize) -> impl Iterator<Item = f64> {
    let width = 2.0 / (count - 1) as f64;
    (0..count).map(move |k| (-0.5 * ((relative + 1.0) / width - k as f64).powi(2)).exp())
}

impl Efforts {
    /// A table over a motion with these middles, reaches and largest rates, without coefficients.
    pub fn empty(depends_on: Over, joints: Vec<String>, ranges: &[[f64; 3]]) -> Self {
        // A coordinate that does not vary has no scale of its own: a tenth of a millimetre or milliradian.
        let part = |k: usize| ranges.iter().map(|range| range[k].max(1e-4)).collect();
        let middle = ranges.iter().map(|range| range[0]).collect();
        let (reach, rates) = (part(1), part(2));
        Self { depends_on, joints, middle, reach, rates, coefficients: Vec::new() }
    }

    /// How many coordinates it is a function of, and how many efforts it has.
    pub fn coordinates(&self) -> usize {
        if self.depends_on.acts_on_output() { 3 } else { self.joints.len() }
    }

    /// Features of the effort along coordinate `own` (by its place) at coordinates and rates of all.
    pub fn features(&self, own: usize, positions: &[f64], rates: &[f64]) -> Vec<f64> {
        let relative = |k: usize| (positions[k] - self.middle[k]) / self.reach[k];
        let along = |k: usize| -> Vec<f64> {
            // Half a turn either way: what it meets it meets again.
            if self.reach[k] >= PI {
                let wave = |n: usize| (n as f64 * positions[k]).sin_cos();
                return (1..=HARMONICS).map(wave).flat_map(|(sin, cos)| [sin, cos]).collect();
            }
            gaussians(relative(k), PLACES).collect()
        };
        let odd = |k: usize| {
            let v = rates[k] / self.rates[k];
            [v, v * v.abs(), (v / REST).tanh()]
        };
        let grid = || {
            let second: Vec<f64> = gaussians(relative(1), GRID).collect();
            let over = |first: f64| second.iter().map(move |second| first * second);
            gaussians(relative(0), GRID).flat_map(over).collect::<Vec<f64>>()
        };
        let mut features = vec![1.0];
        match self.depends_on {
            Over::JointRate => features.extend(odd(own)),
            Over::JointPosition => features.extend(along(own)),
            Over::Position if self.joints.len() == 2 && self.reach.iter().all(|r| *r < PI) => {
                features.extend(grid());
            }
            Over::Position => features.extend((0..self.joints.len()).flat_map(along)),
            Over::OutputVelocity => features.extend((0..self.coordinates()).flat_map(odd)),
            Over::OutputPosition => {
                features.push(relative(2));
                features.extend(grid());
            }
        }
        features
    }

    /// The effort (N or N·m) along coordinate `own` at coordinates and rates of all.
    pub fn effort(&self, own: usize, positions: &[f64], rates: &[f64]) -> f64 {
        let features = self.features(own, positions, rates);
        features.iter().zip(&self.coefficients[own]).map(|(f, c)| f * c).sum()
    }

    /// Reads the keys of an `[[effect]]` of this kind.
    pub(in crate::effects) fn from_table(table: &toml::Table) -> Result<Self, Wrong> {
        let wrong = |message: &str| Wrong::torn("coefficients", message);
        let read = Self::deserialize(table.clone()).map_err(|error| wrong(error.message()))?;
        let coordinates = read.coordinates();
        let lists = [&read.middle, &read.reach, &read.rates].map(Vec::len);
        if lists.iter().any(|length| *length != coordinates)
            || read.coefficients.len() != coordinates
        {
            return Err(wrong("has lists that do not fit the number of its coordinates"));
        }
        if read.depends_on.acts_on_output() && !read.joints.is_empty() {
            return Err(wrong("acts on the output, and names joints"));
        }
        if read.reach.iter().chain(&read.rates).any(|scale| *scale <= 0.0) {
            return Err(wrong("has a reach or a rate that is not positive"));
        }
        let still = vec![0.0; coordinates];
        let fits = |(own, list): (usize, &Vec<f64>)| {
            list.len() == read.features(own, &read.middle, &still).len()
        };
        if !read.coefficients.iter().enumerate().all(fits) {
            return Err(wrong("has lists that do not fit what it depends on"));
        }
        Ok(read)
    }
}

/// A table at work in a machine.
#[derive(Debug)]
struct AppliedEfforts {
    table: Arc<Efforts>,
    joints: Vec<JointIndex>,
}

impl Load for AppliedEfforts {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        if self.table.depends_on.acts_on_output() {
            let state = at.mechanism.output_state(at.states);
            let angle = angle_near(state.rotation, self.table.middle[2]);
            let place = state.position.push(angle);
            let [x, y, torque] = [0, 1, 2]
                .map(|own| self.table.effort(own, place.as_slice(), state.twist.as_slice()));
            return at.push_output(Vector2::new(x, y), torque, wrenches);
        }
        let motion: Vec<[f64; 2]> = self
            .joints
            .iter()
            .zip(&self.table.middle)
            .map(|(joint, middle)| at.coordinate(*joint, *middle))
            .collect();
        let [positions, rates]: [Vec<f64>; 2] =
            [0, 1].map(|k| motion.iter().map(|coordinate| coordinate[k]).collect());
        for (own, joint) in self.joints.iter().enumerate() {
            at.push_joint(*joint, self.table.effort(own, &positions, &rates), wrenches);
        }
    }
}

/// The joints that a table names.
pub(super) fn named_joints(
    names: &[String],
    mechanism: &Mechanism,
) -> Result<Vec<JointIndex>, Wrong> {
    let known = || mechanism.joints().map(|(name, _)| name);
    let find = |name: &String| {
        let joint = mechanism.joints().find(|(known, _)| known == name);
        let wrong = || Wrong::of_another_machine("joints", "joint", name, known());
        joint.map(|(_, joint)| joint).ok_or_else(wrong)
    };
    names.iter().map(find).collect()
}

pub(super) fn apply(table: &Arc<Efforts>, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let joints = named_joints(&table.joints, mechanism)?;
    mechanism.loads.push(Arc::new(AppliedEfforts { table: Arc::clone(table), joints }));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::rigs::{WHEEL_AND_SLIDE, ended};

    /// A constant effort accelerates a wheel and a slide evenly: `ω(t) = ω₀ + T t/I`, `v(t) = v₀ + F t/m`.
    #[test]
    fn a_table_pushes_its_joints() {
        let effect = "[[effect]]\nkind = \"unnamed\"\ndepends_on = \"joint-rate\"\njoints = [\"O\", \"S\"]\n\
                      middle = [0.0, 0.0]\nreach = [1.0, 1.0]\nrates = [1.0, 1.0]\n\
                      coefficients = [[0.3, 0.0, 0.0, 0.0], [4.0, 0.0, 0.0, 0.0]]\n";
        let [wheel, slide] = ended(&format!("{WHEEL_AND_SLIDE}{effect}"), 0.1);
        assert!((wheel.twist.z - (5.0 + 0.3 / 0.02 * 0.1)).abs() < 1e-6, "{}", wheel.twist.z);
        assert!((slide.twist.x - (0.5 + 4.0 / 2.0 * 0.1)).abs() < 1e-6, "{}", slide.twist.x);
    }

    /// A constant force on the output accelerates it evenly, and a drag that grows with its velocity slows it down:
    /// `v(t) = v₀ exp(−c t/(v_r m))`, c being the coefficient of `v/v_r`.
    #[test]
    fn a_table_pushes_the_output() {
        let ended = |depends_on, rest: usize, x: [f64; 2]| {
            let list = |first: [f64; 2]| {
                let numbers = [first.to_vec(), vec![0.0; rest]].concat();
                format!("{numbers:?}")
            };
            let lists = [list(x), list([0.0; 2]), list([0.0; 2])].join(", ");
            let effect = format!(
                "[[output]]\nbody = \"slide\"\n[[effect]]\nkind = \"unnamed\"\n\
                 depends_on = \"{depends_on}\"\nmiddle = [0.0, 1.0, 0.0]\nreach = [1.0, 1.0, 1.0]\n\
                 rates = [0.5, 1.0, 1.0]\ncoefficients = [{lists}]\n"
            );
            ended(&format!("{WHEEL_AND_SLIDE}{effect}"), 0.1)[1].twist.x
        };
        let pushed = ended("output-position", 49, [4.0, 0.0]);
        assert!((pushed - (0.5 + 4.0 / 2.0 * 0.1)).abs() < 1e-6, "{pushed}");
        let slowed = ended("output-velocity", 8, [0.0, -3.0]);
        assert!((slowed - 0.5 * (-3.0f64 * 0.1 / (0.5 * 2.0)).exp()).abs() < 1e-6, "{slowed}");
    }

    #[test]
    fn tables_that_do_not_fit_are_refused() {
        let table = |text: &str| toml::from_str::<toml::Table>(text).unwrap_or_default();
        let head = "depends_on = \"joint-rate\"\njoints = [\"O\"]\nmiddle = [0.0]\nrates = [1.0]\n";
        for bad in [
            "reach = [1.0]\ncoefficients = [[1.0]]",
            "reach = [1.0, 2.0]\ncoefficients = [[1.0, 0.0, 0.0, 0.0]]",
            "reach = [0.0]\ncoefficients = [[1.0, 0.0, 0.0, 0.0]]",
            "reach = [1.0]\ncoefficients = [[1.0]]\nlengths = [0.3]",
        ] {
            assert!(Efforts::from_table(&table(&format!("{head}{bad}"))).is_err(), "{bad}");
        }
        let output = "depends_on = \"output-velocity\"\njoints = [\"O\"]\nmiddle = [0.0, 0.0, 0.0]\n\
                      reach = [1.0, 1.0, 1.0]\nrates = [1.0, 1.0, 1.0]\n";
        let lists = vec![vec![0.0; 10]; 3];
        let wrong = Efforts::from_table(&table(&format!("{output}coefficients = {lists:?}")));
        assert!(wrong.is_err_and(|wrong| wrong.message.contains("names joints")));
        let good = "reach = [1.0]\ncoefficients = [[1.0, 0.0, 0.0, 0.0]]";
        assert!(Efforts::from_table(&table(&format!("{head}{good}"))).is_ok());
    }

    /// Joints that turn over and joints that do not stand in one table.
    #[test]
    fn every_joint_has_as_many_features() {
        let ranges = [[0.0, 1.0, 1.0], [0.0, 10.0, 1.0], [0.0, 1.0, 1.0]];
        for depends_on in Over::ALL {
            let joints = ["A", "B", "C"].map(str::to_owned).to_vec();
            let table = Efforts::empty(depends_on, joints, &ranges);
            let count = |own: usize| table.features(own, &[0.0; 3], &[0.0; 3]).len();
            assert!([count(1), count(2)] == [count(0); 2], "{depends_on:?}");
        }
    }

    /// Harmonics repeat after a turn.
    #[test]
    fn what_turns_over_meets_the_same_again() {
        let table = Efforts::empty(Over::JointPosition, vec!["O".into()], &[[0.0, 10.0, 1.0]]);
        let [a, b] = [0.4, 0.4 + 2.0 * PI].map(|q| table.features(0, &[q], &[0.0]));
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-12));
    }
}
