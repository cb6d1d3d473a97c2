//! What a sweep costs, as users run it: `cargo bench --bench sweep`.
//!
//! Two figures. How much faster two threads are than one: 200 runs of 1 s of the built-in machine, at
//! its default tolerance. And the time of 1000 runs of 1 s with the clearance log-uniform from 1e-8
//! to 1e-3 m on all cores, at the default tolerance, which reproduces the statistics of an independent
//! solver at all of these clearances, and at a ten times looser one, which does not at the small ones.
//! Wall times: measure on an idle computer. Where others use it too, what the threads spent computing
//! (Linux tells) says what two of them would come to on idle cores.

use freeplay::scenario::Source;
use freeplay::study::StudyError;
use freeplay::study::sweep::{Plan, Shard, on_threads, sweep};
use std::fs;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// What a sweep took, in s.
struct Cost {
    wall: f64,
    /// Computing time of all threads; none where the system does not tell.
    computing: Option<f64>,
    /// The same of what is not a run: planning, and writing what follows from the rows. Some of it is
    /// done by one thread alone.
    around: Option<f64>,
}

/// Computing time in s of the present thread since it began: Linux, Documentation/scheduler/sched-stats.
fn computed() -> Option<f64> {
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(text.split_whitespace().next()?.parse::<f64>().ok()? * 1e-9)
}

/// A sweep on so many threads, everything written; then once more, when nothing is left to be run.
fn cost(threads: Option<usize>, vary: &str, tolerance: f64, engine: &str) -> Cost {
    let folder = tempfile::tempdir().expect("a folder for the results");
    let sets =
        [format!("simulation.tolerance={tolerance:e}"), format!("simulation.engine={engine}")];
    let once = || {
        let started = Instant::now();
        let (done, computed) = on_threads(threads, || {
            let source = Source::read(None).expect("the built-in scenario");
            let plan = Plan::new(source, &sets, &[vary.to_owned()], Shard::WHOLE)?;
            let never = AtomicBool::new(false);
            let done = sweep(&plan, &folder.path().join("sweep"), false, &never, &|_, _| {})?;
            Ok((done, rayon::broadcast(|_| computed())))
        })
        .expect("threads")
        .unwrap_or_else(|error: StudyError| panic!("{error}"));
        assert_eq!(done.record.ok, done.record.identity.runs, "every run reached its end");
        (started.elapsed().as_secs_f64(), computed.into_iter().sum::<Option<f64>>())
    };
    let (wall, computing) = once();
    Cost { wall, computing, around: once().1 }
}

fn main() {
    let [one, two] =
        [1, 2].map(|threads| cost(Some(threads), "motion.phase=0..6.25:200", 1e-5, "rapier"));
    println!(
        "200 runs of 1 s, tolerance 1e-5 m/s: {:.1} s on one thread, {:.1} s on two",
        one.wall, two.wall
    );
    println!("  two threads are {:.2} times as fast", one.wall / two.wall);
    if let (Some(alone), Some(together), Some(around)) = (one.computing, two.computing, two.around)
    {
        println!(
            "  computing: {alone:.2} s on one, {together:.2} s on two together, {around:.2} s of them \
             around the runs: {:.2} times as fast on idle cores at least",
            alone / (0.5 * (together - around) + around)
        );
    }
    for (engine, tolerance) in
        [("rapier", 1e-4), ("rapier", 1e-5), ("direct", 1e-4), ("direct", 1e-5)]
    {
        let vary = "joints.clearance=1e-8..1e-3:log:1000";
        let Cost { wall, .. } = cost(None, vary, tolerance, engine);
        println!(
            "1000 runs of 1 s, clearance 1e-8 to 1e-3 m, {engine}, tolerance {tolerance:e} m/s: {wall:.1} s"
        );
    }
}
