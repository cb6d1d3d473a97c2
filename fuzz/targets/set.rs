//! `--set PATH=VALUE`, one a line, on one of several scenarios.
#![no_main]

use freeplay::scenario::Scenario;
use freeplay_fuzz::{choice_and_text, machine_text};
use libfuzzer_sys::{fuzz_mutator, fuzz_target};

fuzz_target!(|input: &[u8]| {
    let Some((choice, text)) = choice_and_text(input) else { return };
    let sets: Vec<String> = text.lines().map(str::to_owned).collect();
    let Ok(scenario) = Scenario::from_text(machine_text(choice), "set.toml", &sets) else { return };
    let _ = scenario.hash();
    let _ = freeplay::model::parts_of(&scenario);
});

fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| {
    freeplay_fuzz::by_lines(data, size, most, seed)
});
