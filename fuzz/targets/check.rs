//! All of `freeplay check`, over a tenth of a second of the motion: how long it takes to look at an hour is
//! what the user asked for.
#![no_main]

use freeplay::scenario::Scenario;
use freeplay::simulate::assemble;
use freeplay::study::check;
use libfuzzer_sys::{fuzz_mutator, fuzz_target};

fuzz_target!(|text: &str| {
    let Ok(scenario) = Scenario::from_text(text, "fuzzed.toml", &[]) else { return };
    let duration = scenario.simulation.duration.min(0.1);
    let interval = scenario.simulation.output_interval.min(duration);
    let mut scenario = scenario;
    (scenario.simulation.duration, scenario.simulation.output_interval) = (duration, interval);
    let Ok(mut machine) = assemble(&scenario) else { return };
    let check = check(&scenario, &mut machine);
    serde_json::to_string(&check).expect("JSON");
});

fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| {
    freeplay_fuzz::by_lines(data, size, most, seed)
});
