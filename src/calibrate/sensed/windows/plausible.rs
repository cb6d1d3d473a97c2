//! Whether recordings of a machine that nothing moves but gravity can be what they are said to be: one run, in these
//! units. Of machines with drives nothing is refused: their readings jump where a controller loses rows, and wrong
//! units of efforts are not told from wrong drives.

use super::fitting::bench::Bench;
use super::outcome::horizons;
use super::score::score;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::thresholds::{ASTRAY, FACTORS, FOLLOWED};
use crate::measure::splice::{PositionSamples, one_run};
use crate::mechanism::{Mechanism, Reads};
use crate::scenario::{Problem, Scenario};

/// Length in s of the part of a run that units are looked at in: some windows.
const PART: f64 = 3.0;

/// What speaks against recordings of a rig's machine; nothing where drives move it.
pub fn wrong(rig: &Scenario, bench: &Bench) -> Vec<String> {
    if !bench.mechanism.actuators.is_empty() {
        return Vec::new();
    }
    let spliced: Vec<String> =
        bench.runs.iter().flat_map(|run| spliced(&bench.mechanism, run)).collect();
    if !spliced.is_empty() {
        return spliced;
    }
    let runs = bench.runs.iter();
    runs.filter_map(|run| units(rig, &bench.mechanism, run)).map(|p| p.to_string()).collect()
}

/// Columns of places and angles that leave their place or speed at once. Rows that were put on a grid are not looked
/// at: splines bend there.
pub(in crate::calibrate::sensed) fn spliced(machine: &Mechanism, run: &Recording) -> Vec<String> {
    let one = |(i, sensor): (usize, &crate::mechanism::Sensor)| {
        let values = run.get(i).filter(|_| run.jitter == 0.0)?;
        let place = matches!(
            sensor.reads,
            Reads::Position(_) | Reads::X(_) | Reads::Y(_) | Reads::Angle(..)
        );
        let samples = PositionSamples {
            place: &run.path,
            column: &sensor.column,
            unit: sensor.unit(machine),
            start: run.start,
            interval: run.interval,
            values,
        };
        place.then(|| one_run(samples).err()).flatten().map(|error| error.to_string())
    };
    machine.sensors.iter().enumerate().filter_map(one).collect()
}

/// What part of its own motion a rig's machine misses of a run, at most of all columns; infinite where it cannot
/// follow at all.
fn missed(rig: &Scenario, run: Recording) -> f64 {
    let missed = || {
        let bench = Bench::new(rig, vec![run]).ok()?;
        let machines = bench.machines(&bench.declared)?;
        let horizon = *horizons(&bench).first()?;
        let none = vec![0.0; bench.sensors.len()];
        let errors = score(&bench, &machines[0], &none, 0, horizon).errors;
        let shares = errors.iter().zip(bench.motion()).map(|(error, motion)| error / motion);
        Some(shares.fold(0.0, |most: f64, share| if share <= most { most } else { share }))
    };
    missed().filter(|share| share.is_finite()).unwrap_or(f64::INFINITY)
}

/// The scales with which the machine follows a run that it goes astray of as it was read, if there are any.
fn units(rig: &Scenario, machine: &Mechanism, run: &Recording) -> Option<Problem> {
    let run = run.first(PART);
    let now = missed(rig, run.clone());
    if now <= ASTRAY {
        return None;
    }
    let sensors: Vec<usize> =
        (0..machine.sensors.len()).filter(|&i| run.get(i).is_some()).collect();
    let each = sensors.iter().map(|&i| vec![i]);
    let all = (sensors.len() > 1).then(|| sensors.clone());
    let suspects = each.chain(all).flat_map(|of| FACTORS.map(|factor| (of.clone(), factor)));
    let scaled = |of: &[usize], factor: f64| {
        let column = |i: usize| {
            let factor = if of.contains(&i) { factor } else { 1.0 };
            run.get(i).map(|values| values.iter().map(|value| value * factor).collect())
        };
        run.with((0..machine.sensors.len()).map(column).collect())
    };
    let tried = suspects.map(|(of, factor)| (missed(rig, scaled(&of, factor)), of, factor));
    let (_, of, factor) =
        tried.filter(|(share, ..)| *share <= FOLLOWED).min_by(|a, b| a.0.total_cmp(&b.0))?;
    let (keys, scales): (Vec<String>, Vec<String>) =
        of.iter().map(|&i| scaled_by(rig, machine, i, factor)).unzip();
    let message = format!(
        "makes of {} what the declared machine cannot move like: over half a second it is wrong by {:.0} % of \
         the motion",
        run.path,
        100.0 * now
    );
    Some(rig.problem(&keys[0], message, format!("it would fit with {}", scales.join(" and "))))
}

/// Where a rig says how sensor `index` is read, and what it would say with `factor` times the scale.
pub(in crate::calibrate::sensed) fn scaled_by(
    rig: &Scenario,
    machine: &Mechanism,
    index: usize,
    factor: f64,
) -> (String, String) {
    let sensor = &machine.sensors[index];
    let (column, scale) = (&sensor.column, sensor.factor * factor);
    if rig.mechanism.described().is_some() {
        let key = format!("sensor.{index}.scale");
        return (key.clone(), format!("{key} = {scale}, column \"{column}\""));
    }
    // Its columns have names and units of their own, which no key changes.
    if let crate::scenario::Mechanism::ThreeRpr(_) = rig.mechanism {
        return (format!("sensors, column {column}"), format!("column `{column}` times {factor}"));
    }
    let own = |columns: &crate::scenario::Columns| {
        let of = |name: &&str| columns.source(name).is_some_and(|source| source.column == *column);
        columns.quantities().find(of).map(str::to_owned)
    };
    // A quantity that `[columns]` does not name stands in a column of its own name.
    let name = rig.columns.as_ref().and_then(own).unwrap_or_else(|| column.clone());
    let key = format!("columns.{name}");
    (key.clone(), format!("{key} = {{ column = \"{column}\", scale = {scale} }}"))
}
