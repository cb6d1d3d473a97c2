//! Rigid joints as equations ([`rows`], [`telescope`], [`factors`]) and what follows from these: assembly, closed loops, freedoms,
//! forces that hold ([`constraints`]), inverse dynamics, motions without clearance ([`tracker`]), the longest steps ([`limits`]).

pub(super) mod assembly;
pub(super) mod closing;
pub(super) mod constraints;
pub(super) mod factors;
pub(super) mod freedoms;
pub(super) mod inverse;
pub(super) mod limits;
pub(super) mod loops;
pub(super) mod rows;
pub(super) mod telescope;
pub(super) mod tracker;
