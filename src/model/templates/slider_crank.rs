//! A crank about O, a rod from its pin A to the pin B of a slider.

use super::parts::{bar, body, described, direction, drive, ground, prismatic, revolute};
use crate::scenario::{Described, Problem, Scenario, SliderCrank};

/// The motion is that of the crank's angle.
pub(super) fn expand(scenario: &Scenario, m: &SliderCrank) -> Result<Scenario, Problem> {
    let pin = [m.crank * m.angle.cos(), m.crank * m.angle.sin()];
    let height = m.offset - pin[1];
    let reach = m.rod * m.rod - height * height;
    if reach < 0.0 {
        let message = format!("of {} m does not reach the slider's line from the crank pin", m.rod);
        let help = format!("expected at least {:.4} m, or another angle", height.abs());
        return Err(scenario.problem("mechanism.rod", message, help));
    }
    let slider = [pin[0] + reach.sqrt(), m.offset];
    let machine = Described {
        ground: ground(&[("O", [0.0, 0.0]), ("S", [0.0, m.offset])]),
        bodies: vec![
            bar("crank", m.crank_mass, m.crank, ["O", "A"], [0.0, 0.0, m.angle]),
            bar("rod", m.rod_mass, m.rod, ["A", "B"], [pin[0], pin[1], direction(pin, slider)]),
            // It cannot turn: any inertia would do.
            body(
                "slider",
                (m.slider_mass, 1e-4),
                &[("B", [0.0, 0.0])],
                [slider[0], slider[1], 0.0],
            ),
        ],
        joints: vec![
            revolute(scenario, 0, "O", "ground.O", "crank.O"),
            revolute(scenario, 1, "A", "crank.A", "rod.A"),
            revolute(scenario, 2, "B", "slider.B", "rod.B"),
            prismatic("slide", "ground.S", "slider.B", None),
        ],
        drives: vec![drive(scenario, "O", None)],
        ..Described::default()
    };
    Ok(described(scenario, machine, scenario.motion.clone(), None))
}
