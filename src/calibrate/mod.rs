//! From a recorded run to the effect that the model lacks.

pub mod candidates;
pub mod commands;
pub mod errors;
pub mod fit;
pub mod lens;
pub mod model;
pub mod outcome;
pub mod replica;
pub mod search;
pub mod self_test;
pub mod spectrum;
pub mod unnamed;

pub use commands::LoggedCommands;
