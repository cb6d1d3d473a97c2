//! What drives of effort gave: what their sensors recorded, or, where nothing was recorded, their commands.

use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::effort_sensor;
use crate::mechanism::{Command, Commands, Drive, Mechanism, Reads};
use std::sync::Arc;

/// Recorded efforts of drives, on straight lines between rows: a motor's current is held over a control cycle
/// and known at its rows only.
#[derive(Debug)]
struct RecordedEfforts {
    interval: f64,
    columns: Vec<Vec<f64>>,
}

impl Commands for RecordedEfforts {
    fn at(&self, t: f64, commands: &mut [Command]) {
        let place = (t / self.interval).max(0.0);
        for (command, column) in commands.iter_mut().zip(&self.columns) {
            let last = column.len().saturating_sub(1);
            let i = (place as usize).min(last);
            let share = (place - i as f64).min(1.0);
            let value = column[i] + (column[(i + 1).min(last)] - column[i]) * share;
            *command = Command { position: value, ..Command::default() };
        }
    }
}

/// The sensor that says what drive `index` gave: that of its effort, else that of its command.
pub fn input_sensor(mechanism: &Mechanism, recording: &Recording, index: usize) -> Option<usize> {
    let recorded = |sensor: &usize| recording.get(*sensor).is_some();
    let command = |reads: &Reads| matches!(reads, Reads::Command(i) if *i == index);
    effort_sensor(mechanism, index).filter(recorded).or_else(|| {
        let sensor = mechanism.sensors.iter().position(|sensor| command(&sensor.reads));
        sensor.filter(recorded)
    })
}

/// What the drives of a machine gave along a recording, corrected for what their sensors get wrong; none where
/// nobody recorded it.
pub fn inputs(mechanism: &Mechanism, recording: &Recording) -> Option<Arc<dyn Commands>> {
    let column = |index: usize| {
        if mechanism.actuators[index].drive != Drive::Effort {
            return None;
        }
        let sensor = input_sensor(mechanism, recording, index)?;
        let errors = &mechanism.sensors[sensor];
        let true_effort = |read: &f64| (read - errors.offset) / errors.scale;
        Some(recording.get(sensor)?.iter().map(true_effort).collect())
    };
    let columns = (0..mechanism.actuators.len()).map(column).collect::<Option<Vec<Vec<f64>>>>()?;
    Some(Arc::new(RecordedEfforts { interval: recording.interval, columns }))
}
