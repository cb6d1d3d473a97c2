//! The machine's parameters: what the paper gives, what it leaves open, and what is used here.

use super::variants::{CLEARANCES, LARGE};
use crate::report::number;
use crate::scenario::{DriveMode, Mechanism, Motion, Scenario, ThreeRpr};
use crate::simulate::Machine;
use serde::Serialize;

/// One parameter.
#[derive(Clone, Debug, Serialize)]
pub struct PaperParameter {
    /// What it is.
    pub name: &'static str,
    /// The paper's value with its unit; none where it is silent.
    pub paper: Option<String>,
    /// The value used here with its unit.
    pub used: String,
    /// Where the value used comes from.
    pub origin: Origin,
    /// Where it stands in the paper, or why this value was assumed.
    pub note: &'static str,
}

/// Where a value comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Origin {
    /// The paper gives it.
    Paper,
    /// The paper does not give it.
    Assumed,
    /// The paper gives another, and the user asked for this one.
    Changed,
}

impl Origin {
    /// In one word.
    pub fn in_words(self) -> &'static str {
        match self {
            Origin::Paper => "paper",
            Origin::Assumed => "assumed",
            Origin::Changed => "changed",
        }
    }
}

/// A number that the paper gives.
fn given(
    name: &'static str,
    unit: &str,
    paper: f64,
    used: f64,
    note: &'static str,
) -> PaperParameter {
    let value = |v: f64| format!("{} {unit}", number(v)).trim_end().to_owned();
    let same = (used / paper - 1.0).abs() < 1e-9;
    let origin = if same { Origin::Paper } else { Origin::Changed };
    PaperParameter { name, paper: Some(value(paper)), used: value(used), origin, note }
}

/// Something that the paper does not give.
fn assumed(name: &'static str, used: String, note: &'static str) -> PaperParameter {
    PaperParameter { name, paper: None, used, origin: Origin::Assumed, note }
}

/// The table of a scenario; `machine` is its machine.
pub fn parameters(scenario: &Scenario, machine: &Machine) -> Vec<PaperParameter> {
    let Mechanism::ThreeRpr(declared) = &scenario.mechanism else { return Vec::new() };
    [
        dimensions_and_material(scenario, declared),
        joints_and_contacts(scenario, machine),
        motion(scenario),
        masses_and_shapes(scenario, declared),
        surroundings_and_drives(scenario),
    ]
    .concat()
}

/// A length in m in mm.
fn mm(metres: f64) -> String {
    format!("{} mm", number(1e3 * metres))
}

fn dimensions_and_material(scenario: &Scenario, m: &ThreeRpr) -> Vec<PaperParameter> {
    let (legs, contact) = (&scenario.legs, &scenario.contact);
    vec![
        given("platform, side length", "mm", 100.0, 1e3 * m.platform_side, "table 1"),
        given("platform, mass", "kg", 0.2, m.platform_mass, "table 1"),
        given("base, side length", "mm", 660.0, 1e3 * m.base_side, "table 1"),
        given("links, density", "kg/m³", 2270.0, legs.density, "table 1"),
        given("links, Young's modulus", "GPa", 73.0, 1e-9 * contact.youngs_modulus, "table 1"),
        given("links, Poisson's ratio", "", 0.3, contact.poisson_ratio, "table 1"),
        PaperParameter {
            name: "stroke of the actuators",
            paper: Some("motion course amplitude 200 mm".into()),
            used: format!("{} to {}", mm(legs.stroke[0]), mm(legs.stroke[1])),
            origin: Origin::Assumed,
            note: "table 1 gives the course, not where it begins",
        },
    ]
}

