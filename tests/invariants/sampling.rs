//! Properties over many random systems: the same ones each time, and the worst of them.

use nalgebra::Vector2;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::cell::Cell;

pub fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(20_230_403),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// The worst of N errors over all cases of a property.
pub struct Worst<const N: usize>(Cell<[f64; N]>);

impl<const N: usize> Worst<N> {
    pub fn new() -> Self {
        Self(Cell::new([0.0; N]))
    }

    pub fn take(&self, errors: [f64; N]) {
        let old = self.0.get();
        self.0.set(std::array::from_fn(|i| old[i].max(errors[i])));
    }

    pub fn get(&self) -> [f64; N] {
        self.0.get()
    }
}

pub fn vector(size: f64) -> impl Strategy<Value = Vector2<f64>> {
    (-size..size, -size..size).prop_map(|(x, y)| Vector2::new(x, y))
}
