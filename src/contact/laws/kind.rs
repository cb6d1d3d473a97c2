//! What is said of a law once, whatever joint it acts in.

use super::damped::Damped;
use super::loss::Loss;
use super::spring::PowerSpring;
use crate::contact::{ForceLaw, Material, StiffnessForm, hertz_stiffness};
use std::sync::Arc;

/// A normal force law by name.
///
/// ```
/// use freeplay::contact::laws::{ALL, Given, named};
///
/// let kind = named("kelvin-voigt").unwrap();
/// assert!(!kind.equation.is_empty() && named("kelvin").is_none());
/// // Every law of the list bears a load at some depth.
/// for kind in ALL {
///     let depth = (kind.build)(&Given::default()).resting_penetration(10.0);
///     assert!(depth > 0.0 && depth < 1e-3, "{}: {depth}", kind.name);
/// }
/// ```
#[derive(Debug)]
pub struct LawKind {
    /// Name in scenarios.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub summary: &'static str,
    /// Its equation.
    pub equation: &'static str,
    /// Where that comes from.
    pub source: &'static str,
    /// Where it holds.
    pub validity: &'static str,
    /// Its parameters: the keys of `[contact]`, and of a joint, that mean something to it.
    pub parameters: &'static [LawParameter],
    /// How it loses energy.
    pub losses: Losses,
    /// The law with its parameters.
    pub build: fn(&Given) -> Arc<dyn ForceLaw>,
}

impl PartialEq for LawKind {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for LawKind {}

impl LawKind {
    /// Whether a key of `[contact]` means something to this law.
    pub fn takes(&self, key: &str) -> bool {
        self.parameters.iter().any(|parameter| parameter.name == key)
    }
}

/// How a law loses energy, and so by which key it can be made to return a given share of the speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Losses {
    /// Not at all.
    Elastic,
    /// By a coefficient of restitution, key `restitution`.
    Restitution,
    /// By a damping, key `damping`; what is returned depends on the impact speed.
    Damping,
    /// By a damping that fades in with penetration, keys `c_max` and `d_max`.
    Step,
}

/// A parameter of a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawParameter {
    /// The key.
    pub name: &'static str,
    /// Unit in words; empty for a pure number or a word.
    pub unit: &'static str,
    /// What it means.
    pub about: &'static str,
    /// What may be written.
    pub range: LawRange,
    /// What holds where nothing is written, in words.
    pub default: &'static str,
}

/// What a parameter may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LawRange {
    /// Above 0.
    Positive,
    /// 0 or more.
    NotNegative,
    /// Above 0, at most 1.
    Share,
    /// From 0 to below 0.5.
    Poisson,
    /// 1 or more.
    FromOne,
    /// Words.
    Choice(&'static str),
}

impl LawRange {
    /// Whether a number is in it.
    pub fn holds(self, value: f64) -> bool {
        match self {
            LawRange::Positive => value > 0.0,
            LawRange::NotNegative => value >= 0.0,
            LawRange::Share => value > 0.0 && value <= 1.0,
            LawRange::Poisson => (0.0..0.5).contains(&value),
            LawRange::FromOne => value >= 1.0,
            LawRange::Choice(_) => false,
        }
    }

    /// What may be written, in words.
    pub fn in_words(self) -> &'static str {
        match self {
            LawRange::Positive => "above 0",
            LawRange::NotNegative => "0 or more",
            LawRange::Share => "above 0, at most 1",
            LawRange::Poisson => "from 0 to below 0.5",
            LawRange::FromOne => "1 or more",
            LawRange::Choice(words) => words,
        }
    }
}

/// What a law is built from: a joint's radii and what is written for it.
///
/// [`LawKind`] has an example.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Given {
    /// Inner radius of the ring in m.
    pub bearing_radius: f64,
    /// Radius of the journal in m, smaller than the ring's.
    pub journal_radius: f64,
    /// Of both surfaces.
    pub material: Material,
    /// How K follows from the radii.
    pub stiffness_form: StiffnessForm,
    /// Stiffness K in N/mⁿ, in place of that.
    pub stiffness: Option<f64>,
    /// Exponent n.
    pub exponent: f64,
    /// Axial length of the bearing in m; its diameter where nothing is written.
    pub length: Option<f64>,
    /// Coefficient of restitution; the law's own default where nothing is written.
    pub restitution: Option<f64>,
    /// Damping in the law's unit; the law's own default where nothing is written.
    pub damping: Option<f64>,
    /// Damping C_max in N·s/m of a law that fades in.
    pub c_max: f64,
    /// Penetration in m at which it is complete.
    pub d_max: f64,
    /// Whether that law is kept from pulling.
    pub clip: bool,
}

impl Default for Given {
    /// A joint of the built-in machine.
    fn default() -> Self {
        Self {
            bearing_radius: 10e-3,
            journal_radius: 9.5e-3,
            material: Material { youngs_modulus: 73e9, poisson_ratio: 0.3 },
            stiffness_form: StiffnessForm::Printed,
            stiffness: None,
            exponent: 1.5,
            length: None,
            restitution: None,
            damping: None,
            c_max: 500.0,
            d_max: 1e-5,
            clip: true,
        }
    }
}

