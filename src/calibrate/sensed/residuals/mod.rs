//! A rig and its runs ([`problem`]) and where they begin (`let_go`, `kept`), what these say against a model ([`residual`]), what
//! candidates change of that beside the declared one (`responses`), and what a right model leaves of it ([`baseline`]), by
//! noiseless recordings of models ([`simulated`]), or two right models in common (`common`); a swing that is not the recorded one is a part of that (`swing`). How far
//! journals are taken to lean follows from noise ([`lean`]).

pub mod baseline;
mod common;
mod kept;
pub mod lean;
mod let_go;
pub mod problem;
pub mod residual;
mod responses;
pub(super) mod simulated;
mod swing;
