//! A platform on three legs of a driven crank and a rod each.

use super::parts::{
    bar, body, corner, described, direction, drive, ground, plain_output, revolute,
};
use super::three_rpr::triangle;
use crate::model::motion;
use crate::scenario::{Described, Problem, Scenario, Target, ThreeRrr};

/// The motion is that of the platform; all elbows lie on the same side of their legs.
pub(super) fn expand(scenario: &Scenario, m: &ThreeRrr) -> Result<Scenario, Problem> {
    let anchors = triangle(m.base_side);
    let corners = triangle(m.platform_side);
    let pose = motion::path(scenario)?.at(0.0).pose;
    let (sin, cos) = pose.z.sin_cos();
    let mut bodies = Vec::new();
    for leg in 0..3 {
        let [x, y] = corners[leg];
        let c = [pose.x + cos * x - sin * y, pose.y + sin * x + cos * y];
        let a = corner(anchors[leg], c, [m.crank, m.rod], 1.0).ok_or_else(|| {
            let far = (c[0] - anchors[leg][0]).hypot(c[1] - anchors[leg][1]);
            let message =
                format!("begins {far:.4} m from anchor O{}, where its leg does not reach", leg + 1);
            let help =
                format!("expected {:.4} to {:.4} m", (m.crank - m.rod).abs(), m.crank + m.rod);
            scenario.problem("motion", message, help)
        })?;
        let link = |name: &str, length: f64, ends, from: [f64; 2], to| {
            let start = [from[0], from[1], direction(from, to)];
            let name = format!("{name} {}", leg + 1);
            bar(&name, m.linear_density * length, length, ends, start)
        };
        bodies.push(link("crank", m.crank, ["O", "A"], anchors[leg], a));
        bodies.push(link("rod", m.rod, ["A", "C"], a, c));
    }
    let names = ["C1", "C2", "C3"];
    let named: Vec<(&str, [f64; 2])> = names.into_iter().zip(corners).collect();
    let inertia = m.platform_mass * m.platform_side.powi(2) / 12.0;
    let start = [pose.x, pose.y, pose.z];
    bodies.push(body("platform", (m.platform_mass, inertia), &named, start));
    let (mut joints, mut drives) = (Vec::new(), Vec::new());
    for (kind, letter) in ["O", "A", "C"].into_iter().enumerate() {
        for leg in 1..=3 {
            let name = format!("{letter}{leg}");
            let [ring, journal] = match kind {
                0 => [format!("ground.O{leg}"), format!("crank {leg}.O")],
                1 => [format!("crank {leg}.A"), format!("rod {leg}.A")],
                _ => [format!("platform.C{leg}"), format!("rod {leg}.C")],
            };
            joints.push(revolute(scenario, 3 * kind + leg - 1, &name, &ring, &journal));
            if kind == 0 {
                drives.push(drive(scenario, &name, None));
            }
        }
    }
    let anchored: Vec<(&str, [f64; 2])> = ["O1", "O2", "O3"].into_iter().zip(anchors).collect();
    let machine = Described {
        ground: ground(&anchored),
        bodies,
        joints,
        drives,
        outputs: plain_output("platform"),
        ..Described::default()
    };
    let target = Some(Target::Body("platform".to_owned()));
    Ok(described(scenario, machine, scenario.motion.clone(), target))
}
