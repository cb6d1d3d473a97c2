//! Models and their values: a [`model`] and its runs, what simulations say of its residuals ([`baseline`]), where to start looking
//! ([`candidates`]), values from residuals ([`fit`], [`least_squares`], [`instrument`], `normal`) and from whole simulations ([`settle`],
//! [`whole`], [`axes`]), and by how much predictions miss ([`errors`]).

pub mod axes;
pub mod baseline;
pub mod candidates;
pub mod errors;
pub mod fit;
pub mod instrument;
pub mod least_squares;
pub mod model;
pub(super) mod normal;
pub mod settle;
pub mod whole;
