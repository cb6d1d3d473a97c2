//! Models and their values: where to start looking ([`candidates`], [`periodic`]), values from residuals ([`fit`], [`model`], [`linear`])
//! and from whole simulations ([`whole`], [`stepped`], [`trajectory`]), how well they are known ([`certainty`]), by how much predictions miss
//! ([`errors`]), and how far chance alone leads ([`by_chance`]).

pub(super) mod by_chance;
pub mod candidates;
pub(super) mod certainty;
pub mod errors;
pub mod fit;
pub(super) mod linear;
pub mod model;
pub(super) mod periodic;
pub(super) mod stepped;
pub mod trajectory;
pub(super) mod whole;
