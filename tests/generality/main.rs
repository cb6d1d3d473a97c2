//! Random closed chains of any number of bodies: what must hold for every machine that a file can describe.
//!
//! Each property is tried on some chains; the same on many more is a test that is ignored unless asked for
//! (`cargo test --release --test generality -- --ignored`).

mod assembly;
mod chain;
#[path = "../common/mod.rs"]
mod common;
mod energy;
mod forces;
mod order;
#[path = "../invariants/sampling.rs"]
mod sampling;
mod written;

/// Runs a property on `cases` chains, the same ones each time.
fn every_chain(cases: u32, property: impl Fn(&chain::Chain) -> Result<(), String>) {
    use proptest::test_runner::{TestCaseError, TestRunner};
    TestRunner::new(sampling::config(cases))
        .run(&chain::chains(), |chain| property(&chain).map_err(TestCaseError::fail))
        .unwrap();
}
