//! An arm about O and a second one about A at its end.

use super::parts::{bar, described, ground, revolute};
use crate::scenario::{Described, DoublePendulum, Motion, Scenario};

pub(super) fn expand(scenario: &Scenario, m: &DoublePendulum) -> Scenario {
    let (sin, cos) = m.angles[0].sin_cos();
    let end = [m.lengths[0] * cos, m.lengths[0] * sin];
    let mut upper = bar("upper", m.masses[0], m.lengths[0], ["O", "A"], [0.0, 0.0, m.angles[0]]);
    upper.velocity = [0.0, 0.0, m.rates[0]];
    let start = [end[0], end[1], m.angles[1]];
    let mut lower = bar("lower", m.masses[1], m.lengths[1], ["A", "T"], start);
    lower.velocity = [-m.rates[0] * end[1], m.rates[0] * end[0], m.rates[1]];
    let machine = Described {
        ground: ground(&[("O", [0.0, 0.0])]),
        bodies: vec![upper, lower],
        joints: vec![
            revolute(scenario, 0, "O", "ground.O", "upper.O"),
            revolute(scenario, 1, "A", "upper.A", "lower.A"),
        ],
        ..Described::default()
    };
    described(scenario, machine, Motion::Rest, None)
}
