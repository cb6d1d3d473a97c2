//! `[[effect]]` tables on one of several machines, up to the equations of motion.
#![no_main]

use freeplay::mechanism::{BodyState, Dynamics, Evaluation};
use freeplay::model::{assemble, close};
use freeplay::scenario::Scenario;
use freeplay_fuzz::{choice_and_text, machine_text};
use libfuzzer_sys::{fuzz_mutator, fuzz_target};

fuzz_target!(|input: &[u8]| {
    let Some((choice, effects)) = choice_and_text(input) else { return };
    let text = format!("{}\n{effects}", machine_text(choice));
    let Ok(scenario) = Scenario::from_text(&text, "effect.toml", &[]) else { return };
    let written = scenario.to_toml();
    let again = Scenario::from_text(&written, "again.toml", &[]);
    assert!(again.is_ok_and(|again| again.to_toml() == written), "{effects}");
    let Ok(machine) = assemble(&scenario) else { return };
    let mut mechanism = machine.mechanism;
    let _ = close(&scenario, &mut mechanism);
    let states: Vec<BodyState> = mechanism.bodies.iter().map(|body| body.start).collect();
    let (mut dynamics, mut now) = (Dynamics::new(&mechanism), Evaluation::new(&mechanism));
    dynamics.forces(&mechanism, 0.0, &states, &mut now);
    dynamics.accelerations(&mechanism, &states, &mut now);
});

fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| {
    freeplay_fuzz::by_lines(data, size, most, seed)
});
