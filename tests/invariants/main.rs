//! What must hold whatever the numbers: conservation, action and reaction, symmetry, repeatability.

#[path = "../common/mod.rs"]
mod common;
mod conservation;
mod pair;
mod reaction;
mod repeatability;
mod sampling;
mod symmetry;

/// Fixed step of these runs in s: hits take at least ten of them.
const STEP: f64 = 1e-5;
