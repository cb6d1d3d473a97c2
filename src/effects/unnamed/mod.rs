//! What a model lacks and nobody can name: efforts and forces as a fitted table of what they depend on.

pub(super) mod efforts;
pub(super) mod history;

use super::kind::{defaults, linear};
use super::{Kind, Setting, Targets, Wrong};
use crate::mechanism::Mechanism;

/// Its name.
pub const UNNAMED: &str = "unnamed";

pub(super) const KIND: Kind = Kind {
    name: UNNAMED,
    summary: "efforts or forces as a table of what they depend on, fitted to data: what has no name here",
    equation: "f_i = sum_k coefficients[i][k] feature_k(depends_on); i: the effort of each joint, or force along x, \
               along y and torque at the output's reference point",
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

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    match &setting.history {
        Some(history) => history::apply(history, setting, mechanism),
        None => efforts::apply(setting, mechanism),
    }
}
