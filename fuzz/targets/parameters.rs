//! Parameters of one run as other programs write them, and the scenario that they make.
#![no_main]

use freeplay::scenario::{DEFAULT_TOML, Scenario};
use freeplay::study::evaluate::Parameters;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &[u8]| {
    let file = freeplay_fuzz::file("parameters", text);
    let Ok(parameters) = Parameters::read(&file) else { return };
    let sets = parameters.sets();
    let _ = Scenario::from_text(DEFAULT_TOML, "default.toml", &sets);
});
