//! The 3-RPR: a platform on three telescopic legs between A1 A2 A3 on the ground and its corners C1 C2 C3.

use super::parts::{body, described, drive, ground, plain_output, prismatic, revolute};
use crate::mechanism::motion::Motion;
use crate::mechanism::three_rpr::{Geometry, Reach, reach};
use crate::model::motion;
use crate::scenario::{Described, Legs, Problem, Scenario, Target, ThreeRpr};
use std::f64::consts::PI;

/// How far each leg travels, and how near the machine comes to a singularity.
pub type LegUse = Reach;

/// How far each leg travels, and how near the machine comes to a singularity.
pub fn leg_use(scenario: &Scenario, machine: &ThreeRpr, motion: &dyn Motion) -> LegUse {
    let geometry = Geometry { base_side: machine.base_side, platform_side: machine.platform_side };
    reach(&geometry, motion, scenario.simulation.duration, scenario.legs.stroke)
}

/// Corners in m of an equilateral triangle about the origin, at angles 7π/6 + 2π/3·i.
pub(super) fn triangle(side: f64) -> [[f64; 2]; 3] {
    [0.0, 1.0, 2.0].map(|i| {
        let angle = 7.0 * PI / 6.0 + 2.0 * PI / 3.0 * i;
        let radius = side / 3f64.sqrt();
        [angle.cos() * radius, angle.sin() * radius]
    })
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
    let (anchors, corners) = (triangle(machine.base_side), triangle(machine.platform_side));
    let pose = motion::path(scenario)?.at(0.0).pose;
    let (sin, cos) = pose.z.sin_cos();
    let mut bodies = Vec::new();
    for leg in 0..3 {
        let ([ax, ay], [x, y]) = (anchors[leg], corners[leg]);
        let [cx, cy] = [pose.x + cos * x - sin * y, pose.y + sin * x + cos * y];
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
    let named: Vec<(&str, [f64; 2])> = ["C1", "C2", "C3"].into_iter().zip(corners).collect();
    let platform = (machine.platform_mass, machine.platform_inertia());
    bodies.push(body("platform", platform, &named, [pose.x, pose.y, pose.z]));
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
    let anchored: Vec<(&str, [f64; 2])> = ["A1", "A2", "A3"].into_iter().zip(anchors).collect();
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
