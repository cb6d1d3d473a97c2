//! What a model lacks and nobody can name: efforts and forces as a fitted table of what they depend on.

pub(super) mod central;
pub(super) mod efforts;
pub(super) mod history;

use super::kind::{defaults, linear};
use super::{Kind, Setting, Targets, Wrong};
use crate::mechanism::Mechanism;
use central::Central;
use efforts::Efforts;
use history::History;
use serde::{Serialize, Serializer};
use std::sync::Arc;

/// Its name.
pub const UNNAMED: &str = "unnamed";

pub(super) const KIND: Kind = Kind {
    name: UNNAMED,
    summary: "efforts or forces as a table of what they depend on, fitted to data: what has no name here",
    equation: "f_i = sum_k coefficients[i][k] feature_k(depends_on); i: the effort of each joint, or force along x, \
               along y and torque at the output's reference point; or the force along the line from a point to a place",
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

/// What an effect without a name does.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum FittedTable {
    Efforts(Arc<Efforts>),
    Central(Arc<Central>),
    History(Arc<History>),
}

impl Serialize for FittedTable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Efforts(table) => table.as_ref().serialize(serializer),
            Self::Central(table) => table.as_ref().serialize(serializer),
            Self::History(table) => table.as_ref().serialize(serializer),
        }
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    match &setting.table {
        Some(FittedTable::Efforts(table)) => efforts::apply(table, mechanism),
        Some(FittedTable::Central(table)) => central::apply(table, mechanism),
        Some(FittedTable::History(history)) => history::apply(history, mechanism),
        None => Ok(()),
    }
}
