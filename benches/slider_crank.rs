//! A slider-crank with two clearance joints: time of this project against a solver in minimal coordinates
//! written for this one mechanism (`minimal_coordinates/slider_crank.rs`), both at their loosest tolerance
//! that reaches an error of 1e-8 m, measured in one run.
//!
//! `cargo bench --bench slider_crank` prints the table. Errors are geometric means over start angles (of
//! one alone it is luck by a factor of five), against the minimal-coordinate solver at 1e-12.

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/minimal_slider_crank/mod.rs"]
mod minimal_slider_crank;

use freeplay::engine::Schedule;
use freeplay::mechanism::Mechanism;
use minimal_coordinates::slider_crank::Sample;
use minimal_slider_crank::{STARTS, apart, mechanism, minimal_coordinates, ours, theirs};
use std::time::Instant;

const WANTED: f64 = 1e-8; // m
const UNTIL: f64 = 0.05; // s
/// Rows at which positions are compared, in s: far enough apart not to hinder long steps.
const INTERVAL: f64 = 0.01;
/// Each time is the shortest of so many.
const REPEATS: usize = 20;

/// What a tolerance gives.
struct Found {
    tolerance: f64,
    error: f64,
    /// Steps and wall seconds, both per simulated second.
    steps: f64,
    wall: f64,
}

fn main() {
    let times: Vec<f64> =
        (0..=(UNTIL / INTERVAL).round() as usize).map(|k| k as f64 * INTERVAL).collect();
    let schedule = Schedule { duration: UNTIL, interval: INTERVAL };
    let truths = STARTS.map(|start| theirs(start, 1e-12, &times).0);
    let mechanisms: [Mechanism; STARTS.len()] = STARTS.map(mechanism);
    let closest = loosest(&truths, |i, tolerance| ours(&mechanisms[i], tolerance, schedule));
    let minimal = loosest(&truths, |i, tolerance| theirs(STARTS[i], tolerance, &times));
    println!("\nSlider-crank, two clearance joints, up to {:.0} ms:", UNTIL * 1e3);
    println!("| solver | tolerance m/s | error m | steps/s | wall s/s | ratio |");
    println!("|---|---|---|---|---|---|");
    for (name, found) in [("freeplay", &closest), ("minimal coordinates", &minimal)] {
        let (Some(found), Some(minimal)) = (found, &minimal) else {
            println!("| {name} | not reached |");
            continue;
        };
        println!(
            "| {name} | {:.1e} | {:.1e} | {:.1}k | {:.5} | {:.1} |",
            found.tolerance,
            found.error,
            found.steps / 1e3,
            found.wall,
            found.wall / minimal.wall
        );
    }
}

/// The loosest tolerance of a fine ladder whose mean error is at most [`WANTED`].
fn loosest(
    truths: &[Vec<Sample>],
    solve: impl Fn(usize, f64) -> (Vec<Sample>, u64),
) -> Option<Found> {
    (0..36).map(|k| 1e-2 * 10f64.powf(-f64::from(k) / 6.0)).find_map(|tolerance| {
        let n = truths.len() as f64;
        let (mut log, mut steps, mut wall) = (0.0, 0.0, 0.0);
        for (i, truth) in truths.iter().enumerate() {
            let (rows, taken) = solve(i, tolerance);
            log += apart(&rows, truth).ln() / n;
            steps += taken as f64 / UNTIL / n;
        }
        if log.exp() > WANTED {
            return None;
        }
        for i in 0..truths.len() {
            let seconds = (0..REPEATS).map(|_| {
                let start = Instant::now();
                std::hint::black_box(solve(i, tolerance));
                start.elapsed().as_secs_f64()
            });
            wall += seconds.fold(f64::INFINITY, f64::min) / UNTIL / n;
        }
        Some(Found { tolerance, error: log.exp(), steps, wall })
    })
}
