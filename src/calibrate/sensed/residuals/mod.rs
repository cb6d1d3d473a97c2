//! A rig and its runs ([`problem`]), what these say against a model ([`residual`]), and what a right model leaves of that
//! ([`baseline`]), by noiseless recordings of models ([`simulated`]).

pub mod baseline;
pub mod problem;
pub mod residual;
pub(super) mod simulated;
