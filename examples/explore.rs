#[path = "../tests/common/mod.rs"]
mod common;
use common::*;
use freeplay::engine::StepControl::*;
use freeplay::engine::*;
use std::time::Instant;
fn main() {
    let p5 = Case::default();
    let s5 = Case { drive: SERVO, ..p5 };
    let s5g = Case { gravity: -9.81, ..s5 };
    let p5g = Case { gravity: -9.81, ..p5 };
    let p8 = Case { clearance: 1e-8, ..p5 };
    let args: Vec<String> = std::env::args().collect();
    for (name, case, file, until) in [
        ("p5", p5, "prescribed_c5e-4.csv", 0.05),
        ("s5", s5, "servo_c5e-4.csv", 0.05),
        ("s5g", s5g, "servo_c5e-4_gravity.csv", 0.06),
        ("p5g", p5g, "prescribed_c5e-4_gravity.csv", 0.03),
        ("p8", p8, "prescribed_c1e-8.csv", 0.2),
    ] {
        if args.len() > 1 && args[1] != name {
            continue;
        }
        let curve = Curve::read(file);
        let (t, x, y) = (curve.column("t"), curve.column("x"), curve.column("y"));
        let m = case.mechanism();
        let tols: Vec<f64> = if args.len() > 2 {
            vec![args[2].parse().unwrap()]
        } else {
            vec![1e-3, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 1e-7, 1e-8]
        };
        for tol in tols {
            let mut e = 0f64;
            let mut w = Work::default();
            let mut wall = f64::INFINITY;
            for _ in 0..if args.len() > 2 { 1 } else { 5 } {
                let t0 = Instant::now();
                e = 0.0;
                w = run(
                    &m,
                    Tolerance(tol),
                    Schedule { duration: until, interval: 0.01 },
                    &mut |i| {
                        let k = t.iter().position(|s| (s - i.t).abs() < 1e-9).unwrap();
                        let p = i.states[m.output].position;
                        e = e.max((p.x - x[k]).hypot(p.y - y[k]));
                    },
                )
                .unwrap();
                wall = wall.min(t0.elapsed().as_secs_f64());
            }
            println!(
                "{name} {tol:.0e}: {e:.2e} m, {:.1}k steps/s, {:.4} s/s, {:.2} us/step, min {:.1e} max {:.1e}",
                w.steps as f64 / until / 1e3,
                wall / until,
                wall / w.steps as f64 * 1e6,
                w.smallest_step,
                w.largest_step
            );
        }
    }
}
