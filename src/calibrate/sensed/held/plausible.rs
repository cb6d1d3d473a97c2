//! Whether recordings of a held machine can be what they are said to be: one run, at its controllers' rate, in these
//! units.

use super::bench::suits;
use crate::calibrate::sensed::motion::simulate::outputs;
use crate::calibrate::sensed::motion::start::told_by;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::{output_sensor, position_sensor};
use crate::calibrate::sensed::thresholds::{CLOCK, FACTORS, TOLERATED};
use crate::calibrate::sensed::windows::plausible::{scaled_by, spliced};
use crate::mechanism::{Cascade, Drive, Mechanism, Reads};
use crate::scenario::Scenario;

/// What speaks against a recording of a rig's machine; nothing of machines that are not held so.
pub fn wrong(rig: &Scenario, machine: &Mechanism, recording: &Recording) -> Vec<String> {
    if !suits(machine) {
        return Vec::new();
    }
    let spliced = spliced(machine, recording);
    if !spliced.is_empty() {
        return spliced;
    }
    let drives = machine.actuators.iter().enumerate();
    let of = |(index, drive): (usize, &crate::mechanism::Actuator)| match drive.drive {
        Drive::Sampled(cascade) => {
            clock(recording, &cascade).or_else(|| units(rig, machine, recording, index))
        }
        Drive::Prescribed | Drive::Servo { .. } | Drive::Effort => None,
    };
    drives.filter_map(of).collect()
}

/// A recording that does not hold every sample of a controller.
fn clock(recording: &Recording, cascade: &Cascade) -> Option<String> {
    let off = (recording.interval / cascade.interval - 1.0).abs();
    (off > CLOCK).then(|| {
        format!(
            "{} has a sample every {:.6} s, and the controller takes one every {} s; write drive.sampled.interval \
             as it is, or a scale for columns.t: a recording needs every sample of its controller",
            recording.path, recording.interval, cascade.interval
        )
    })
}

/// Columns of a drive that its controller's law shows to be in other units; nothing where one of them is missing.
fn units(
    rig: &Scenario,
    machine: &Mechanism,
    recording: &Recording,
    drive: usize,
) -> Option<String> {
    let encoder = position_sensor(machine, machine.actuators[drive].joint)?;
    let output = output_sensor(machine, drive)?;
    let is_command = |reads: &Reads| matches!(reads, Reads::Command(i) if *i == drive);
    let command = machine.sensors.iter().position(|sensor| is_command(&sensor.reads))?;
    told_by(machine, recording, Reads::Command(drive))?;
    let (read, asked) = (recording.get(encoder)?, recording.get(output)?);
    // What the law makes of the readings differs from what was recorded by this share of it.
    let off = |of: &[usize], factor: f64| {
        let by = |sensor: usize| if of.contains(&sensor) { factor } else { 1.0 };
        let scaled =
            |sensor: usize, values: &[f64]| values.iter().map(|v| v * by(sensor)).collect();
        let columns = (0..machine.sensors.len())
            .map(|i| recording.get(i).map(|values| -> Vec<f64> { scaled(i, values) }));
        let other = recording.with(columns.collect());
        let read: Vec<f64> = scaled(encoder, read);
        let told = outputs(machine, &other, drive, &read);
        let left = told.iter().zip(asked).map(|(told, asked)| (told - by(output) * asked).powi(2));
        (left.sum::<f64>() / told.iter().map(|told| told * told).sum::<f64>()).sqrt()
    };
    let now = off(&[], 1.0);
    if now <= TOLERATED {
        return None;
    }
    let suspects: [&[usize]; 4] = [&[output], &[encoder], &[command], &[encoder, command]];
    let tried = suspects.iter().flat_map(|of| FACTORS.map(|factor| (off(of, factor), *of, factor)));
    let best = tried.filter(|(left, ..)| *left <= TOLERATED).min_by(|a, b| a.0.total_cmp(&b.0));
    let help = match best {
        Some((_, of, factor)) => {
            let scales: Vec<String> =
                of.iter().map(|&sensor| scaled_by(rig, machine, sensor, factor).1).collect();
            format!("it would fit with {}", scales.join(" and "))
        }
        None => {
            "look at columns and their scales, and at what is declared of the machine".to_owned()
        }
    };
    Some(format!(
        "{}: the controller of {} says the force from the lengths: the recording is off by {:.0} %; {help}",
        recording.path,
        machine.actuators[drive].name,
        100.0 * now
    ))
}
