//! A platform on three legs of a driven crank and a rod each.

use super::parts::{bar, corner, direction, drive, revolute};
use super::platform::{Platform, on_three_legs, triangle};
use crate::scenario::{Problem, Scenario, ThreeRrr};

/// The motion is that of the platform; all elbows lie on the same side of their legs.
pub(super) fn expand(scenario: &Scenario, m: &ThreeRrr) -> Result<Scenario, Problem> {
    let anchors = triangle(m.base_side);
    let platform = Platform::new(scenario, m.platform_side)?;
    let mut bodies = Vec::new();
    for (leg, &anchor) in anchors.iter().enumerate() {
        let c = platform.corner(leg);
        let a = corner(anchor, c, [m.crank, m.rod], 1.0).ok_or_else(|| {
            let far = (c[0] - anchor[0]).hypot(c[1] - anchor[1]);
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
        bodies.push(link("crank", m.crank, ["O", "A"], anchor, a));
        bodies.push(link("rod", m.rod, ["A", "C"], a, c));
    }
    bodies.push(platform.body((m.platform_mass, m.platform_inertia())));
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
    let anchors = [("O1", anchors[0]), ("O2", anchors[1]), ("O3", anchors[2])];
    Ok(on_three_legs(scenario, anchors, bodies, joints, (drives, Vec::new())))
}
