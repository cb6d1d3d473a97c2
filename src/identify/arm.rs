//! A recorded pendulum: what a free swing shows of it, and models of its friction.

use super::paired::Ratio;
use super::plausible;
use super::recorded::{Missing, Recorded};
use super::swings::{self, Plan, Window};
use crate::effects::{Setting, named};
use crate::measure::filter::{ZeroPhase, derivative};
use crate::measure::log::Channel;
use crate::mechanism::pendulum::{Arm, build};
use crate::mechanism::{Bearing, Mechanism};
use crate::scenario::{self, Scenario};
use nalgebra::Vector2;
use std::f64::consts::SQRT_2;

/// What is predicted: 2.5 s, from its first quarter second.
pub const PLAN: Plan = Plan { window: 2.5, start: 0.25 };

/// What a recording of a pendulum has to have and may have: its angle.
pub const NEEDED: [Channel; 1] = [Channel::Pose(2)];

/// Angle in rad over which bristles bend before the joint slides: not sought, since large swings do not
/// show it; a ball bearing's are fractions of a degree (Dahl 1968).
const PRESLIDING: f64 = 1e-3;

/// What is declared of a pendulum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Declared {
    /// The arm.
    pub arm: Arm,
    /// Gravity in m/s².
    pub gravity: Vector2<f64>,
    /// Viscous friction k in N·m·s.
    pub viscous: f64,
}

impl Declared {
    /// What a rig declares; none of another machine.
    pub fn of(rig: &Scenario) -> Option<Self> {
        let scenario::Mechanism::Pendulum(kind) = &rig.mechanism else { return None };
        let arm = Arm { mass: kind.mass, inertia: kind.inertia, length: kind.length };
        let viscous = |effect: &Setting| match effect.kind.name {
            "pivot-friction" => effect.value("viscous_Nms"),
            _ => None,
        };
        let viscous = rig.effects.iter().filter_map(viscous).sum();
        Some(Self { arm, gravity: rig.environment.gravity.into(), viscous })
    }

    /// m a g/J in 1/s².
    pub fn stiffness(&self) -> f64 {
        self.arm.mass * self.arm.length * self.gravity.norm() / self.arm.about_pivot()
    }
}

/// What is sought of an arm: only what a free swing shows, m a g/J and friction/J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swinger {
    /// What it departs from.
    pub declared: Declared,
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
pub const STEPS: [f64; 5] = [1e-3, 1e-5, 1e-4, 1e-3, 1e-5];
const LOWER: [f64; 5] = [1.0, -0.5, 0.0, 0.0, 0.0];

impl Swinger {
    /// The arm as declared.
    pub fn declared(declared: Declared) -> Self {
        Self {
            declared,
            stiffness: declared.stiffness(),
            offset: 0.0,
            viscous: declared.viscous / declared.arm.about_pivot(),
            dry: 0.0,
            air: 0.0,
        }
    }

    /// Stiffness, offset, viscous, dry, air.
    pub fn numbers(&self) -> [f64; 5] {
        [self.stiffness, self.offset, self.viscous, self.dry, self.air]
    }

    /// The same with other values of the numbers that are sought.
    pub fn with(&self, sought: Sought, values: &[f64]) -> Self {
        let mut numbers = self.numbers();
        for (place, value) in sought.iter().zip(values) {
            numbers[*place] = *value;
        }
        let [stiffness, offset, viscous, dry, air] = numbers;
        Self { stiffness, offset, viscous, dry, air, ..*self }
    }

    /// The arm whose inertia gives the stiffness, mass and length as declared.
    pub fn arm(&self) -> Arm {
        let Declared { arm, gravity, .. } = self.declared;
        let about_pivot = arm.mass * arm.length * gravity.norm() / self.stiffness;
        Arm { inertia: about_pivot - arm.mass * arm.length * arm.length, ..arm }
    }

    /// Gravity in m/s² against the encoder's zero.
    pub fn gravity(&self) -> Vector2<f64> {
        nalgebra::Rotation2::new(self.offset) * self.declared.gravity
    }

