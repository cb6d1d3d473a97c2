//! From a recorded run to the effect that the model lacks.

pub mod candidates;
pub mod commands;
pub mod fit;
pub mod lens;
pub mod model;
pub mod replica;
pub mod search;
pub mod spectrum;

pub use commands::LoggedCommands;
