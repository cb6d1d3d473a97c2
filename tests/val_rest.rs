//! Coming to rest: an arm with dry friction loses what Coulomb says, stops, and stays.

use freeplay::effects::{Setting, named};
use freeplay::engine::{Schedule, StepControl, run};
use freeplay::mechanism::pendulum::{Arm, angle, build};
use freeplay::mechanism::{Bearing, Mechanism};
use nalgebra::Vector2;
use std::f64::consts::PI;

const ARM: Arm = Arm { mass: 0.15, inertia: 1e-4, length: 0.15 };
const GRAVITY: f64 = 9.81;

/// Largest torque of gravity in N m.
fn weight() -> f64 {
    ARM.mass * ARM.length * GRAVITY
}

/// The pendulum at rest at an angle (rad) from hanging, with bristles of dry friction (N m) that bend by
/// `presliding` rad, and viscous friction (N m s).
fn pendulum(start: f64, dry: f64, presliding: f64, viscous: f64) -> Mechanism {
    let gravity = Vector2::new(0.0, -GRAVITY);
    let mut mechanism = build(ARM, Bearing::Ideal, [PI + start, 0.0], gravity);
    let effect = |kind: &str, values: &[(&'static str, f64)]| {
        Setting::new(named(kind).expect("an effect"), Some("A1"), values)
    };
    let bristles = [("coulomb_Nm", dry), ("presliding_rad", presliding)];
    for setting in [
        effect("bristle-friction", &bristles),
        effect("pivot-friction", &[("viscous_Nms", viscous)]),
    ] {
        setting.apply(&mut mechanism).expect("applied");
    }
    mechanism
}

/// Time (s), angle from hanging (rad) and rate (rad/s) every `interval` s.
fn swing(mechanism: &Mechanism, control: StepControl, schedule: Schedule) -> Vec<[f64; 3]> {
    let mut rows = Vec::new();
    run(mechanism, control, schedule, &mut |instant| {
        let [angle, rate] = angle(&instant.states[0], PI);
        rows.push([instant.t, angle - PI, rate]);
    })
    .expect("swings");
    rows
}

/// Largest deviations between changes of direction.
fn turns(rows: &[[f64; 3]]) -> Vec<f64> {
    let turning = rows.windows(2).filter(|pair| pair[0][2] * pair[1][2] < 0.0);
    // Between two rows the angle is a parabola: its vertex.
    turning
        .map(|pair| {
            let share = pair[0][2] / (pair[0][2] - pair[1][2]);
            pair[0][1] + 0.5 * share * pair[0][2] * (pair[1][0] - pair[0][0])
        })
        .map(f64::abs)
        .collect()
}

const CONTROLS: [StepControl; 2] = [StepControl::Fixed(2e-4), StepControl::Tolerance(1e-7)];

/// Dry friction alone: `m g a (cos φ₂ − cos φ₁) = T (φ₁ + φ₂)` from turn to turn, of which small angles
/// make `φ₁ − φ₂ = 2T/(m g a)`. Bristles that bend by d keep back no more than `T d` at each turn.
#[test]
fn each_half_swing_loses_what_coulomb_says() {
    let (dry, presliding) = (0.004 * weight(), 2e-6);
    for control in CONTROLS {
        let schedule = Schedule { duration: 4.0, interval: 1e-3 };
        let turns = turns(&swing(&pendulum(0.1, dry, presliding, 0.0), control, schedule));
        assert!(turns.len() >= 9, "{turns:?}");
        for pair in turns[..9].windows(2) {
            let loss = (pair[1].cos() - pair[0].cos()) / (pair[0] + pair[1]);
            assert!((loss / 0.004 - 1.0).abs() < 1e-3, "{control:?}: {loss} of 0.004");
            let small = (pair[0] - pair[1]) / (2.0 * 0.004);
            assert!((small - 1.0).abs() < 3e-3, "{control:?}: {small}");
        }
    }
}

#[test]
fn an_arm_that_stops_stays() {
    for viscous in [0.0, 2e-4] {
        for control in CONTROLS {
            let dry = 0.004 * weight();
            let schedule = Schedule { duration: 60.0, interval: 0.1 };
            let rows = swing(&pendulum(0.1, dry, 1e-3, viscous), control, schedule);
            let energy = |row: &[f64; 3]| {
                0.5 * ARM.about_pivot() * row[2] * row[2] + weight() * (1.0 - row[1].cos())
            };
            // Without friction there are 8 mrad a swing less from 100 mrad on: it stops within 10 s.
            let resting = &rows[300..];
            let band = 0.004f64.asin();
            let [first, .., last] = resting else { panic!("rows") };
            for row in resting {
                assert!(row[2].abs() < 1e-9, "{viscous} {control:?}: {row:?}");
                assert!(row[1].abs() <= band, "{viscous} {control:?}: {row:?}");
            }
            assert!((first[1] - last[1]).abs() < 1e-9);
            assert!((energy(first) - energy(last)).abs() < 1e-12 * weight());
            // Energy beside that of the bristles, at most T d, only falls.
            let held = dry * 1e-3;
            for pair in rows.windows(2) {
                assert!(energy(&pair[1]) <= energy(&pair[0]) + held);
            }
        }
    }
}

/// Below break-away it does not move by more than its bristles bend; above it slides.
#[test]
fn an_arm_breaks_away_where_gravity_exceeds_dry_friction() {
    let (dry, presliding) = (0.1 * weight(), 1e-3);
    let schedule = Schedule { duration: 5.0, interval: 0.01 };
    for (start, slides) in [(0.09, false), (0.11, true)] {
        let rows = swing(&pendulum(start, dry, presliding, 0.0), CONTROLS[1], schedule);
        let moved = start - rows[rows.len() - 1][1];
        assert_eq!(moved > 5.0 * presliding, slides, "{start}: {moved}");
    }
}
