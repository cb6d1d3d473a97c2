//! An arm that swings about the joint A1 in the origin.

use super::instruments;
use super::parts::{body, described, ground, plain_output, revolute};
use crate::mechanism::pendulum::Arm;
use crate::scenario::{Described, Motion, Pendulum, Problem, Quantity, Scenario};

/// The arm's own y axis points from the pivot to its centre of mass, so that its angle counts from the upward
/// vertical.
pub(super) fn expand(scenario: &Scenario, kind: &Pendulum) -> Result<Scenario, Problem> {
    let arm = Arm { mass: kind.mass, inertia: kind.inertia, length: kind.length };
    let state = arm.state([kind.angle, kind.rate]);
    let start = [state.position.x, state.position.y, kind.angle];
    let mut bodies =
        vec![body("arm", (kind.mass, kind.inertia), &[("A", [0.0, -kind.length])], start)];
    bodies[0].velocity = state.twist.into();
    let machine = Described {
        ground: ground(&[("A1", [0.0, 0.0])]),
        bodies,
        joints: vec![revolute(scenario, 0, "A1", "ground.A1", "arm.A")],
        outputs: plain_output("arm"),
        sensors: instruments::named(scenario, &[("phi", Quantity::Position, "A1")])?,
        ..Described::default()
    };
    Ok(described(scenario, machine, Motion::Rest, None))
}
