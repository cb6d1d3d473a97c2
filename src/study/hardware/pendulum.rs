//! The free swings of one arm: what its authors' viscous model lacks.

use super::{Missing, Table};
use crate::effects::{Setting, named};
use crate::identify::swings::{self, Plan, Window};
use crate::measure::log::{Channel, Log, Source};
use crate::mechanism::pendulum::{Arm, build};
use crate::mechanism::{Bearing, Mechanism};
use nalgebra::Vector2;
use std::path::Path;

/// Declared by the authors: the arm, g in m/s², and the viscous friction k in N·m·s.
pub const ARM: Arm = Arm { mass: 0.147_584_572, inertia: 1.091_185_05e-4, length: 0.147_754_901 };
/// See [`ARM`].
pub const GRAVITY: f64 = 9.81001;
/// See [`ARM`].
pub const VISCOUS: f64 = 2.239_401_25e-4;

/// What is predicted: 2.5 s, from its first quarter second.
pub const PLAN: Plan = Plan { window: 2.5, start: 0.25 };

/// The recording is six equal pieces, of which the first four are for fitting.
const PIECES: [usize; 2] = [4, 6];

/// Rate in rad/s below which dry friction gives way: 1 % of the slowest recorded swings'; the fixed step
/// stands it with friction a hundred times the found.
const SIGN_RATE: f64 = 2e-2;

/// What is sought of an arm: only what a free swing shows, m a g/J and friction/J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swinger {
    /// m a g/J in 1/s².
    pub stiffness: f64,
    /// Angle in rad by which the encoder's zero is off the vertical.
    pub offset: f64,
    /// k/J in 1/s.
    pub viscous: f64,
    /// T_c/J in rad/s².
    pub dry: f64,
    /// c_t/J.
    pub air: f64,
}

/// Which of the numbers of a [`Swinger`] are sought, by place.
pub type Sought = &'static [usize];

/// Finite differences of the numbers of a [`Swinger`], and what none may go below.
const STEPS: [f64; 5] = [1e-3, 1e-5, 1e-4, 1e-3, 1e-5];
const LOWER: [f64; 5] = [1.0, -0.5, 0.0, 0.0, 0.0];

impl Swinger {
    /// The authors' arm.
    pub fn declared() -> Self {
        let inertia = ARM.about_pivot();
        Self {
            stiffness: ARM.mass * ARM.length * GRAVITY / inertia,
            offset: 0.0,
            viscous: VISCOUS / inertia,
            dry: 0.0,
            air: 0.0,
        }
    }

    fn numbers(&self) -> [f64; 5] {
        [self.stiffness, self.offset, self.viscous, self.dry, self.air]
    }

    fn with(&self, sought: Sought, values: &[f64]) -> Self {
        let mut numbers = self.numbers();
        for (place, value) in sought.iter().zip(values) {
            numbers[*place] = *value;
        }
        let [stiffness, offset, viscous, dry, air] = numbers;
        Self { stiffness, offset, viscous, dry, air }
    }

    /// The arm whose inertia gives the stiffness, mass and length as declared.
    pub fn arm(&self) -> Arm {
        let about_pivot = ARM.mass * ARM.length * GRAVITY / self.stiffness;
        Arm { inertia: about_pivot - ARM.mass * ARM.length * ARM.length, ..ARM }
    }

    /// Its friction as effects of a scenario; dry friction gives way below `rate` rad/s.
    pub fn effects(&self, rate: f64) -> Vec<Setting> {
        let inertia = self.arm().about_pivot();
        let effect = |name: &str, joint: Option<&str>, values: &[(&'static str, f64)]| {
            named(name).map(|kind| Setting::new(kind, joint, values))
        };
        let friction = [
            ("coulomb_Nm", self.dry * inertia),
            ("viscous_Nms", self.viscous * inertia),
            ("velocity_rad_s", rate),
        ];
        let mut found = Vec::new();
        found.extend(effect("pivot-friction", Some("A1"), &friction));
        if self.air > 0.0 {
            found.extend(effect("air-drag", None, &[("torque_Nms2", self.air * inertia)]));
        }
        found
    }

    /// The pendulum, released at an angle (rad) with a rate (rad/s).
    pub fn released(&self, start: [f64; 2], rate: f64) -> Mechanism {
        let (sin, cos) = self.offset.sin_cos();
        let gravity = Vector2::new(sin, -cos) * GRAVITY;
        let mut mechanism = build(self.arm(), Bearing::Ideal, start, gravity);
        for effect in self.effects(rate) {
            effect
                .apply(&mut mechanism)
                .expect("the joint is there, and the effects suit any joint");
        }
        mechanism
    }
}

/// The recording: angles in rad.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Its samples.
    pub log: Log,
    /// Windows to fit and to score.
    pub id: Vec<Window>,
    /// See `id`.
    pub val: Vec<Window>,
}

impl Recording {
    /// Reads the file.
    ///
    /// # Errors
    /// A file that is not there or not what it should be.
    pub fn read(path: &Path) -> Result<Recording, Missing> {
        let columns = [(Channel::Pose(2), Source::new("theta1_rad", 1.0))];
        let log = super::read(path, &Source::new("t_s", 1.0), &columns)?;
        let angles = log.get(Channel::Pose(2)).unwrap_or_default();
        let cut = angles.len() * PIECES[0] / PIECES[1];
        let [id, val] =
            [&angles[..cut], &angles[cut..]].map(|part| swings::windows(part, log.interval, PLAN));
        Ok(Recording { id, val, log })
    }
}

