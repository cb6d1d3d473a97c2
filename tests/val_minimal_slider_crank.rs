//! A slider-crank with two clearance joints against the solver in minimal coordinates, which shares
//! nothing with the engine.

mod common;
mod minimal_slider_crank;

use freeplay::engine::Schedule;
use minimal_slider_crank::{STARTS, apart, mechanism, ours, theirs};

#[test]
fn both_solvers_agree() {
    let schedule = Schedule { duration: 0.05, interval: 0.01 };
    let times: Vec<f64> = (0..=5).map(|k| f64::from(k) * 0.01).collect();
    for start in STARTS {
        let (truth, _) = theirs(start, 1e-11, &times);
        let (rows, _) = ours(&mechanism(start), 1e-8, schedule);
        let moved = apart(&truth[..1], &truth[5..]);
        let off = apart(&rows, &truth);
        println!("crank from {start} rad: {off:.1e} m apart, moved by {moved:.1e} m");
        assert!(off < 1e-9, "crank from {start} rad: {off:e} m");
        assert!(moved > 1e-3, "crank from {start} rad: moved by {moved} m only");
    }
}
