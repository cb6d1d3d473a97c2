//! By how much predictions miss a recording, column by column, and by how much any would.

use super::by_chance::up_to;
use crate::calibrate::sensed::motion::simulate::noisy;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::thresholds::{DRAWS, ERROR_CORNER, MET, TRIM};
use crate::calibrate::values::errors::ChannelError;
use crate::measure::filter::ZeroPhase;
use crate::mechanism::Mechanism;

/// Values that [`in_floors`] has for each that is independent of the others: four a period of the corner, where two say all.
pub const OVERSAMPLED: f64 = 2.0;

/// Lowest rate in Hz of a recording that they are looked at in: four samples a period.
pub const LOWEST_RATE: f64 = 4.0 * ERROR_CORNER;

/// The mean of noiseless recordings: the best prediction of one whose rattle nobody knows.
pub fn mean(recordings: &[Recording], sensors: usize) -> Recording {
    let columns = (0..sensors).map(|i| {
        let columns: Vec<&[f64]> = recordings.iter().filter_map(|r| r.get(i)).collect();
        let count = columns.len() as f64;
        let rows = columns.first().map(|first| 0..first.len())?;
        Some(rows.map(|row| columns.iter().map(|c| c[row]).sum::<f64>() / count).collect())
    });
    recordings[0].with(columns.collect())
}

/// The low-passed difference of two recordings in a column, ends left out.
fn missed(a: &Recording, b: &Recording, sensor: usize) -> Option<Vec<f64>> {
    let difference: Vec<f64> =
        a.get(sensor)?.iter().zip(b.get(sensor)?).map(|(a, b)| a - b).collect();
    let filtered = ZeroPhase::butterworth(4, ERROR_CORNER, a.interval).apply(&difference);
    let trim = (TRIM / a.interval).round() as usize;
    Some(filtered.get(trim..filtered.len().checked_sub(trim)?)?.to_vec())
}

/// Its root mean square.
fn rms(a: &Recording, b: &Recording, sensor: usize) -> Option<f64> {
    let missed = missed(a, b, sensor)?;
    (!missed.is_empty()).then(|| root_mean_square(&missed))
}

/// By how much the mean of noiseless `replicas` misses a recording, column by column, each in units of its floor, where it
/// has one, at four times the rate of what is looked at.
pub fn in_floors(
    machine: &Mechanism,
    recording: &Recording,
    replicas: &[Recording],
    floors: &[Option<f64>],
) -> Vec<f64> {
    let predicted = mean(replicas, machine.sensors.len());
    let stride = (0.25 / (ERROR_CORNER * recording.interval)).floor().max(1.0) as usize;
    let of = |(i, floor): (usize, &Option<f64>)| {
        let missed = missed(recording, &predicted, i)?;
        let floor = floor.filter(|floor| *floor > 0.0)?;
        Some(missed.into_iter().step_by(stride).map(move |value| value / floor))
    };
    floors.iter().enumerate().filter_map(of).flatten().collect()
}

/// What sensor noise and rattle leave to a perfect model in each measured column; `clean` are its replicas.
pub fn floors_of(machine: &Mechanism, clean: &[Recording]) -> Vec<Option<f64>> {
    let of = |i: usize| {
        let measured = !machine.sensors[i].tells();
        measured.then(|| floors(machine, clean, i)).flatten().map(|draws| root_mean_square(&draws))
    };
    (0..machine.sensors.len()).map(of).collect()
}

/// What sensor noise and rattle leave in a column to a perfect model, draw by draw: a replica with noise against the
/// mean of the others.
fn floors(machine: &Mechanism, clean: &[Recording], sensor: usize) -> Option<Vec<f64>> {
    let draw = |draw: usize| {
        let own = draw % clean.len();
        let seen = noisy(&clean[own], machine, 5000 + draw as u64);
        let others: Vec<Recording> = if clean.len() > 1 {
            let kept = clean.iter().enumerate().filter(|(i, _)| *i != own);
            kept.map(|(_, recording)| recording.clone()).collect()
        } else {
            clean.to_vec()
        };
        rms(&seen, &mean(&others, machine.sensors.len()), sensor)
    };
    (0..DRAWS).map(draw).collect()
}

/// Errors of the calibrated model in a run that are met: within [`MET`] floors, or as far from them as chance leads one of
/// the model's own replicas (`after`), whose rattle is calmer in one run than in another.
pub fn are_met(machine: &Mechanism, errors: &[ChannelError], after: &[Recording]) -> bool {
    let sensor = |error: &ChannelError| {
        machine.sensors.iter().position(|sensor| sensor.column == error.channel)
    };
    let by_chance = |error: &ChannelError| {
        let floors = sensor(error).and_then(|sensor| floors(machine, after, sensor));
        floors.is_some_and(|floors| error.after <= up_to(&floors, after.len()))
    };
    errors.iter().all(|error| error.after <= MET * error.floor || by_chance(error))
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// Errors of all measured columns of a recording of a machine: `before` and `after` are noiseless recordings of
/// the declared and of the calibrated model.
pub fn of_run(
    machine: &Mechanism,
    recording: &Recording,
    role: &'static str,
    before: &[Recording],
    after: &[Recording],
) -> Vec<ChannelError> {
    let sensors = &machine.sensors;
    let [declared, predicted] = [before, after].map(|logs| mean(logs, sensors.len()));
    let measured = |i: &usize| !sensors[*i].tells();
    (0..sensors.len())
        .filter(measured)
        .filter_map(|i| {
            Some(ChannelError {
                run: recording.name.clone(),
                role,
                channel: sensors[i].column.clone(),
                unit: sensors[i].unit(machine),
                before: rms(recording, &declared, i)?,
                after: rms(recording, &predicted, i)?,
                floor: root_mean_square(&floors(machine, after, i)?),
            })
        })
        .collect()
}
