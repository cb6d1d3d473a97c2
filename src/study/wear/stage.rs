//! The rings after some cycles.

use crate::contact::Play;

/// The rings after some cycles.
#[derive(Clone, Debug)]
pub struct Stage {
    /// Cycles since the start.
    pub cycles: f64,
    /// What the journal of each ring can reach.
    pub plays: Vec<Play>,
    /// Force times sliding of each ring in J per cycle, in the run that led here.
    pub rubbed: Vec<Vec<f64>>,
    /// Sum of the errors of all jumps until here in m, of each ring.
    pub errors: Vec<f64>,
}
