//! What a prediction of wear is asked for, and why there may be none.

/// What is to be predicted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WearRequest {
    /// How many cycles.
    pub cycles: f64,
    /// Time of one cycle in s.
    pub period: f64,
    /// Largest error of a jump over cycles, as a share of a joint's clearance.
    pub tolerance: f64,
}
