//! A double pendulum: what it loses of its energy.

use super::{energy, machine, simulate};
use freeplay::engine::Schedule;

/// Two equal bars of a metre that fall from level rest.
const TEXT: &str = "
    [environment]
    gravity = [0.0, -9.81]
    [ground.points]
    O = [0.0, 0.0]
    [[body]]
    name = \"upper\"
    shape = { kind = \"bar\", from = \"O\", to = \"A\", diameter = 0.02, density = 2700.0 }
    points = { O = [0.0, 0.0], A = [1.0, 0.0] }
    [[body]]
    name = \"lower\"
    shape = { kind = \"bar\", from = \"A\", to = \"B\", diameter = 0.02, density = 2700.0 }
    points = { A = [0.0, 0.0], B = [1.0, 0.0] }
    start = [1.0, 0.0, 0.0]
    [[joint]]
    name = \"O\"
    kind = \"revolute\"
    ring = \"ground.O\"
    journal = \"upper.O\"
    [[joint]]
    name = \"A\"
    kind = \"revolute\"
    ring = \"upper.A\"
    journal = \"lower.A\"
";

#[test]
fn a_double_pendulum_keeps_its_energy() {
    let mechanism = machine(TEXT).mechanism;
    let states: Vec<_> = mechanism.bodies.iter().map(|body| body.start).collect();
    let start = energy(&mechanism, &states);
    // The height of the bars above their lowest pose, with the energy of motion, is what could be lost.
    let lowest: f64 = -9.81 * (mechanism.bodies[0].mass * 0.5 + mechanism.bodies[1].mass * 1.5);
    let scale = start - lowest;
    for (tolerance, bound) in [(1e-8, 1e-8), (1e-10, 1e-9)] {
        let (mut worst, mut turn) = (0.0f64, 0.0f64);
        let schedule = Schedule { duration: 1.0, interval: 1e-3 };
        simulate(&mechanism, tolerance, schedule, &mut |instant| {
            worst = worst.max((energy(&mechanism, instant.states) - start).abs() / scale);
            turn = turn.max((instant.angles[1] - mechanism.bodies[1].angle).abs());
        });
        println!("loses {worst:.1e} of {scale:.2} J, the lower bar turns by {turn:.1} rad");
        assert!(turn > 2.0, "hardly moves: {turn} rad");
        assert!(worst < bound, "tolerance {tolerance:e}: loses {worst:e} of its energy");
    }
}
