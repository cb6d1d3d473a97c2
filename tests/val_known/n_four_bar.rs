//! Two four-bars side by side, through their singular pose.
//!
//! Problem A02 of the IFToMM benchmark library (lim.ii.udc.es/mbsbenchmark; González, Dopico, Lugrís,
//! Cuadrado, 2006) with N = 2: three cranks and two rungs, each 1 m long, uniform, of 1 kg, under 9.81 m/s²;
//! B0 starts above A0 with 1 m/s in x. Where all bars lie in one line, the rank of the joints' rows falls by
//! two, and each rung could fold by itself. The true motion keeps the rungs level: the angle φ of the cranks
//! from the vertical obeys `3 φ̈ = 3.5 g sin φ`. The numbers are solutions of that equation by two
//! integrators that agree to 1e-10.

use super::{body, energy, machine, short, simulate};
use freeplay::engine::Schedule;
use nalgebra::Vector2;

/// B0 in m at these times in s.
const POSITIONS: [(f64, [f64; 2]); 4] = [
    (1.0, [-0.195_020_301_9, -0.980_799_205_7]),
    (2.0, [0.057_815_795_8, 0.998_327_267_9]),
    (5.0, [-0.811_310_461_0, -0.584_615_545_3]),
    (10.0, [0.328_458_111_5, 0.944_518_538_2]),
];
/// Its velocity in m/s at the last of them.
const VELOCITY: [f64; 2] = [1.423_051_470_2, -0.494_868_845_5];

fn n_four_bar() -> String {
    let mut text = "
        [environment]
        gravity = [0.0, -9.81]
        [ground.points]
        A0 = [0.0, 0.0]
        A1 = [1.0, 0.0]
        A2 = [2.0, 0.0]
        "
    .to_owned();
    for i in 0..3 {
        // Angles count from the y axis: a crank's own y axis points to its end.
        text += &format!(
            "
            [[body]]
            name = \"crank{i}\"
            mass = 1.0
            inertia = {inertia:?}
            center_of_mass = [0.0, 0.5]
            points = {{ A = [0.0, 0.0], B = [0.0, 1.0] }}
            start = [{i}.0, 0.0, 0.0]
            velocity = [0.0, 0.0, -1.0]
            [[joint]]
            name = \"A{i}\"
            kind = \"revolute\"
            ring = \"ground.A{i}\"
            journal = \"crank{i}.A\"
            ",
            inertia = 1.0 / 12.0,
        );
    }
    for i in 0..2 {
        let next = i + 1;
        text += &format!(
            "
            [[body]]
            name = \"rung{i}\"
            mass = 1.0
            inertia = {inertia:?}
            center_of_mass = [0.5, 0.0]
            points = {{ left = [0.0, 0.0], right = [1.0, 0.0] }}
            start = [{i}.0, 1.0, 0.0]
            velocity = [1.0, 0.0, 0.0]
            [[joint]]
            name = \"left{i}\"
            kind = \"revolute\"
            ring = \"crank{i}.B\"
            journal = \"rung{i}.left\"
            [[joint]]
            name = \"right{i}\"
            kind = \"revolute\"
            ring = \"rung{i}.right\"
            journal = \"crank{next}.B\"
            ",
            inertia = 1.0 / 12.0,
        );
    }
    text
}

/// Errors of B0 at each of the four times (m) and of its velocity at the last (m/s); what the energy loses in
/// shares of it; how far a rung tilts (rad).
fn errors(tolerance: f64) -> ([f64; 5], f64, f64) {
    let mechanism = machine(&n_four_bar()).mechanism;
    let crank = body(&mechanism, "crank0");
    let rungs = ["rung0", "rung1"].map(|rung| body(&mechanism, rung));
    let states: Vec<_> = mechanism.bodies.iter().map(|body| body.start).collect();
    let start = energy(&mechanism, &states);
    let (mut errors, mut lost, mut tilt) = ([f64::NAN; 5], 0.0f64, 0.0f64);
    let schedule = Schedule { duration: 10.0, interval: 0.01 };
    simulate(&mechanism, tolerance, schedule, &mut |instant| {
        lost = lost.max((energy(&mechanism, instant.states) - start).abs() / start);
        tilt = rungs.iter().fold(tilt, |tilt, &rung| tilt.max(instant.angles[rung].abs()));
        let end = instant.states[crank].frame([0.0, 0.5].into());
        for (error, (t, expected)) in errors.iter_mut().zip(POSITIONS) {
            if (instant.t - t).abs() < 1e-9 {
                *error = (end.centre - Vector2::from(expected)).norm();
            }
        }
        errors[4] = (end.velocity - Vector2::from(VELOCITY)).norm();
    });
    (errors, lost, tilt)
}

#[test]
fn bars_go_through_their_singular_pose() {
    for tolerance in [1e-5, 1e-6, 1e-8] {
        let (errors, lost, tilt) = errors(tolerance);
        let off = short(&errors);
        println!("B0: errors {off} m (last: m/s); energy {lost:.1e}; tilt {tilt:.1e} rad");
        assert!(errors[..4].iter().all(|error| *error < 1e-7), "{tolerance:e}: {off} m");
        assert!(errors[4] < 5e-7, "{tolerance:e}: {:e} m/s", errors[4]);
        assert!(lost < 1e-8, "{tolerance:e}: loses {lost:e} of its energy");
        assert!(tilt < 1e-6, "{tolerance:e}: a rung tilts by {tilt:e} rad");
    }
}