/// Share of the speed that laws with a restitution return where nothing is written: what the default law
/// returns of a 0.1 kg journal at 0.1 m/s.
pub const RESTITUTION: f64 = 0.73;

impl Given {
    /// Stiffness K in N/mⁿ as written, or Hertz' from material and radii.
    pub fn stiffness(&self) -> f64 {
        self.stiffness.unwrap_or_else(|| self.hertz())
    }

    /// Hertz' stiffness in N/m^1.5 from material and radii.
    pub fn hertz(&self) -> f64 {
        hertz_stiffness(
            self.stiffness_form,
            self.material,
            self.bearing_radius,
            self.journal_radius,
        )
    }

    /// Coefficient of restitution.
    pub fn restitution(&self) -> f64 {
        self.restitution.unwrap_or(RESTITUTION)
    }

    /// Radial clearance ΔR = R_i − R_j in m.
    pub fn radial(&self) -> f64 {
        self.bearing_radius - self.journal_radius
    }

    /// Axial length L of the bearing in m. Default its diameter: plain bearings are about as long as wide.
    pub fn length(&self) -> f64 {
        self.length.unwrap_or(2.0 * self.bearing_radius)
    }

    /// Composite modulus E* in Pa, `1/E* = (1 − ν²)/E` of both surfaces together.
    pub fn modulus(&self) -> f64 {
        let nu = self.material.poisson_ratio;
        self.material.youngs_modulus / (2.0 * (1.0 - nu * nu))
    }

    /// `K δⁿ` with a loss.
    pub fn power(&self, loss: Loss) -> Arc<dyn ForceLaw> {
        let spring = PowerSpring { stiffness: self.stiffness(), exponent: self.exponent };
        Arc::new(Damped { spring, loss })
    }
}

/// E of both surfaces.
pub(super) const YOUNGS_MODULUS: LawParameter = LawParameter {
    name: "youngs_modulus",
    unit: "Pa",
    about: "Young's modulus E of both surfaces",
    range: LawRange::Positive,
    default: "73e9",
};

/// ν of both surfaces.
pub(super) const POISSON_RATIO: LawParameter = LawParameter {
    name: "poisson_ratio",
    unit: "",
    about: "Poisson's ratio of both surfaces",
    range: LawRange::Poisson,
    default: "0.3",
};

/// How K follows from the radii.
pub(super) const STIFFNESS_FORM: LawParameter = LawParameter {
    name: "stiffness_form",
    unit: "",
    about: "how K follows from the radii: with their sum (printed) or their difference (conformal)",
    range: LawRange::Choice("\"printed\" or \"conformal\""),
    default: "\"printed\"",
};

/// K itself.
pub(super) const STIFFNESS: LawParameter = LawParameter {
    name: "stiffness",
    unit: "N/m^n",
    about: "stiffness K, in place of the one from E, Poisson's ratio and the radii",
    range: LawRange::Positive,
    default: "from these",
};

/// n.
pub(super) const EXPONENT: LawParameter = LawParameter {
    name: "exponent",
    unit: "",
    about: "exponent n of the penetration",
    range: LawRange::FromOne,
    default: "1.5",
};

/// e of most laws.
const RESTITUTION_KEY: LawParameter = LawParameter {
    name: "restitution",
    unit: "",
    about: "coefficient of restitution e: the share of the impact speed that the law is asked to return",
    range: LawRange::Share,
    default: "0.73",
};

/// e of the conformal laws, which their authors give without damping.
const CONFORMAL_RESTITUTION: LawParameter = LawParameter {
    about: "coefficient of restitution e of the factor 1 + 3(1 - e^2)/4 rate/impact_speed after Lankarani and \
            Nikravesh; 1 is the elastic law as its authors give it",
    default: "1",
    ..RESTITUTION_KEY
};

/// L.
const LENGTH: LawParameter = LawParameter {
    name: "length",
    unit: "m",
    about: "axial length L of the bearing",
    range: LawRange::Positive,
    default: "its diameter",
};

/// Parameters of the conformal laws.
pub(super) const CONFORMAL: &[LawParameter] =
    &[YOUNGS_MODULUS, POISSON_RATIO, LENGTH, CONFORMAL_RESTITUTION];

/// Parameters of elastic laws after Hertz.
pub(super) const ELASTIC: &[LawParameter] =
    &[YOUNGS_MODULUS, POISSON_RATIO, STIFFNESS_FORM, STIFFNESS, EXPONENT];

/// The same of laws by a coefficient of restitution.
pub(super) const BY_RESTITUTION: &[LawParameter] =
    &[YOUNGS_MODULUS, POISSON_RATIO, STIFFNESS_FORM, STIFFNESS, EXPONENT, RESTITUTION_KEY];
