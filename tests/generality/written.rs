//! The scenario that is written reads back to the same machine and the same results.

use crate::chain::{Form, go};
use crate::every_chain;
use freeplay::mechanism::Mechanism;
use freeplay::model::assemble;
use freeplay::scenario::Scenario;
use std::cell::Cell;

/// Every number of every row, bit by bit.
fn bits(mechanism: &Mechanism) -> Result<Vec<u64>, String> {
    let mut bits = Vec::new();
    go(mechanism, 1e-5, 0.01, 5e-4, |instant| {
        let now = instant.evaluation;
        let states = instant.states.iter();
        let states =
            states.flat_map(|s| [s.position.x, s.position.y, s.rotation.re, s.rotation.im]);
        let forces = now.reactions.iter().flatten().chain(&now.drive_forces);
        bits.extend(states.chain(forces.copied()).map(f64::to_bits));
        bits.extend(now.accelerations.iter().flatten().map(|a| a.to_bits()));
        bits.extend(instant.angles.iter().map(|angle| angle.to_bits()));
    })?;
    Ok(bits)
}

fn repeats(cases: u32) {
    let numbers = Cell::new(0);
    every_chain(cases, |chain| {
        let form = Form { perturbed: true, c_max: 300.0, ..Form::default() };
        let scenario = chain.scenario(&form)?;
        let text = scenario.to_toml();
        let again = Scenario::from_text(&text, "written.toml", &[]).map_err(|e| e.to_string())?;
        if again.mechanism != scenario.mechanism || again.motion != scenario.motion {
            return Err("another machine or motion is read".to_owned());
        }
        if again.to_toml() != text || again.hash() != scenario.hash() {
            return Err("another text is written".to_owned());
        }
        let [first, second] = [&scenario, &again].map(|scenario| {
            let machine = assemble(scenario).map_err(|e| e.to_string())?;
            bits(&machine.mechanism)
        });
        let (first, second) = (first?, second?);
        numbers.set(numbers.get() + first.len());
        if first == second { Ok(()) } else { Err("another result".to_owned()) }
    });
    println!("{cases} chains written and read: {} numbers equal to the bit", numbers.get());
}

#[test]
fn what_is_written_reads_back_to_the_same_results() {
    repeats(48);
}

#[test]
#[ignore = "a campaign of some minutes"]
fn what_is_written_of_many_reads_back() {
    repeats(4000);
}
