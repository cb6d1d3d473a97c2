//! What a sweep costs, as users run it: `cargo bench --bench sweep`.
//!
//! Two figures. How much faster two threads are than one: 200 runs of 1 s of the built-in machine, at
//! its default tolerance. And the time of 1000 runs of 1 s with the clearance log-uniform from 1e-8
//! to 1e-3 m on all cores, at the default tolerance, which reproduces the statistics of an independent
//! solver at all of these clearances, and at a ten times looser one, which does not at the small ones.
//! Wall times: measure on an idle computer.

use freeplay::scenario::Source;
use freeplay::study::sweep::{Plan, Shard, on_threads, sweep};
use std::time::Instant;

/// Wall time in s of a sweep on so many threads, everything written.
fn time(threads: Option<usize>, vary: &str, tolerance: f64) -> f64 {
    let folder = tempfile::tempdir().expect("a folder for the results");
    let sets = [format!("simulation.tolerance={tolerance:e}")];
    let started = Instant::now();
    let done = on_threads(threads, || {
        let source = Source::read(None)?;
        let plan = Plan::new(source, &sets, &[vary.to_owned()], Shard::WHOLE)?;
        sweep(&plan, &folder.path().join("sweep"), false, &|_, _| {})
    });
    let outcome = done.expect("threads").expect("a sweep");
    assert_eq!(outcome.record.ok, outcome.record.identity.runs, "every run reached its end");
    started.elapsed().as_secs_f64()
}

fn main() {
    let [one, two] = [1, 2].map(|threads| time(Some(threads), "motion.phase=0..6.25:200", 1e-5));
    println!("200 runs of 1 s, tolerance 1e-5 m/s: {one:.1} s on one thread, {two:.1} s on two");
    println!("  two threads are {:.2} times as fast", one / two);
    for tolerance in [1e-4, 1e-5] {
        let wall = time(None, "joints.clearance=1e-8..1e-3:log:1000", tolerance);
        println!(
            "1000 runs of 1 s, clearance 1e-8 to 1e-3 m, tolerance {tolerance:e} m/s: {wall:.1} s"
        );
    }
}
