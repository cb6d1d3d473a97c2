//! A crank about O and a rocker about D, joined by a coupler from A to B.

use super::parts::{bar, corner, described, direction, drive, ground, revolute};
use crate::scenario::{Described, FourBar, Problem, Scenario};

/// The motion is that of the crank's angle.
pub(super) fn expand(scenario: &Scenario, m: &FourBar) -> Result<Scenario, Problem> {
    let (o, d) = ([0.0, 0.0], [m.ground, 0.0]);
    let a = [m.crank * m.angle.cos(), m.crank * m.angle.sin()];
    let side = if m.crossed { -1.0 } else { 1.0 };
    let b = corner(a, d, [m.coupler, m.rocker], side).ok_or_else(|| {
        let far = (d[0] - a[0]).hypot(d[1] - a[1]);
        let message =
            format!("of {} m does not close the loop at the crank's first angle", m.coupler);
        let help = format!(
            "expected {:.4} to {:.4} m, or another mechanism.angle",
            (far - m.rocker).abs(),
            far + m.rocker
        );
        scenario.problem("mechanism.coupler", message, help)
    })?;
    let link = |name, length, ends, from: [f64; 2], to| {
        let start = [from[0], from[1], direction(from, to)];
        bar(name, m.linear_density * length, length, ends, start)
    };
    let mut bodies = vec![
        link("crank", m.crank, ["O", "A"], o, a),
        link("coupler", m.coupler, ["A", "B"], a, b),
        link("rocker", m.rocker, ["D", "B"], d, b),
    ];
    bodies[0].start[2] = m.angle;
    let machine = Described {
        ground: ground(&[("O", o), ("D", d)]),
        bodies,
        joints: vec![
            revolute(scenario, 0, "O", "ground.O", "crank.O"),
            revolute(scenario, 1, "A", "crank.A", "coupler.A"),
            revolute(scenario, 2, "B", "rocker.B", "coupler.B"),
            revolute(scenario, 3, "D", "ground.D", "rocker.D"),
        ],
        drives: vec![drive(scenario, "O", None)],
        ..Described::default()
    };
    Ok(described(scenario, machine, scenario.motion.clone(), None))
}
