//! `[contact]`: the force between a journal and its bearing.

use crate::contact::laws::{self, HERTZ_STEP, LawKind};
use crate::contact::{CoulombFriction, Extent, Film, Friction, StiffnessForm};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserializer, Error};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::sync::LazyLock;

/// Contact law and its parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ContactKeys {
    /// Which law. Default `hertz-step`: the paper's.
    pub law: Law,
    /// Young's modulus E of both surfaces, Pa. Default 73e9: the paper.
    pub youngs_modulus: f64,
    /// Poisson's ratio ν of both surfaces, dimensionless. Default 0.3: the paper.
    pub poisson_ratio: f64,
    /// Exponent n of the penetration in F = K δⁿ + …, dimensionless. Default 1.5: Hertz, the paper.
    pub exponent: f64,
    /// Damping C_max at full depth, N s/m. Default 500: assumed (not in the paper); returns 0.73
    /// of the speed of a 0.1 kg journal that hits at 0.1 m/s.
    pub c_max: f64,
    /// Penetration d_max at which the damping reaches `c_max`, m. Default 1e-5: assumed, with
    /// `c_max`.
    pub d_max: f64,
    /// Whether the force is kept from pulling while the surfaces part. Default true: ADAMS' own
    /// IMPACT function, which the paper used, never pulls; `false` is the formula as printed.
    pub clip: bool,
    /// How K follows from the radii. Default `printed`: as in the paper.
    pub stiffness_form: StiffnessForm,
    /// Stiffness K, N/m^1.5 (N/mⁿ for another exponent), in place of the one from E, ν and the
    /// radii. Default none: computed for each joint.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<f64>,
    /// Coefficient of restitution e of laws that are given by one. Default 0.73: what the default law returns
    /// of a 0.1 kg journal at 0.1 m/s; 1 of conformal laws, which are elastic.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// Damping of laws that are given by one, in the law's own unit. Default that of the law.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping: Option<f64>,
    /// Axial length of bearings, m, for laws of line contact. Default a bearing's diameter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Sliding speed v_s at which friction is near its full value, m/s: μ F tanh(v/v_s).
    /// Default 1e-3: assumed; slow against the sliding speeds of a rattling journal.
    pub friction_velocity: f64,
    /// How friction follows the sliding speed. Default `coulomb`, with a tanh around rest.
    #[serde(skip_serializing_if = "FrictionLaw::is_coulomb")]
    pub friction_law: FrictionLaw,
    /// Static friction over sliding friction of `bengisu-akay`, `stribeck` and `lugre`, 1 or more. Default 1.5: dry steel,
    /// about 0.6 against 0.4.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub static_ratio: Option<f64>,
    /// Sliding speed over which these fall from static to sliding friction, m/s. Default ten times
    /// `friction_velocity`, so that both show.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stribeck_velocity: Option<f64>,
    /// Sliding speed below which `ambrosio` has no friction, m/s, below `friction_velocity`. Default a tenth of
    /// that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rest_velocity: Option<f64>,
    /// How far the bristles of `lugre` bend before surfaces slide, m. Default 1e-6: the size of asperities.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub presliding: Option<f64>,
    /// Wear coefficient k of rings, 1/Pa (m³ removed per N m rubbed): Archard's dimensionless coefficient over the hardness
    /// of the softer surface. `freeplay wear` takes it, with the axial `length` of bearings. Default none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wear_coefficient: Option<f64>,
    /// Oil between journals and rings, beside the dry contact. Default `none`.
    #[serde(skip_serializing_if = "FilmKind::is_none")]
    pub film: FilmKind,
    /// Dynamic viscosity μ of the oil, Pa s. A film needs it; `length` is the bearing's axial length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub viscosity: Option<f64>,
    /// Eccentricity over clearance from which a film grows no stiffer, above 0 and below 1: the rest is the roughness of
    /// the surfaces, over which the film gives way to the dry contact. Default 0.95: a roughness of some µm in a gap of
    /// a tenth of a millimetre.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub film_eccentricity_max: Option<f64>,
}

impl Default for ContactKeys {
    fn default() -> Self {
        ContactKeys {
            law: Law::HertzStep,
            youngs_modulus: 73e9,
            poisson_ratio: 0.3,
            exponent: 1.5,
            c_max: 500.0,
            d_max: 1e-5,
            clip: true,
            stiffness_form: StiffnessForm::Printed,
            stiffness: None,
            restitution: None,
            damping: None,
            length: None,
            friction_velocity: 1e-3,
            friction_law: FrictionLaw::Coulomb,
            static_ratio: None,
            stribeck_velocity: None,
            rest_velocity: None,
            presliding: None,
            wear_coefficient: None,
            film: FilmKind::None,
            viscosity: None,
            film_eccentricity_max: None,
        }
    }
}

/// Eccentricity over clearance from which films grow no stiffer where nothing is written.
const FILM_ECCENTRICITY_MAX: f64 = 0.95;

/// How far bristles bend where nothing is written, m.
const PRESLIDING: f64 = 1e-6;

/// Static over sliding friction where nothing is written.
const STATIC_RATIO: f64 = 1.5;

impl ContactKeys {
    /// Whether something beside laws asks for the key: wear and films for the `length` of bearings.
    pub fn asks_for(&self, key: &str) -> bool {
        key == "length" && (self.wear_coefficient.is_some() || self.viscosity.is_some())
    }

