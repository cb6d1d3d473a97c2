//! How a recorded machine moved: the joints whose readings determine it, and their smoothed coordinates.

use super::recording::Recording;
use super::thresholds::{CORNER, LEAN_CORNER, PREFILTER, RATE, TRIM};
use crate::calibrate::spectrum::fast_length;
use crate::measure::filter::{ZeroPhase, derivative};
use crate::mechanism::{
    Actuator, BodyState, Command, Commands, Drive, JointIndex, Mechanism, Reads, Sensor,
};
use std::ops::Range;
use std::sync::Arc;

/// The sensors of joints' coordinates that together determine how a machine without clearance stands.
#[derive(Clone, Debug)]
pub struct Basis {
    /// Index of each sensor, and its joint.
    pub sensors: Vec<(usize, JointIndex)>,
}

impl Basis {
    /// Sensors of a recording that determine the machine: those of driven joints first, then others, each if it
    /// adds something. None where they do not determine it.
    pub fn of(mechanism: &Mechanism, recording: &Recording) -> Option<Self> {
        let states: Vec<BodyState> = mechanism.bodies.iter().map(|body| body.start).collect();
        let mut ideal = mechanism.without_clearance();
        let driven = |joint| mechanism.actuators.iter().any(|drive| drive.joint == joint);
        let positions = |(i, joint): (usize, JointIndex)| recording.get(i).map(|_| (i, joint));
        let mut found: Vec<(usize, JointIndex)> = mechanism
            .sensors
            .iter()
            .enumerate()
            .filter_map(|(i, sensor)| match sensor.reads {
                Reads::Position(joint) => positions((i, joint)),
                _ => None,
            })
            .collect();
        found.sort_by_key(|(_, joint)| !driven(*joint));
        ideal.actuators.clear();
        let mut sensors = Vec::new();
        for (i, joint) in found {
            ideal.actuators.push(Actuator::new("", joint, Drive::Prescribed));
            if ideal.freedoms(&states).overdriven.is_empty() {
                sensors.push((i, joint));
            } else {
                ideal.actuators.pop();
            }
        }
        let freedoms = ideal.freedoms(&states);
        (freedoms.driven == freedoms.free).then_some(Self { sensors })
    }
}

/// A recording prepared for looking at through models.
#[derive(Clone, Debug)]
pub struct View {
    /// Time between two rows of the recording in s.
    pub interval: f64,
    /// One row in so many is looked at.
    pub stride: usize,
    trim: usize,
    samples: usize,
    /// Each sensor's samples below half the rate of looking, smoothed for two derivatives, and as slow as
    /// forces that say where journals lean.
    plain: Vec<Option<Vec<f64>>>,
    smooth: Vec<Option<Vec<f64>>>,
    slow: Vec<Option<Vec<f64>>>,
}

impl View {
    /// Prepares a recording.
    pub fn new(recording: &Recording, sensors: usize) -> Self {
        let h = recording.interval;
        let nyquist = 0.5 / h;
        let stride = (1.0 / (RATE * h)).floor().max(1.0) as usize;
        let low =
            |corner: f64| (corner < 0.9 * nyquist).then(|| ZeroPhase::butterworth(4, corner, h));
        let pass = |filter: &Option<ZeroPhase>, i: usize| {
            let values = recording.get(i)?;
            Some(filter.as_ref().map_or_else(|| values.to_vec(), |f| f.apply(values)))
        };
        let [plain, smooth, slow] = [PREFILTER, CORNER, LEAN_CORNER].map(|corner| {
            let filter = low(corner);
            (0..sensors).map(|i| pass(&filter, i)).collect()
        });
        let trim = (TRIM / h).round() as usize;
        Self { interval: h, stride, trim, samples: recording.samples, plain, smooth, slow }
    }

    /// The rows that residuals can be had of: all but the ends.
    pub fn rows(&self) -> Range<usize> {
        let available = self.samples.saturating_sub(2 * self.trim) / self.stride;
        self.trim..self.trim + fast_length(available.max(1)) * self.stride
    }

    /// A sensor's samples below half the rate of looking.
    pub fn plain(&self, sensor: usize) -> Option<&[f64]> {
        self.plain[sensor].as_deref()
    }

    /// The same, smoothed.
    pub fn smooth(&self, sensor: usize) -> Option<&[f64]> {
        self.smooth[sensor].as_deref()
    }

