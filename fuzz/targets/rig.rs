//! A rig and a recording beside it: the rig up to a line of dashes, the recording after it.
#![no_main]

use freeplay::calibrate::sensed::recording::Recording;
use freeplay::model::parts_of;
use freeplay::scenario::Scenario;
use libfuzzer_sys::{fuzz_mutator, fuzz_target};

fuzz_target!(|text: &str| {
    let (rig, rows) = text.split_once("\n---\n").unwrap_or((text, ""));
    let Ok(scenario) = Scenario::from_text(rig, "rig.toml", &[]) else { return };
    let Ok(mechanism) = parts_of(&scenario) else { return };
    let sensors = &mechanism.sensors;
    let path = freeplay_fuzz::file("run.csv", rows.as_bytes());
    let read = Recording::read_with_time(&path, sensors, true, scenario.time_column());
    let Ok(recording) = read else { return };
    let _ = recording.wrong();
    let _ = scenario.columns.as_ref().map(|columns| recording.lacks(sensors, columns));
    let _ = recording.to_csv(sensors);
});

fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| {
    freeplay_fuzz::by_lines(data, size, most, seed)
});