    /// The film of this kind in a bearing of a radius and a radial clearance in m; none without a viscosity.
    pub fn film(&self, kind: FilmKind, radius: f64, clearance: f64) -> Option<Film> {
        let extent = match kind {
            FilmKind::None => return None,
            FilmKind::Squeeze => Extent::Full,
            FilmKind::ShortBearing => Extent::Pressing,
        };
        let length = self.length.unwrap_or(2.0 * radius);
        Some(Film {
            damping: Film::damping_of(self.viscosity?, radius, length, clearance),
            extent,
            eccentricity_max: self.film_eccentricity_max.unwrap_or(FILM_ECCENTRICITY_MAX),
            fades: true,
        })
    }

    /// The friction law with the coefficient μ of a joint.
    pub fn friction(&self, coefficient: f64) -> Friction {
        let velocity = self.friction_velocity;
        let ratio = self.static_ratio.unwrap_or(STATIC_RATIO);
        let fall = self.stribeck_velocity.unwrap_or(10.0 * velocity);
        match self.friction_law {
            FrictionLaw::Coulomb => CoulombFriction { coefficient, velocity }.into(),
            FrictionLaw::Threlfall => Friction::Threlfall { coefficient, velocity },
            FrictionLaw::BengisuAkay => {
                Friction::BengisuAkay { coefficient, ratio, velocity, fall }
            }
            FrictionLaw::Ambrosio => {
                let rest = self.rest_velocity.unwrap_or(0.1 * velocity);
                Friction::Ambrosio { coefficient, rest, velocity }
            }
            FrictionLaw::Stribeck => Friction::Stribeck { coefficient, ratio, velocity, fall },
            FrictionLaw::Lugre => {
                let presliding = self.presliding.unwrap_or(PRESLIDING);
                Friction::LuGre { coefficient, ratio, velocity, fall, presliding }
            }
        }
    }
}

/// A friction law by name; equations and sources stand at [`Friction`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FrictionLaw {
    /// `μ F tanh(v/v_s)`.
    Coulomb,
    /// An exponential up to `friction_velocity`.
    Threlfall,
    /// A parabola up to static friction at `friction_velocity`, an exponential fall beyond.
    BengisuAkay,
    /// Nothing up to `rest_velocity`, a straight line up to `friction_velocity`.
    Ambrosio,
    /// Coulomb's with static friction that falls over `stribeck_velocity`.
    Stribeck,
    /// Bristles that bend over `presliding` and hold at rest, with Stribeck's friction when they slide.
    Lugre,
}

impl FrictionLaw {
    /// Whether it is the default.
    fn is_coulomb(&self) -> bool {
        *self == FrictionLaw::Coulomb
    }

    /// Whether a key of `[contact]` means something to it.
    pub fn takes(self, key: &str) -> bool {
        match key {
            "static_ratio" | "stribeck_velocity" => {
                matches!(
                    self,
                    FrictionLaw::BengisuAkay | FrictionLaw::Stribeck | FrictionLaw::Lugre
                )
            }
            "presliding" => self == FrictionLaw::Lugre,
            "rest_velocity" => self == FrictionLaw::Ambrosio,
            _ => true,
        }
    }
}

/// An oil film by name; equations and source stand at [`Film`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FilmKind {
    /// No oil.
    None,
    /// A full film: it resists being squeezed out as much as being drawn in.
    Squeeze,
    /// A film that presses and does not pull: the bearing of Ocvirk, which carries a turning journal.
    ShortBearing,
}

impl FilmKind {
    /// Whether there is none.
    pub fn is_none(&self) -> bool {
        *self == FilmKind::None
    }
}

/// A contact law by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// Hertzian stiffness with a damping that steps in over `d_max` (paper, eqs. 3–6).
    HertzStep,
    /// The rigid contact of the physics engine itself.
    Native,
    /// No clearance: ideal revolute joints.
    Ideal,
    /// Another force law of the literature.
    Other(&'static LawKind),
}

/// The names of all laws, the physics engine's contact and ideal joints after the default.
static NAMES: LazyLock<Vec<&'static str>> = LazyLock::new(|| {
    let others = laws::ALL.iter().filter(|kind| kind.name != HERTZ_STEP.name).map(|kind| kind.name);
    [Law::HertzStep, Law::Native, Law::Ideal].map(Law::name).into_iter().chain(others).collect()
});

impl Law {
    /// The law of a name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "native" => Some(Law::Native),
            "ideal" => Some(Law::Ideal),
            _ => laws::named(name).map(Law::of),
        }
    }

    /// A force law.
    pub fn of(kind: &'static LawKind) -> Self {
        if *kind == HERTZ_STEP { Law::HertzStep } else { Law::Other(kind) }
    }

    /// Its name in scenarios.
    pub fn name(self) -> &'static str {
        match self {
            Law::HertzStep => HERTZ_STEP.name,
            Law::Native => "native",
            Law::Ideal => "ideal",
            Law::Other(kind) => kind.name,
        }
    }

    /// The force law that it is; none where no force law acts.
    pub fn kind(self) -> Option<&'static LawKind> {
        match self {
            Law::HertzStep => Some(&HERTZ_STEP),
            Law::Native | Law::Ideal => None,
            Law::Other(kind) => Some(kind),
        }
    }

    /// Whether a key of `[contact]` means something under it: native contacts are fitted to the default law,
    /// and a machine without clearance is the same file with another word.
    pub fn takes(self, key: &str) -> bool {
        self.kind().unwrap_or(&HERTZ_STEP).takes(key)
    }
}

/// Whether a key of `[contact]` belongs to some laws and not to others.
pub fn is_law_key(key: &str) -> bool {
    laws::ALL.iter().any(|kind| kind.takes(key))
}

impl JsonSchema for Law {
    fn schema_name() -> Cow<'static, str> {
        "Law".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({"type": "string", "enum": *NAMES})
    }
}

impl Serialize for Law {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Law {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Law::named(&name).ok_or_else(|| Error::unknown_variant(&name, &NAMES))
    }
}
