//! What is said of an effect once, whatever machine it acts on.

use super::{Setting, Wrong};
use crate::mechanism::Mechanism;

/// One number of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name, with the unit at its end, as in `mass_kg`.
    pub name: &'static str,
    /// Unit in words; empty for a pure number.
    pub unit: &'static str,
    /// What it means.
    pub about: &'static str,
    /// Smallest and largest value that make sense.
    pub bounds: [f64; 2],
    /// A small value by its own measure: what a finite difference takes, and about what can be told
    /// from nothing on a machine like the paper's.
    pub step: f64,
    /// Value where none is given; `None` where the effect's own text says what then holds.
    pub default: Option<f64>,
}

impl Parameter {
    /// The size of something that is not there at 0, its default, and of which more than `most` makes no
    /// sense.
    pub(super) const fn size(
        name: &'static str,
        unit: &'static str,
        about: &'static str,
        most: f64,
        step: f64,
    ) -> Self {
        Self { name, unit, about, bounds: [0.0, most], step, default: Some(0.0) }
    }
}

/// Which joints an effect can be given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joints {
    /// None: it acts on the whole machine.
    None,
    /// One prismatic joint.
    Prismatic,
    /// One prismatic joint, or all of them when none is named.
    PrismaticOrAll,
    /// One revolute joint whose ring is on the ground.
    Anchor,
    /// One revolute joint.
    Revolute,
    /// One revolute joint, or all of them when none is named.
    RevoluteOrAll,
}

/// How a repeating effect is found: over which period or frequency, and by which phase. At each
/// frequency the response is linear in amplitude times sine and cosine of the phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scan {
    /// The parameter that is scanned.
    pub over: &'static str,
    /// The parameter that is a phase in rad.
    pub phase: &'static str,
    /// What is tried.
    pub range: Range,
}

/// Values that a [`Scan`] tries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// Frequencies in Hz at which the residual stands out.
    Peaks,
    /// Periods `1/k` for wave numbers k from the first to the second by steps of the third.
    WaveNumbers([f64; 3]),
}

/// An effect by name, with everything that a user and a search need to know of it.
#[derive(Debug)]
pub struct Kind {
    /// Its name in files.
    pub name: &'static str,
    /// What it is, in one line.
    pub summary: &'static str,
    /// Its equation.
    pub equation: &'static str,
    /// Where the equation comes from.
    pub source: &'static str,
    /// Where its trace shows in measured data.
    pub trace: &'static str,
    /// Which joints it can be given.
    pub joints: Joints,
    /// Its numbers.
    pub parameters: &'static [Parameter],
    /// Sets of parameters that a search leaves free together, from the simplest on; the others keep
    /// their defaults.
    pub variants: &'static [&'static [&'static str]],
    /// The values (of a variant's parameters) at which the effect changes nothing.
    pub neutral: fn(&Mechanism, &Setting) -> Vec<f64>,
    /// Where a search starts beside the neutral point, for parameters in which the machine's response
    /// is not linear: values of a variant's parameters. Empty where neutral is enough.
    pub starts: fn(variant: &[&str]) -> Vec<Vec<f64>>,
    /// How to find a repeating effect, if it is one.
    pub scan: Option<Scan>,
    /// Changes a mechanism as the effect does.
    pub apply: fn(&Setting, &mut Mechanism) -> Result<(), Wrong>,
}

impl Kind {
    /// The parameter called `name`.
    pub fn parameter(&self, name: &str) -> Option<&'static Parameter> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }

    /// Names of the joints of `mechanism` that this effect can be given one of.
    pub fn joints_of(&self, mechanism: &Mechanism) -> Vec<String> {
        match self.joints {
            Joints::None => Vec::new(),
            Joints::Prismatic | Joints::PrismaticOrAll => {
                mechanism.prismatics.iter().map(|joint| joint.name.clone()).collect()
            }
            Joints::Anchor => mechanism
                .revolutes
                .iter()
                .filter(|joint| joint.ring.body.is_none())
                .map(|joint| joint.name.clone())
                .collect(),
            Joints::Revolute | Joints::RevoluteOrAll => {
                mechanism.revolutes.iter().map(|joint| joint.name.clone()).collect()
            }
        }
    }
}

/// The neutral point of effects that vanish where all their numbers have their defaults; a number
/// without one takes 0.
pub(super) fn defaults(_: &Mechanism, setting: &Setting) -> Vec<f64> {
    let default = |name| setting.kind.parameter(name).and_then(|p| p.default).unwrap_or(0.0);
    setting.values().map(|(name, _)| default(name)).collect()
}

/// The starts of effects to which the machine responds linearly.
pub(super) fn linear(_: &[&str]) -> Vec<Vec<f64>> {
    Vec::new()
}
