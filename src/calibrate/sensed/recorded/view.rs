//! Recordings prepared for looking at: every sensor's samples, smoothed as they are needed.

use super::recording::Recording;
use crate::calibrate::sensed::thresholds::{CORNER, LEAN_CORNER, PREFILTER, RATE, TRIM};
use crate::calibrate::values::spectrum::fast_length;
use crate::measure::filter::ZeroPhase;
use crate::mechanism::{JointIndex, Mechanism, Reads, Sensor};
use std::ops::Range;

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
        Self::through(recording, sensors, [PREFILTER, CORNER, LEAN_CORNER], RATE)
    }

    /// The same with other corners in Hz of the low-passes, and looked at `rate` times a second at least.
    pub fn through(recording: &Recording, sensors: usize, corners: [f64; 3], rate: f64) -> Self {
        let h = recording.interval;
        let nyquist = 0.5 / h;
        let stride = (1.0 / (rate * h)).floor().max(1.0) as usize;
        let low =
            |corner: f64| (corner < 0.9 * nyquist).then(|| ZeroPhase::butterworth(4, corner, h));
        let pass = |filter: &Option<ZeroPhase>, i: usize| {
            let values = recording.get(i)?;
            Some(filter.as_ref().map_or_else(|| values.to_vec(), |f| f.apply(values)))
        };
        let [plain, smooth, slow] = corners.map(|corner| {
            let filter = low(corner);
            (0..sensors).map(|i| pass(&filter, i)).collect()
        });
        let trim = (TRIM / h).round() as usize;
        Self { interval: h, stride, trim, samples: recording.samples, plain, smooth, slow }
    }

    /// Number of rows.
    pub fn samples(&self) -> usize {
        self.samples
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

/// The sensor that reads what the sampled controller of a drive asks of it.
pub fn output_sensor(mechanism: &Mechanism, drive: usize) -> Option<usize> {
    let mut sensors = mechanism.sensors.iter();
    sensors.position(|sensor| matches!(sensor.reads, Reads::Output(i) if i == drive))
}
