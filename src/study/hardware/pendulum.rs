//! The free swings of one arm: what its authors' viscous model lacks.

use super::Table;
use crate::identify::arm::{self, Declared, MODELS, NEEDED, PLAN, Swinger, Tried};
use crate::identify::swings::{self, Window};
use crate::identify::{Missing, Recorded};
use crate::measure::log::{Channel, Log};
use crate::mechanism::pendulum::Arm;
use crate::scenario::Scenario;
use nalgebra::Vector2;
use std::path::Path;

/// The machine and the columns of its recording, as a scenario.
pub const RIG: &str = include_str!("../../../assets/pendulum.toml");

/// Declared by the authors: the arm, g in m/s², and the viscous friction k in N·m·s.
pub const DECLARED: Declared = Declared {
    arm: Arm { mass: 0.147_584_572, inertia: 1.091_185_05e-4, length: 0.147_754_901 },
    gravity: Vector2::new(0.0, -9.81001),
    viscous: 2.239_401_25e-4,
};

/// The recording is six equal pieces, of which the first four are for fitting.
const PIECES: [usize; 2] = [4, 6];

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
        let recorded = Recorded::read(path, rig, &NEEDED, &NEEDED)?;
        arm::plausible(rig, &recorded)?;
        let log = recorded.log;
        let angles = log.get(Channel::Pose(2)).unwrap_or_default();
        let cut = angles.len() * PIECES[0] / PIECES[1];
        let [id, val] =
            [&angles[..cut], &angles[cut..]].map(|part| swings::windows(part, log.interval, PLAN));
        Ok(Recording { id, val, log })
    }
}

/// A model on the smallest swings, which it was not fitted to.
#[derive(Clone, Debug)]
pub struct Step {
    /// The model, fitted to `id`.
    pub tried: Tried,
    /// Root mean square deviation in rad on `val`, and on each of its windows.
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
    /// The chosen model, fitted to the whole recording.
    pub carried: Swinger,
}

/// Predicted less recorded angle in mrad over one window, over time in s.
pub fn deviation(swinger: &Swinger, window: &Window) -> Vec<(f64, f64)> {
    let points = swings::deviations(&|at| swinger.released(at), window, PLAN);
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
    let (tried, chosen) = arm::search(DECLARED, id, None, &|_| true, &|_| ());
    let steps = tried.into_iter().map(|tried| {
        let (all, windows) = arm::score(&tried.swinger, val);
        Step { tried, val: all, windows }
    });
    let steps = steps.collect();
    let whole: Vec<Window> = id.iter().chain(val).cloned().collect();
    let carried = arm::fitted(DECLARED, MODELS[chosen].1, &whole);
    Outcome { declared: arm::score(&Swinger::declared(DECLARED), val).0, steps, chosen, carried }
}

impl Outcome {
    /// The result in words.
    pub fn lead(&self) -> String {
        let (viscous, chosen) = (&self.steps[0], &self.steps[self.chosen]);
        format!(
            "{} predicts what it was not fitted to with {:.0} % of the error of viscous friction alone \
             ({:.2} instead of {:.2} mrad; {:.2} mrad with the authors' own numbers).",
            sentence(chosen.tried.name),
            100.0 * chosen.val / viscous.val,
            1e3 * chosen.val,
            1e3 * viscous.val,
            1e3 * self.declared,
        )
    }

    /// The numbers of the chosen model.
    pub fn numbers(&self) -> Table {
        let both = [self.steps[self.chosen].tried.swinger, self.carried];
        let row = |name: &str, value: &dyn Fn(&Swinger) -> String| {
            std::iter::once(name.to_owned()).chain(both.iter().map(value)).collect()
        };
        let torque = |factor: f64, s: &Swinger| format!("{:.3e}", factor * s.arm().about_pivot());
        Table {
            header: ["", "fitted to id", "fitted to all of the recording"]
                .map(str::to_owned)
                .to_vec(),
            rows: vec![
                row("m a g/J (1/s²)", &|s| format!("{:.3}", s.stiffness)),
                row("encoder's zero against the vertical (mrad)", &|s| {
                    format!("{:.2}", 1e3 * s.offset)
                }),
                row("viscous friction (N m s)", &|s| torque(s.viscous, s)),
                row("dry friction (N m)", &|s| torque(s.dry, s)),
                row("drag of the air (N m s²)", &|s| torque(s.air, s)),
            ],
        }
    }

    /// Errors model by model.
    pub fn table(&self) -> Table {
        let mrad = |x: f64| format!("{:.2} mrad", 1e3 * x);
        let first = self.steps.first().map_or(f64::NAN, |step| step.val);
        let rows = self.steps.iter().enumerate().map(|(i, step)| {
            let mark = if i == self.chosen { " (chosen)" } else { "" };
            let s = step.tried.swinger;
            vec![
                format!("{}{mark}", step.tried.name),
                format!("{:.3}", s.stiffness),
                format!("{:.4}", s.viscous),
                format!("{:.4}", s.dry),
                format!("{:.5}", s.air),
                mrad(step.tried.fitted),
                mrad(step.tried.chosen_by),
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