fn joints_and_contacts(scenario: &Scenario, machine: &Machine) -> Vec<PaperParameter> {
    let (contact, joints) = (&scenario.contact, &scenario.joints);
    let stiffness =
        machine.contact(0, 0.1).and_then(|(law, _)| law.stiffness()).unwrap_or(f64::NAN);
    vec![
        given("bearing radius", "mm", 10.0, 1e3 * joints.bearing_radius, "section 3.1"),
        PaperParameter {
            name: "radial clearances",
            paper: Some(format!("{} and 0.00001 mm", mm(LARGE))),
            used: CLEARANCES.map(|c| format!("{} mm", number(1e3 * c))).join(", "),
            origin: Origin::Paper,
            note: "section 3.1 and figures 7 to 9; what lies between the two is added here; the \
                   bearing keeps its radius",
        },
        given("exponent of the penetration", "", 1.5, contact.exponent, "section 3.2"),
        given(
            "contact stiffness K",
            "N/m^1.5",
            // Eq. 5 with h = (1 − ν²)/(πE): 4/(3π · 2h) √(R_i R_j/(R_i + R_j)) at 10 and 9.5 mm.
            2.0 * 73e9 / (3.0 * (1.0 - 0.09)) * (0.01f64 * 0.0095 / 0.0195).sqrt(),
            stiffness,
            "eq. 5, at 0.5 mm of clearance",
        ),
        assumed(
            "damping at full depth C_max",
            format!("{} N·s/m", number(contact.c_max)),
            "with d_max: a journal of 0.1 kg that hits at 0.1 m/s keeps 0.73 of its speed. ADAMS' own \
             default is 1e4 N·s/m",
        ),
        assumed(
            "penetration at full damping d_max",
            format!("{} m", number(contact.d_max)),
            "see C_max. ADAMS' own default is 1e-4 m",
        ),
        assumed(
            "pulling contacts",
            if contact.clip { "none: the force is clipped at 0" } else { "as eq. 4 is printed" }
                .to_owned(),
            "eq. 4 can pull while the surfaces part; ADAMS' IMPACT never does",
        ),
    ]
}

fn motion(scenario: &Scenario) -> Vec<PaperParameter> {
    vec![
        PaperParameter {
            name: "trajectory",
            paper: Some("\"a trajectory with a constant velocity\"".into()),
            used: trajectory(&scenario.motion),
            origin: Origin::Assumed,
            note: "section 2 names neither path nor speed; within the stroke",
        },
        assumed(
            "platform angle phi",
            match &scenario.motion {
                Motion::Circle(circle) => format!("{} rad", number(circle.phi)),
                Motion::Line(line) => format!("{} rad", number(line.phi)),
                _ => String::new(),
            },
            "π/6; the machine is singular at 0 and π, wherever the platform is",
        ),
    ]
}

fn masses_and_shapes(scenario: &Scenario, m: &ThreeRpr) -> Vec<PaperParameter> {
    let legs = &scenario.legs;
    vec![
        assumed(
            "platform, moment of inertia",
            format!("{} kg·m²", number(m.platform_inertia())),
            "a thin uniform triangular plate, m L²/12",
        ),
        assumed(
            "cylinders",
            format!("{} long, {} thick", mm(legs.cylinder_length), mm(legs.cylinder_diameter)),
            "solid round bars; the paper gives their density only",
        ),
        assumed(
            "rods",
            format!("{} long, {} thick", mm(legs.rod_length), mm(legs.rod_diameter)),
            "as the cylinders",
        ),
    ]
}

fn surroundings_and_drives(scenario: &Scenario) -> Vec<PaperParameter> {
    let gravity = scenario.environment.gravity;
    vec![
        assumed(
            "gravity",
            format!("({}, {}) m/s²", number(gravity[0]), number(gravity[1])),
            "a horizontal table",
        ),
        assumed(
            "friction in the joints",
            number(scenario.joints.friction.values().iter().copied().fold(0.0, f64::max)),
            "the paper has none in its equations",
        ),
        assumed(
            "drives",
            match scenario.drive.mode {
                DriveMode::Prescribed => "lengths follow the inverse kinematics exactly",
                DriveMode::Servo => "servos",
                DriveMode::Sampled => "sampled controllers",
            }
            .to_owned(),
            "what motions in ADAMS do; section 2 takes the inputs from the inverse kinematics",
        ),
        assumed(
            "start",
            "ideal pose and velocity, journals centred".to_owned(),
            "statistics leave out the first 0.2 s, in which the journals find their rings",
        ),
    ]
}

fn trajectory(motion: &Motion) -> String {
    match motion {
        Motion::Circle(c) => format!(
            "circle of {} mm at constant speed, {} s a turn",
            number(1e3 * c.radius),
            number(c.period)
        ),
        Motion::Line(l) => {
            format!("straight line at {} m/s", number(l.velocity[0].hypot(l.velocity[1])))
        }
        _ => String::new(),
    }
}
