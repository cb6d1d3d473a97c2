//! Rigid joints that are solved together.

use crate::mechanism::equations::constraints::Rigid;

/// How much closer than usual to a lower rank a group's rows are where it counts as nearly singular: a
/// thousandth of a radian away from the singular pose of a common linkage.
const NEARLY_SINGULAR: f64 = 1e-6;

/// Rigid joints that are solved together.
#[derive(Clone, Debug)]
pub(super) struct JointGroup {
    pub joints: Vec<Rigid>,
    /// Highest rank of the rows so far, and the farthest that they were from a lower one.
    rank: usize,
    weakest: f64,
}

impl JointGroup {
    pub fn new(joints: Vec<Rigid>) -> Self {
        Self { joints, rank: 0, weakest: 0.0 }
    }

    /// The farthest that its rows were from a lower rank.
    pub fn weakest(&self) -> f64 {
        self.weakest
    }

    /// Whether rows of this rank, so far from a lower one, are nearly singular.
    pub fn nearly_singular(&mut self, rank: usize, weakest: f64) -> bool {
        self.rank = self.rank.max(rank);
        self.weakest = self.weakest.max(weakest);
        rank < self.rank || weakest < NEARLY_SINGULAR * self.weakest
    }
}
