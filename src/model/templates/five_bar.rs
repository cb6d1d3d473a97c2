//! Two cranks about O1 and O2 that carry the point E by two rods.

use super::parts::{bar, corner, described, direction, drive, ground, revolute};
use crate::model::motion;
use crate::scenario::{Described, FiveBar, MotionTarget, Output, Problem, Scenario};

/// The motion is that of E; both elbows point outward.
pub(super) fn expand(scenario: &Scenario, m: &FiveBar) -> Result<Scenario, Problem> {
    let (o1, o2) = ([-0.5 * m.ground, 0.0], [0.5 * m.ground, 0.0]);
    let first = motion::path(scenario)?.at(0.0).pose;
    let e = [first.x, first.y];
    let elbow = |o: [f64; 2], side: f64| {
        corner(o, e, [m.crank, m.rod], side).ok_or_else(|| {
            let far = (e[0] - o[0]).hypot(e[1] - o[1]);
            let message =
                format!("begins {far:.4} m from an anchor, where its crank and rod do not reach");
            let help =
                format!("expected {:.4} to {:.4} m", (m.crank - m.rod).abs(), m.crank + m.rod);
            scenario.problem("motion", message, help)
        })
    };
    let (a1, a2) = (elbow(o1, 1.0)?, elbow(o2, -1.0)?);
    let link = |name, length, ends, from: [f64; 2], to| {
        let start = [from[0], from[1], direction(from, to)];
        bar(name, m.linear_density * length, length, ends, start)
    };
    let machine = Described {
        ground: ground(&[("O1", o1), ("O2", o2)]),
        bodies: vec![
            link("left crank", m.crank, ["O", "A"], o1, a1),
            link("right crank", m.crank, ["O", "A"], o2, a2),
            link("left rod", m.rod, ["A", "E"], a1, e),
            link("right rod", m.rod, ["A", "E"], a2, e),
        ],
        joints: vec![
            revolute(scenario, 0, "O1", "ground.O1", "left crank.O"),
            revolute(scenario, 1, "O2", "ground.O2", "right crank.O"),
            revolute(scenario, 2, "A1", "left crank.A", "left rod.A"),
            revolute(scenario, 3, "A2", "right crank.A", "right rod.A"),
            revolute(scenario, 4, "E", "left rod.E", "right rod.E"),
        ],
        drives: vec![drive(scenario, "O1", None), drive(scenario, "O2", None)],
        outputs: vec![Output {
            point: Some("left rod.E".to_owned()),
            label: Some("_E".to_owned()),
            ..Output::default()
        }],
        ..Described::default()
    };
    let target = Some(MotionTarget::Point("left rod.E".to_owned()));
    Ok(described(scenario, machine, scenario.motion.clone(), target))
}
