//! What the efforts of a held machine may be made of: values of effects of the catalogue in which they are linear.

use crate::effects::{Kind, Setting, Target};
use std::fmt;

/// Values in which efforts are linear, effect by effect.
const LINEAR: &[(&str, &[&str])] = &[
    ("actuator-friction", &FRICTION),
    ("joint-friction", &["coulomb", "viscous"]),
    ("film-friction", &["force_N"]),
    ("stribeck-friction", &["coulomb_N", "static_N", "viscous_Ns_m"]),
    ("air-drag", &["force_Ns2_m2", "torque_Nms2"]),
    ("screw-ripple", &["amplitude_N"]),
    ("mass-properties", &BODY),
    ("drive-lag", &["lag_s"]),
];

/// A rate in m/s or rad/s that nobody measures.
const SIGN: f64 = 1e-12;

const FRICTION: [&str; 7] = [
    "viscous_Ns_m",
    "coulomb_N",
    "offset_N",
    "viscous_pos_Ns_m",
    "viscous_neg_Ns_m",
    "coulomb_pos_N",
    "coulomb_neg_N",
];

/// Friction that differs with direction; an offset is the difference of its dry parts.
pub const WAYS: [&str; 4] =
    ["viscous_pos_Ns_m", "viscous_neg_Ns_m", "coulomb_pos_N", "coulomb_neg_N"];

/// What of a body is sought.
pub(super) const BODY: [&str; 4] = ["mass_kg", "moment_x_kg_m", "moment_y_kg_m", "inertia_kg_m2"];

/// Values of a kind in which efforts are linear.
pub(super) fn linear(kind: &Kind) -> &'static [&'static str] {
    LINEAR.iter().find(|(name, _)| *name == kind.name).map_or(&[], |(_, values)| values)
}

/// Whether values of a declared effect are sought: efforts are linear in all of it that is not nothing. Errors of a
/// screw's length are not.
pub fn is_sought(effect: &Setting) -> bool {
    let bends = effect.kind.name == "screw-ripple"
        && effect.value("amplitude_m").is_some_and(|size| size != 0.0);
    !linear(effect.kind).is_empty() && !bends
}

/// A value that an effect was given.
pub(super) fn given(effect: &Setting, name: &str) -> Option<f64> {
    effect.values().find(|(own, _)| *own == name).map(|(_, value)| value)
}

/// One value of an effect, the others of which stay.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldTerm {
    effect: Setting,
    /// The value.
    pub sought: &'static str,
}

impl fmt::Display for HeldTerm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} of {}", self.sought, self.effect)?;
        let fixed = self.effect.values().filter(|(name, _)| *name != self.sought);
        fixed.into_iter().try_for_each(|(name, value)| write!(f, ", {name} = {value}"))
    }
}

impl HeldTerm {
    /// The value `sought` of an effect on a target, others as they are `fixed`.
    pub fn new(
        kind: &'static Kind,
        target: Target,
        sought: &'static str,
        fixed: &[(&'static str, f64)],
    ) -> Self {
        let values = [&[(sought, 0.0)], fixed].concat();
        Self { effect: Setting::on(kind, target, &values), sought }
    }

    /// The effect's kind.
    pub fn kind(&self) -> &'static Kind {
        self.effect.kind
    }

    /// What it acts on.
    pub fn target(&self) -> &Target {
        &self.effect.target
    }

    /// The values that stay.
    pub fn fixed(&self) -> impl Iterator<Item = (&'static str, f64)> {
        self.effect.values().filter(|(name, _)| *name != self.sought)
    }

    /// The effect with a small value, and that value. Dry friction has the sign of the measured rate: how steep it is at
    /// rest costs a simulation short steps, and says nothing along a motion.
    pub fn small(&self) -> (Setting, f64) {
        let step = self.kind().parameter(self.sought).map_or(1.0, |parameter| parameter.step);
        let value = |(name, own): (&'static str, f64)| match name {
            name if name == self.sought => step,
            name if name.starts_with("velocity") => SIGN,
            _ => own,
        };
        let values: Vec<f64> = self.effect.values().map(value).collect();
        (self.effect.with(&values), step)
    }

    /// The effect with a value.
    pub fn with(&self, value: f64) -> Setting {
        let values =
            self.effect.values().map(|(name, own)| if name == self.sought { value } else { own });
        self.effect.with(&values.collect::<Vec<_>>())
    }

    /// Whether a value makes sense; waves have any sign by their phase.
    pub fn allows(&self, value: f64) -> bool {
        let bounds = self.kind().parameter(self.sought).map(|parameter| parameter.bounds);
        self.kind().scan.is_some() || bounds.is_none_or(|[low, high]| (low..=high).contains(&value))
    }
}