    /// The same, as slow as what says where journals lean.
    pub fn slow(&self, sensor: usize) -> Option<&[f64]> {
        self.slow[sensor].as_deref()
    }

    /// The machine without clearance, moved as the basis was measured: readings are corrected for what the
    /// mechanism's sensors and drives are known to get wrong.
    pub fn moved(&self, mechanism: &Mechanism, basis: &Basis) -> Mechanism {
        let mut ideal = mechanism.without_clearance();
        ideal.loads.clear();
        ideal.epoch = 0.0;
        let (mut actuators, mut columns) = (Vec::new(), Vec::new());
        for &(sensor, joint) in &basis.sensors {
            let drive = mechanism.actuators.iter().position(|drive| drive.joint == joint);
            let mut actuator = drive.map_or_else(
                || Actuator::new("", joint, Drive::Prescribed),
                |drive| mechanism.actuators[drive].clone(),
            );
            columns.push(self.coordinate(mechanism, sensor, drive, &actuator));
            actuator.drive = Drive::Prescribed;
            actuator.transmission = None;
            actuators.push(actuator);
        }
        ideal.actuators = actuators;
        ideal.commands = Arc::new(Measured { interval: self.interval, columns });
        ideal
    }

    /// What a sensor looked at, out of what it shows: its delay, offset, scale and waves taken out.
    pub fn shown(&self, errors: &Sensor, series: &[f64], row: usize) -> f64 {
        let last = series.len().saturating_sub(1);
        let place = (row as f64 + errors.delay / self.interval).clamp(0.0, last as f64);
        let (i, share) = (place as usize, place.fract());
        let value = series[i] + (series[(i + 1).min(last)] - series[i]) * share;
        let read = (value - errors.offset) / errors.scale;
        let waves = errors.waves.iter();
        waves.fold(read, |q, [amplitude, phase]| q - amplitude * (read + phase).sin())
    }

    /// Coordinate, rate and acceleration that a sensor of the basis shows at each row.
    fn coordinate(
        &self,
        mechanism: &Mechanism,
        sensor: usize,
        drive: Option<usize>,
        actuator: &Actuator,
    ) -> [Vec<f64>; 3] {
        let errors = &mechanism.sensors[sensor];
        let read = self.smooth[sensor].as_deref().unwrap_or_default();
        let mut position: Vec<f64> =
            (0..read.len()).map(|row| self.shown(errors, read, row)).collect();
        let effort = drive.and_then(|drive| self.smooth(effort_sensor(mechanism, drive)?));
        if let (Some(link), Some(effort)) = (&actuator.transmission, effort) {
            // The encoder sits at the drive's end of what gives way.
            position.iter_mut().zip(effort).for_each(|(q, force)| *q -= link.pressed(*force));
        }
        let rate = derivative(&position, self.interval);
        let acceleration = derivative(&rate, self.interval);
        [position, rate, acceleration]
    }
}

/// The sensor that reads the effort of a drive.
pub fn effort_sensor(mechanism: &Mechanism, drive: usize) -> Option<usize> {
    mechanism
        .sensors
        .iter()
        .position(|sensor| matches!(sensor.reads, Reads::Effort(i) if i == drive))
}

/// The sensor that reads the coordinate of a joint.
pub fn position_sensor(mechanism: &Mechanism, joint: JointIndex) -> Option<usize> {
    let mut sensors = mechanism.sensors.iter();
    sensors.position(|sensor| matches!(sensor.reads, Reads::Position(of) if of == joint))
}

/// Measured coordinates as commands.
#[derive(Debug)]
struct Measured {
    interval: f64,
    columns: Vec<[Vec<f64>; 3]>,
}

impl Commands for Measured {
    fn at(&self, t: f64, commands: &mut [Command]) {
        let place = (t / self.interval).max(0.0);
        for (command, columns) in commands.iter_mut().zip(&self.columns) {
            let last = columns[0].len().saturating_sub(1);
            let i = (place as usize).min(last);
            let (next, share) = ((i + 1).min(last), place - i as f64);
            let [position, rate, acceleration] =
                columns.each_ref().map(|c| c[i] + (c[next] - c[i]) * share.min(1.0));
            *command = Command { position, rate, acceleration };
        }
    }
}
