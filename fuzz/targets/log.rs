//! Recorded runs of machines with sensors as CSV.
#![no_main]

use freeplay::calibrate::sensed::recording::Recording;
use freeplay::mechanism::Sensor;
use freeplay::model::parts_of;
use freeplay_fuzz::{file, machine};
use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use std::sync::LazyLock;

static SENSORS: LazyLock<Vec<Vec<Sensor>>> =
    LazyLock::new(|| (0..6).map(|i| parts_of(machine(i)).expect("an asset").sensors).collect());

fuzz_target!(|rows: &[u8]| {
    let path = file("run.csv", rows);
    // Any of them, the same for the same input.
    let choice = rows.len() % SENSORS.len();
    let (sensors, time) = (&SENSORS[choice], machine(choice as u8).time_column());
    let Ok(recording) = Recording::read_with_time(&path, sensors, true, time) else { return };
    assert!(recording.interval > 0.0 && recording.samples > 1);
    let _ = recording.wrong();
    let _ = recording.to_csv(sensors);
});

fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| {
    freeplay_fuzz::by_lines(data, size, most, seed)
});
