//! Machines by name: each kind of `[mechanism]` expands to the description that a file may give itself.

mod double_pendulum;
mod drive_stage;
mod five_bar;
mod four_bar;
mod instruments;
mod parts;
mod pendulum;
mod platform;
mod slider_crank;
mod three_rpr;
mod three_rrr;

pub use instruments::{instrumented, laboratory};
pub use three_rpr::{LegUse, leg_use};

use crate::scenario::{Mechanism, Problem, Scenario};

/// The same scenario about a machine that describes itself; one that does so already, as it is.
///
/// ```
/// use freeplay::model::{expand, parts_of};
/// use freeplay::scenario::Scenario;
///
/// let paper = Scenario::load(None, &[])?;
/// let described = expand(&paper)?;
/// assert!(described.to_toml().contains("[[body]]"), "a file body by body");
/// assert_eq!(parts_of(&described)?.bodies.len(), parts_of(&paper)?.bodies.len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A template whose machine cannot be put together, a table that cannot be read.
pub fn expand(scenario: &Scenario) -> Result<Scenario, Problem> {
    match &scenario.mechanism {
        Mechanism::Described(_) => Ok(scenario.clone()),
        Mechanism::ThreeRpr(machine) => three_rpr::expand(scenario, machine),
        Mechanism::DriveStage(machine) => drive_stage::expand(scenario, machine),
        Mechanism::Pendulum(machine) => pendulum::expand(scenario, machine),
        Mechanism::SliderCrank(machine) => slider_crank::expand(scenario, machine),
        Mechanism::FourBar(machine) => four_bar::expand(scenario, machine),
        Mechanism::FiveBar(machine) => five_bar::expand(scenario, machine),
        Mechanism::ThreeRrr(machine) => three_rrr::expand(scenario, machine),
        Mechanism::DoublePendulum(machine) => Ok(double_pendulum::expand(scenario, machine)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Joint;

    /// Lists of clearances and frictions are in the order of these names.
    #[test]
    fn revolute_joints_are_those_that_the_kind_names() {
        for kind in Mechanism::KINDS {
            let text = format!("mechanism = {{ kind = \"{kind}\" }}\n");
            let scenario = Scenario::from_text(&text, "test.toml", &[]).unwrap();
            let expanded = expand(&scenario).unwrap();
            let joints = &expanded.mechanism.described().unwrap().joints;
            let revolute = joints.iter().filter(|joint| matches!(joint, Joint::Revolute(_)));
            let mut made: Vec<&str> = revolute.map(Joint::name).collect();
            let mut named = scenario.mechanism.revolute_names();
            made.sort_unstable();
            named.sort_unstable();
            assert_eq!(made, named, "{kind}");
        }
    }
}
