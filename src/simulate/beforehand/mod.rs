//! What can be said against a machine before it is simulated: each file finds what is wrong or doubtful of one kind.

pub(super) mod bodies;
pub(super) mod checks;
pub(super) mod conformal;
pub(super) mod finding;
pub(super) mod idle;
pub(super) mod instruments;
pub(super) mod oil;
pub(super) mod plausible;
pub(super) mod restraints;
pub(super) mod three_rpr;
pub(super) mod unacting;
