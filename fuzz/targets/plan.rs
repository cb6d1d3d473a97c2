//! What a plan is asked, and within which limits: a byte chooses one of six machines, lines are options as `freeplay plan`
//! takes them, and what follows a line of dashes is the report of a calibration.
#![no_main]

use freeplay::calibrate::plan::{PlanRequest, prepare};
use libfuzzer_sys::{fuzz_mutator, fuzz_target};

fuzz_target!(|input: &[u8]| {
    let Some((choice, text)) = freeplay_fuzz::choice_and_text(input) else { return };
    let (options, report) = match text.split_once("\n---\n") {
        Some((options, report)) => (options, Some(report)),
        None => (text, None),
    };
    let mut request = PlanRequest { candidates: 8, ..PlanRequest::default() };
    for line in options.lines() {
        let (flag, value) = line.split_once(' ').unwrap_or((line, ""));
        let value = value.to_owned();
        match flag {
            "--between" => request.between.push(value),
            "--detect" => request.detect.push(value),
            "--stroke" => request.stroke.push(value),
            "--speed" => request.speed.push(value),
            "--acceleration" => request.acceleration.push(value),
            "--drive-force" => request.force.push(value),
            "--duration" => request.duration = value.parse().ok(),
            "--gain" => request.gain = value.parse().ok(),
            _ => {}
        }
    }
    request.report = report.map(|text| freeplay_fuzz::file("report.json", text.as_bytes()));
    let _ = prepare(freeplay_fuzz::machine(choice).clone(), &request);
});

fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| {
    freeplay_fuzz::by_lines(data, size, most, seed)
});
