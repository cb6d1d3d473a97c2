//! A load that slides along the x axis on the driven joint P1.

use super::instruments;
use super::parts::{body, described, drive, ground, plain_output, prismatic};
use crate::model::motion;
use crate::scenario::{
    Described, DriveMode, DriveStage, JointLine, JointMotion, JointMultisine, JointPath,
    JointQuintic, JointTable, Motion, Problem, Quantity, Scenario, Term, Term1,
};
use std::f64::consts::FRAC_PI_2;

/// Inertia in kg·m² of the load, which cannot turn: any would do.
const INERTIA: f64 = 1.0;

/// The length is the x of the motion.
pub(super) fn expand(scenario: &Scenario, stage: &DriveStage) -> Result<Scenario, Problem> {
    let first = motion::path(scenario)?.at(0.0);
    let mut bodies =
        vec![body("load", (stage.mass, INERTIA), &[("P", [0.0, 0.0])], [first.pose.x, 0.0, 0.0])];
    bodies[0].velocity = [first.rate.x, 0.0, 0.0];
    let machine = Described {
        ground: ground(&[("P", [0.0, 0.0])]),
        bodies,
        joints: vec![prismatic("P1", "ground.P", "load.P", None)],
        drives: vec![drive(scenario, "P1", Some("1"))],
        outputs: plain_output("load"),
        sensors: instruments::named(scenario, known(scenario.drive.mode))?,
        ..Described::default()
    };
    let motion =
        Motion::Joints(vec![JointMotion { joint: "P1".to_owned(), path: along(scenario) }]);
    Ok(described(scenario, machine, motion, None))
}

/// What recordings of a stage hold: of a sampled controller what it asks of its drive, and what was added to that.
fn known(mode: DriveMode) -> &'static [(&'static str, Quantity, &'static str)] {
    const COMMAND: (&str, Quantity, &str) = ("q1_cmd", Quantity::Command, "P1");
    const LENGTH: (&str, Quantity, &str) = ("q1", Quantity::Position, "P1");
    const SAMPLED: [(&str, Quantity, &str); 4] =
        [COMMAND, LENGTH, ("F1", Quantity::Output, "P1"), ("added1", Quantity::Added, "P1")];
    const OTHERS: [(&str, Quantity, &str); 3] = [COMMAND, LENGTH, ("F1", Quantity::Force, "P1")];
    if mode == DriveMode::Sampled { &SAMPLED } else { &OTHERS }
}

/// The x of a path.
fn along(scenario: &Scenario) -> JointPath {
    let term = |term: &Term| Term1 {
        amplitude: term.amplitude[0],
        frequency: term.frequency,
        phase: term.phase,
    };
    match &scenario.motion {
        Motion::Circle(circle) => JointPath::Multisine(JointMultisine {
            center: Some(circle.center[0]),
            terms: vec![Term1 {
                amplitude: circle.radius,
                frequency: 1.0 / circle.period,
                phase: circle.phase + FRAC_PI_2,
            }],
        }),
        Motion::Line(line) => {
            JointPath::Line(JointLine { start: Some(line.start[0]), velocity: line.velocity[0] })
        }
        Motion::Quintic(quintic) => JointPath::Quintic(JointQuintic {
            from: Some(quintic.from[0]),
            to: quintic.to[0],
            time: quintic.time,
        }),
        Motion::Multisine(multisine) => JointPath::Multisine(JointMultisine {
            center: Some(multisine.center[0]),
            terms: multisine.terms.iter().map(term).collect(),
        }),
        Motion::Table(table) => {
            JointPath::Table(JointTable { file: table.file.clone(), column: Some("x".to_owned()) })
        }
        Motion::Joints(_) | Motion::Rest => JointPath::Line(JointLine::default()),
    }
}
