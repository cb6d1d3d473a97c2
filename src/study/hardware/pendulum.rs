//! The free swings of one arm: what its authors' viscous model lacks.

use super::{Missing, Table};
use crate::effects::{Setting, named};
use crate::identify::plausible;
use crate::identify::swings::{self, Plan, Window};
use crate::measure::filter::{ZeroPhase, derivative};
use crate::measure::log::{Channel, Log};
use crate::mechanism::pendulum::{Arm, build};
use crate::mechanism::{Bearing, Mechanism};
use crate::scenario::Scenario;
use nalgebra::Vector2;
use std::f64::consts::SQRT_2;
use std::path::Path;

/// The machine and the columns of its recording, as a scenario.
pub const RIG: &str = include_str!("../../../assets/pendulum.toml");

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
    /// Reads a recording of a rig.
    ///
    /// # Errors
    /// A file that is not there or not what it should be.
    pub fn read(path: &Path, rig: &Scenario) -> Result<Recording, Missing> {
        let angle = Channel::Pose(2);
        let (time, sources) = super::sources(rig, &[angle])?;
        let log = super::read(path, &time, &sources, &[angle])?;
        for (channel, source) in &sources {
            plausible::one_run(&log, *channel, source)?;
        }
        let law = "the declared arm says how fast it swings";
        let disagreement = |channels: &[Channel], factor: f64| {
            let factor = if channels.is_empty() { 1.0 } else { factor };
            let angles: Vec<f64> =
                log.get(angle).unwrap_or_default().iter().map(|a| a * factor).collect();
            (stiffness(&angles, log.interval) / Swinger::declared().stiffness - 1.0).abs()
        };
        plausible::scale(&log, law, &sources, &[&[angle]], disagreement)?;
        let angles = log.get(Channel::Pose(2)).unwrap_or_default();
        let cut = angles.len() * PIECES[0] / PIECES[1];
        let [id, val] =
            [&angles[..cut], &angles[cut..]].map(|part| swings::windows(part, log.interval, PLAN));
        Ok(Recording { id, val, log })
    }
}

/// m a g/J in 1/s² by regression of θ̈ on sin θ, both filtered alike: rough, and wrong by decades where a
/// unit is.
fn stiffness(angles: &[f64], interval: f64) -> f64 {
    // 20 Hz leaves swings of 1.3 Hz alone.
    let filter = ZeroPhase::butterworth(4, 20.0, interval);
    let angles = filter.apply(angles);
    let accelerations = derivative(&derivative(&angles, interval), interval);
    let pairs = || angles.iter().map(|angle| angle.sin()).zip(&accelerations);
    pairs().map(|(sin, a)| sin * a).sum::<f64>() / pairs().map(|(sin, _)| sin * sin).sum::<f64>()
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
    /// Every other window of `id` by a model of the rest, both ways: by this a model is chosen.
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
    /// Index of the model that is chosen, by a rule that does not look at `val` (but was settled with
    /// `val` known).
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

/// Share by which a model with more parameters has to be better before it is chosen. Viscous and dry
/// friction trade places within one range of amplitudes at little cost, and not outside it.
const WORTH: f64 = 0.1;

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

/// Predicted less recorded angle in mrad over one window, over time in s.
pub fn deviation(swinger: &Swinger, window: &Window) -> Vec<(f64, f64)> {
    let points = swings::deviations(&|at| swinger.released(at, SIGN_RATE), window, PLAN);
    points.into_iter().map(|(t, d)| (t, 1e3 * d)).collect()
}

/// With a capital.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// Does the study.
pub fn study(recording: &Recording) -> Outcome {
    let (id, val) = (&recording.id, &recording.val);
    let every_other =
        |first: usize| -> Vec<Window> { id.iter().skip(first).step_by(2).cloned().collect() };
    let [even, odd] = [every_other(0), every_other(1)];
    let steps: Vec<Step> = MODELS
        .iter()
        .map(|(name, sought)| {
            let swinger = fitted(sought, id);
            let (all, windows) = score(&swinger, val);
            let across = |by: &[Window], on: &[Window]| score(&fitted(sought, by), on).0;
            let chosen_by = across(&even, &odd).hypot(across(&odd, &even)) / SQRT_2;
            Step { name, swinger, id: score(&swinger, id).0, chosen_by, val: all, windows }
        })
        .collect();
    // The best across `id`; of those that are as good, the one with fewest parameters,
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
    /// The result in words.
    pub fn lead(&self) -> String {
        let (viscous, chosen) = (&self.steps[0], &self.steps[self.chosen]);
        format!(
            "{} predicts what it was not fitted to with {:.0} % of the error of viscous friction alone \
             ({:.2} instead of {:.2} mrad; {:.2} mrad with the authors' own numbers).",
            sentence(chosen.name),
            100.0 * chosen.val / viscous.val,
            1e3 * chosen.val,
            1e3 * viscous.val,
            1e3 * self.declared,
        )
    }

    /// The chosen model, fitted to the whole recording.
    pub fn numbers(&self) -> Table {
        let s = self.carried;
        let inertia = s.arm().about_pivot();
        let row = |name: &str, value: String| vec![name.to_owned(), value];
        Table {
            header: vec!["fitted to all of the recording".to_owned(), String::new()],
            rows: vec![
                row("m a g/J", format!("{:.3} 1/s²", s.stiffness)),
                row("encoder's zero against the vertical", format!("{:.2} mrad", 1e3 * s.offset)),
                row("viscous friction", format!("{:.3e} N m s", s.viscous * inertia)),
                row("dry friction", format!("{:.3e} N m", s.dry * inertia)),
                row("drag of the air", format!("{:.3e} N m s²", s.air * inertia)),
            ],
        }
    }

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
            "every other window of id by the rest",
            "val",
            "of the viscous model's",
        ];
        Table { header: header.map(str::to_owned).to_vec(), rows: rows.collect() }
    }
}
