//! The machine without clearance: its drive forces against an independent inverse dynamics
//! (`assets/reference/ideal.csv`, `ideal_gravity.csv`), its path against the motion, and how well
//! prescribed drives keep their lengths.

mod common;

use common::{Case, Curve, IdealMachine, SERVO};
use freeplay::engine::{Instant, Schedule, StepControl, run};
use freeplay::mechanism::{Bearing, Command};

const CASES: [(&str, f64); 2] = [("ideal.csv", 0.0), ("ideal_gravity.csv", -9.81)];

fn forces(curve: &Curve) -> ([Vec<f64>; 3], f64) {
    let forces = ["F1", "F2", "F3"].map(|name| curve.column(name));
    let largest = forces.iter().flatten().fold(0.0f64, |m, f| m.max(f.abs()));
    (forces, largest)
}

/// Drive forces over a whole period within 0.1 % of the largest, the path within 1e-9 m.
fn prescribed(step: f64) {
    for (name, gravity) in CASES {
        let curve = Curve::read(name);
        let (expected, largest) = forces(&curve);
        let case = Case { gravity, ..Case::default() };
        let mechanism = case.with(Bearing::Ideal);
        let (mut force_error, mut path_error, mut k) = (0.0f64, 0.0f64, 0);
        run(
            &mechanism,
            StepControl::Fixed(step),
            Schedule { duration: 1.0, interval: 0.01 },
            &mut |instant: &Instant| {
                for (leg, force) in instant.evaluation.drive_forces.iter().enumerate() {
                    force_error = force_error.max((force - expected[leg][k]).abs() / largest);
                }
                let position = instant.states[mechanism.output].position;
                let ideal = IdealMachine::at(case, instant.t).position;
                path_error = path_error.max((position - ideal).norm());
                k += 1;
            },
        )
        .unwrap();
        assert_eq!(k, curve.rows.len());
        println!(
            "{name}, step {step:.0e} s: forces {:.1e} % of {largest:.3} N (limit 0.1 %), path \
             {path_error:.1e} m (limit 1e-9)",
            100.0 * force_error
        );
        assert!(force_error <= 1e-3, "{name}: forces off by {:.3e} % > 0.1 %", 100.0 * force_error);
        assert!(path_error <= 1e-9, "{name}: path off by {path_error:.2e} m > 1e-9 m");
    }
}

#[test]
fn prescribed_at_ten_microseconds() {
    prescribed(1e-5);
}

#[test]
fn prescribed_at_a_hundred_microseconds() {
    prescribed(1e-4);
}

#[test]
fn equations_of_motion_give_the_same_forces() {
    for (name, gravity) in CASES {
        let curve = Curve::read(name);
        let (expected, largest) = forces(&curve);
        let case = Case { gravity, ..Case::default() };
        let mut worst = 0.0f64;
        for (k, t) in curve.column("t").into_iter().enumerate() {
            let ideal = IdealMachine::at(case, t).drive_forces;
            for leg in 0..3 {
                worst = worst.max((ideal[leg] - expected[leg][k]).abs() / largest);
            }
        }
        println!("{name}: inverse dynamics off by {worst:.1e} of {largest:.3} N (limit 1e-8)");
        assert!(worst <= 1e-8, "{name}: inverse dynamics off by {worst:.2e} > 1e-8");
    }
}

/// The servo gives way by F/k_p: a few newtons over 5e5 N/m, some µm, and a little more at the
/// platform. That bounds the path error, start included, if the loop is stable.
#[test]
fn servo_runs_stably() {
    for (gravity, step) in [(0.0, 1e-5), (-9.81, 1e-5), (0.0, 1e-4), (-9.81, 1e-4)] {
        let case = Case { drive: SERVO, gravity, ..Case::default() };
        let mechanism = case.with(Bearing::Ideal);
        let (mut path_error, mut force) = (0.0f64, 0.0f64);
        run(
            &mechanism,
            StepControl::Fixed(step),
            Schedule { duration: 1.0, interval: 1e-3 },
            &mut |instant: &Instant| {
                let position = instant.states[mechanism.output].position;
                let ideal = IdealMachine::at(case, instant.t).position;
                path_error = path_error.max((position - ideal).norm());
                for f in &instant.evaluation.drive_forces {
                    force = force.max(f.abs());
                }
            },
        )
        .unwrap();
        println!(
            "servo, gravity {gravity}, step {step:.0e} s: path {path_error:.2e} m (limit 1e-4), \
             largest force {force:.2} N (limit 10)"
        );
        assert!(path_error <= 1e-4, "servo: path off by {path_error:.2e} m > 1e-4 m");
        assert!(force <= 10.0, "servo: force {force:.2} N > 10 N");
    }
}

#[test]
fn prescribed_drives_keep_their_lengths_while_journals_hit() {
    for gravity in [0.0, -9.81] {
        let mechanism = Case { gravity, ..Case::default() }.mechanism();
        let mut worst = 0.0f64;
        run(
            &mechanism,
            StepControl::Fixed(1e-5),
            Schedule { duration: 0.3, interval: 1e-4 },
            &mut |instant: &Instant| {
                let mut commands = [Command::default(); 3];
                mechanism.commands.at(instant.t, &mut commands);
                for (length, command) in instant.evaluation.lengths.iter().zip(&commands) {
                    worst = worst.max((length - command.position).abs());
                }
            },
        )
        .unwrap();
        println!("gravity {gravity}: lengths off by {worst:.2e} m (limit 1e-9)");
        assert!(worst <= 1e-9, "gravity {gravity}: lengths off by {worst:.2e} m > 1e-9 m");
    }
}
