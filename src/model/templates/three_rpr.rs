//! The 3-RPR: a platform on three telescopic legs between A1 A2 A3 on the ground and its corners C1 C2 C3.

use super::instruments;
use super::parts::{body, drive, prismatic, revolute};
use super::platform::{Platform, on_three_legs, triangle};
use crate::mechanism::motion::Motion;
use crate::mechanism::three_rpr::{Geometry, Reach, reach};
use crate::scenario::{Legs, Problem, Scenario, ThreeRpr};
use std::f64::consts::PI;

/// How far each leg travels, and how near the machine comes to a singularity.
pub type LegUse = Reach;

/// How far each leg travels, and how near the machine comes to a singularity.
pub fn leg_use(scenario: &Scenario, machine: &ThreeRpr, motion: &dyn Motion) -> LegUse {
    let geometry = Geometry { base_side: machine.base_side, platform_side: machine.platform_side };
    reach(&geometry, motion, scenario.simulation.duration, scenario.legs.stroke)
}

/// Mass in kg and inertia in kg·m² about its middle of a solid round bar of a length and a diameter in m:
/// `m L²/12 + m r²/4`.
fn round_bar(density: f64, [length, diameter]: [f64; 2]) -> (f64, f64) {
    let radius = 0.5 * diameter;
    let mass = density * PI * radius * radius * length;
    (mass, mass * (length * length / 12.0 + radius * radius / 4.0))
}

/// Bodies are the cylinder and the rod of each leg in turn, then the platform; axes of bars have their origin
/// in the middle.
pub(super) fn expand(scenario: &Scenario, machine: &ThreeRpr) -> Result<Scenario, Problem> {
    let Legs { density, stroke, .. } = scenario.legs;
    let cylinder = [scenario.legs.cylinder_length, scenario.legs.cylinder_diameter];
    let rod = [scenario.legs.rod_length, scenario.legs.rod_diameter];
    let anchors = triangle(machine.base_side);
    let platform = Platform::new(scenario, machine.platform_side)?;
    let mut bodies = Vec::new();
    for (leg, &[ax, ay]) in anchors.iter().enumerate() {
        let [cx, cy] = platform.corner(leg);
        let angle = (cy - ay).atan2(cx - ax);
        let (s, c) = angle.sin_cos();
        let half = [0.5 * cylinder[0], 0.5 * rod[0]];
        let start = [ax + c * half[0], ay + s * half[0], angle];
        let name = format!("cylinder {}", leg + 1);
        bodies.push(body(&name, round_bar(density, cylinder), &[("A", [-half[0], 0.0])], start));
        let start = [cx - c * half[1], cy - s * half[1], angle];
        let name = format!("rod {}", leg + 1);
        bodies.push(body(&name, round_bar(density, rod), &[("C", [half[1], 0.0])], start));
    }
    let mut moved = platform.body((machine.platform_mass, machine.platform_inertia()));
    let sensors = instruments::of(scenario, &mut moved, &["P1", "P2", "P3"]);
    bodies.push(moved);
    let mut joints = Vec::new();
    for leg in 0..3 {
        let (ring, journal) = (format!("ground.A{}", leg + 1), format!("cylinder {}.A", leg + 1));
        joints.push(revolute(scenario, leg, &format!("A{}", leg + 1), &ring, &journal));
    }
    for leg in 0..3 {
        let (ring, journal) = (format!("platform.C{}", leg + 1), format!("rod {}.C", leg + 1));
        joints.push(revolute(scenario, leg + 3, &format!("C{}", leg + 1), &ring, &journal));
    }
    let mut drives = Vec::new();
    for leg in 1..=3 {
        let (base, slider) = (format!("cylinder {leg}.A"), format!("rod {leg}.C"));
        joints.push(prismatic(&format!("P{leg}"), &base, &slider, Some(stroke)));
        drives.push(drive(scenario, &format!("P{leg}"), Some(&leg.to_string())));
    }
    let anchors = [("A1", anchors[0]), ("A2", anchors[1]), ("A3", anchors[2])];
    Ok(on_three_legs(scenario, anchors, bodies, joints, (drives, sensors)))
}
