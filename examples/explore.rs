#[path = "../tests/common/mod.rs"]
mod common;
use common::*;
use freeplay::engine::StepControl::*;
use std::time::Instant;
fn main() {
    let p5 = Case::default();
    let s5 = Case { drive: SERVO, ..p5 };
    let s5g = Case { gravity: -9.81, ..s5 };
    let p5g = Case { gravity: -9.81, ..p5 };
    let p8 = Case { clearance: 1e-8, ..p5 };
    for (name, case, file, until) in [
        ("p5", p5, "prescribed_c5e-4.csv", 0.05),
        ("s5", s5, "servo_c5e-4.csv", 0.05),
        ("s5g", s5g, "servo_c5e-4_gravity.csv", 0.06),
        ("p5g", p5g, "prescribed_c5e-4_gravity.csv", 0.03),
        ("p8", p8, "prescribed_c1e-8.csv", 0.2),
    ] {
        let curve = Curve::read(file);
        let m = case.mechanism();
        for tol in [1e-3, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 1e-7, 1e-8] {
            let t0 = Instant::now();
            let (e, w) = platform_error(&m, Tolerance(tol), &curve, until);
            let wall = t0.elapsed().as_secs_f64();
            println!(
                "{name} {tol:.0e}: {e:.2e} m, {:.1}k steps/s, {:.3} s/s, min {:.1e} max {:.1e}",
                w.steps as f64 / until / 1e3,
                wall / until,
                w.smallest_step,
                w.largest_step
            );
        }
    }
}