    /// Its friction as effects of a scenario; none that are nothing.
    pub fn effects(&self) -> Vec<Setting> {
        let inertia = self.arm().about_pivot();
        let effect = |name: &str, joint: Option<&str>, values: &[(&'static str, f64)]| {
            named(name).map(|kind| Setting::new(kind, joint, values))
        };
        let mut found = Vec::new();
        if self.viscous > 0.0 {
            let viscous = [("viscous_Nms", self.viscous * inertia)];
            found.extend(effect("pivot-friction", Some("A1"), &viscous));
        }
        if self.dry > 0.0 {
            let dry = [("coulomb_Nm", self.dry * inertia), ("presliding_rad", PRESLIDING)];
            found.extend(effect("bristle-friction", Some("A1"), &dry));
        }
        if self.air > 0.0 {
            found.extend(effect("air-drag", None, &[("torque_Nms2", self.air * inertia)]));
        }
        found
    }

    /// The pendulum, released at an angle (rad) with a rate (rad/s).
    pub fn released(&self, start: [f64; 2]) -> Mechanism {
        let mut mechanism = build(self.arm(), Bearing::Ideal, start, self.gravity());
        for effect in self.effects() {
            effect
                .apply(&mut mechanism)
                .expect("the joint is there, and the effects suit any joint");
        }
        mechanism
    }

    /// A rig with these numbers in place of its inertia, its gravity and its effects.
    pub fn scenario(&self, rig: &Scenario) -> Scenario {
        let mut found = rig.clone();
        if let scenario::Mechanism::Pendulum(kind) = &mut found.mechanism {
            kind.inertia = self.arm().inertia;
        }
        found.environment.gravity = self.gravity().into();
        found.effects = self.effects();
        found
    }
}

/// Makes sure that a recording can be one run of this pendulum in rad.
///
/// # Errors
/// What speaks against it.
pub fn plausible(rig: &Scenario, recorded: &Recorded) -> Result<(), Missing> {
    let (log, sources) = (&recorded.log, &recorded.sources);
    for (channel, source) in sources {
        plausible::one_run(log, *channel, source)?;
    }
    let Some(declared) = Declared::of(rig) else { return Ok(()) };
    let [angle] = NEEDED;
    let law = "the declared arm says how fast it swings";
    let disagreement = |channels: &[Channel], factor: f64| {
        let factor = if channels.is_empty() { 1.0 } else { factor };
        let angles: Vec<f64> =
            log.get(angle).unwrap_or_default().iter().map(|a| a * factor).collect();
        (stiffness(&angles, log.interval) / declared.stiffness() - 1.0).abs()
    };
    Ok(plausible::scale(log, law, sources, &[&[angle]], disagreement)?)
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

/// The models: what is sought beside stiffness and offset.
pub const MODELS: [(&str, Sought); 5] = [
    ("viscous friction", &[0, 1, 2]),
    ("viscous and dry friction", &[0, 1, 2, 3]),
    ("viscous friction and drag of the air", &[0, 1, 2, 4]),
    ("viscous and dry friction and drag of the air", &[0, 1, 2, 3, 4]),
    ("dry friction and drag of the air, not viscous", &[0, 1, 3, 4]),
];

/// The numbers of a model that fit windows best.
pub fn fitted(declared: Declared, sought: Sought, windows: &[Window]) -> Swinger {
    // Friction starts where the recording's first and last swings put it, by order of magnitude.
    let start = Swinger { viscous: 0.03, dry: 0.1, air: 3e-3, ..Swinger::declared(declared) };
    let zero = Swinger { viscous: 0.0, ..Swinger::declared(declared) };
    let pick = |numbers: [f64; 5]| -> Vec<f64> { sought.iter().map(|i| numbers[*i]).collect() };
    let model = |values: &[f64], at: [f64; 2]| zero.with(sought, values).released(at);
    let (steps, lower) = (pick(STEPS), pick(LOWER));
    let values = swings::fit(&model, &pick(start.numbers()), &steps, &lower, windows, PLAN);
    zero.with(sought, &values)
}

/// Root mean square deviation in rad of a model, over all windows and over each.
pub fn score(swinger: &Swinger, windows: &[Window]) -> (f64, Vec<f64>) {
    swings::score(&|at| swinger.released(at), windows, PLAN)
}

/// A model, and how far off it is.
#[derive(Clone, Debug)]
pub struct Tried {
    /// What it has.
    pub name: &'static str,
    /// What was sought.
    pub sought: Sought,
    /// Its numbers, fitted to all windows.
    pub swinger: Swinger,
    /// Root mean square deviation in rad on what it was fitted to.
    pub fitted: f64,
    /// The same on windows that it was not fitted to: by this a model is chosen.
    pub chosen_by: f64,
    /// The same for each window, in their order.
    pub each: Vec<f64>,
}

/// Tries all models that are `allowed` on some windows, and says which to choose: of those that are not
/// certainly worse than the best on windows that they were not fitted to (the 95 % interval of the
/// windows' mean logarithmic ratio holds 1), the one with fewest parameters, and of these the one that is
/// best there. These windows are `held`, or, without any, every other window by a model of the rest.
pub fn search(
    declared: Declared,
    windows: &[Window],
    held: Option<&[Window]>,
    allowed: &dyn Fn(Sought) -> bool,
    tell: &dyn Fn(&str),
) -> (Vec<Tried>, usize) {
    let every_other =
        |first: usize| -> Vec<Window> { windows.iter().skip(first).step_by(2).cloned().collect() };
    let [even, odd] = [every_other(0), every_other(1)];
    let tried: Vec<Tried> = MODELS
        .iter()
        .filter(|(_, sought)| allowed(sought))
        .map(|(name, sought)| {
            tell(&format!("fitting {name}"));
            let swinger = fitted(declared, sought, windows);
            let (chosen_by, each) = if let Some(held) = held {
                score(&swinger, held)
            } else {
                let across =
                    |by: &[Window], on: &[Window]| score(&fitted(declared, sought, by), on);
                let [(on_odd, odds), (on_even, evens)] = [across(&even, &odd), across(&odd, &even)];
                let each = (0..windows.len())
                    .filter_map(|i| [&evens, &odds][i % 2].get(i / 2).copied())
                    .collect();
                (on_odd.hypot(on_even) / SQRT_2, each)
            };
            Tried { name, sought, swinger, fitted: score(&swinger, windows).0, chosen_by, each }
        })
        .collect();
    let by_score = |a: &&Tried, b: &&Tried| a.chosen_by.total_cmp(&b.chosen_by);
    let best = tried.iter().min_by(by_score).map(|t| t.each.clone()).unwrap_or_default();
    let good = |i: &usize| Ratio::of(&tried[*i].each, &best).ci95[0] <= 1.0;
    let order = |a: &usize, b: &usize| {
        let count = |i: usize| tried[i].sought.len();
        count(*a).cmp(&count(*b)).then(tried[*a].chosen_by.total_cmp(&tried[*b].chosen_by))
    };
    let chosen = (0..tried.len()).filter(good).min_by(order).unwrap_or(0);
    (tried, chosen)
}