/// A model and how far off it is: root mean square of the angle in rad.
#[derive(Clone, Debug)]
pub struct Step {
    /// What it has.
    pub name: &'static str,
    /// Its numbers, fitted to `id`.
    pub swinger: Swinger,
    /// On what it was fitted to.
    pub id: f64,
    /// Fitted to the first two thirds of `id`, on the last third: by this a model is chosen.
    pub chosen_by: f64,
    /// On `val`, and on each of its windows.
    pub val: f64,
    /// See `val`.
    pub windows: Vec<f64>,
}

/// What the study comes to.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The authors' numbers as they are, on `val`.
    pub declared: f64,
    /// Model by model; the first is the viscous one.
    pub steps: Vec<Step>,
    /// Index of the model that is chosen without `val`.
    pub chosen: usize,
    /// The chosen model, fitted to the whole recording: for other swings of this pendulum.
    pub carried: Swinger,
}

/// The models: what is sought beside stiffness and offset.
const MODELS: [(&str, Sought); 5] = [
    ("viscous friction (the authors')", &[0, 1, 2]),
    ("+ dry friction", &[0, 1, 2, 3]),
    ("+ drag of the air", &[0, 1, 2, 4]),
    ("+ both", &[0, 1, 2, 3, 4]),
    ("dry friction and drag of the air, not viscous", &[0, 1, 3, 4]),
];

/// Share by which a model with more parameters has to be better before it is chosen.
const WORTH: f64 = 0.05;

fn fitted(sought: Sought, windows: &[Window]) -> Swinger {
    // Friction starts where the recording's first and last swings put it, by order of magnitude.
    let start = Swinger { viscous: 0.03, dry: 0.1, air: 3e-3, ..Swinger::declared() };
    let zero = Swinger { viscous: 0.0, ..Swinger::declared() };
    let pick = |numbers: [f64; 5]| -> Vec<f64> { sought.iter().map(|i| numbers[*i]).collect() };
    let model = |values: &[f64], at: [f64; 2]| zero.with(sought, values).released(at, SIGN_RATE);
    let (steps, lower) = (pick(STEPS), pick(LOWER));
    let values = swings::fit(&model, &pick(start.numbers()), &steps, &lower, windows, PLAN);
    zero.with(sought, &values)
}

/// Root mean square deviation in rad of a model, over all windows and over each.
pub fn score(swinger: &Swinger, windows: &[Window]) -> (f64, Vec<f64>) {
    swings::score(&|at| swinger.released(at, SIGN_RATE), windows, PLAN)
}

/// Does the study.
pub fn study(recording: &Recording) -> Outcome {
    let (id, val) = (&recording.id, &recording.val);
    let (first, last) = id.split_at(id.len() * 2 / 3);
    let steps: Vec<Step> = MODELS
        .iter()
        .map(|(name, sought)| {
            let swinger = fitted(sought, id);
            let (all, windows) = score(&swinger, val);
            let chosen_by = score(&fitted(sought, first), last).0;
            Step { name, swinger, id: score(&swinger, id).0, chosen_by, val: all, windows }
        })
        .collect();
    // The best on the last third of `id`; of those that are as good, the one with fewest parameters,
    // and of these the one that fits best.
    let best = steps.iter().map(|step| step.chosen_by).fold(f64::INFINITY, f64::min);
    let good = |i: &usize| steps[*i].chosen_by <= best * (1.0 + WORTH);
    let order = |a: &usize, b: &usize| {
        let count = |i: usize| MODELS[i].1.len();
        count(*a).cmp(&count(*b)).then(steps[*a].id.total_cmp(&steps[*b].id))
    };
    let chosen = (0..steps.len()).filter(good).min_by(order).unwrap_or(0);
    let whole: Vec<Window> = id.iter().chain(val).cloned().collect();
    let carried = fitted(MODELS[chosen].1, &whole);
    Outcome { declared: score(&Swinger::declared(), val).0, steps, chosen, carried }
}

impl Outcome {
    /// Errors model by model.
    pub fn table(&self) -> Table {
        let mrad = |x: f64| format!("{:.2} mrad", 1e3 * x);
        let first = self.steps.first().map_or(f64::NAN, |step| step.val);
        let rows = self.steps.iter().enumerate().map(|(i, step)| {
            let mark = if i == self.chosen { " (chosen)" } else { "" };
            let s = step.swinger;
            vec![
                format!("{}{mark}", step.name),
                format!("{:.3}", s.stiffness),
                format!("{:.4}", s.viscous),
                format!("{:.4}", s.dry),
                format!("{:.5}", s.air),
                mrad(step.id),
                mrad(step.chosen_by),
                mrad(step.val),
                format!("{:.0} %", 100.0 * step.val / first),
            ]
        });
        let header = [
            "model",
            "m a g/J (1/s²)",
            "k/J (1/s)",
            "T/J (rad/s²)",
            "c/J",
            "id",
            "last third of id by the rest",
            "val",
            "of the viscous model's",
        ];
        Table { header: header.map(str::to_owned).to_vec(), rows: rows.collect() }
    }
}
