//! The reader of scenarios: what it takes it also writes, and reads again as the same.
#![no_main]

use freeplay::model::{expand, parts_of};
use freeplay::scenario::Scenario;
use libfuzzer_sys::{fuzz_mutator, fuzz_target};

fuzz_target!(|text: &str| {
    let Ok(scenario) = Scenario::from_text(text, "fuzzed.toml", &[]) else { return };
    again(&scenario);
    let _ = parts_of(&scenario);
    if let Ok(expanded) = expand(&scenario) {
        let _ = expanded.to_toml();
    }
});

fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| {
    freeplay_fuzz::by_lines(data, size, most, seed)
});

fn again(scenario: &Scenario) {
    let text = scenario.to_toml();
    let again = Scenario::from_text(&text, "again.toml", &[]).unwrap_or_else(|problems| {
        panic!("its own text is refused: {problems}\n{text}");
    });
    assert_eq!(again.to_toml(), text);
}
