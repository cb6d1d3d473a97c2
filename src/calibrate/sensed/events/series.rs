//! Efforts that a recorded motion takes beside what a model knows of, over time.

use crate::calibrate::sensed::motion::basis::Basis;
use crate::calibrate::sensed::motion::motions::Motions;
use crate::calibrate::sensed::recorded::view::{View, position_sensor};
use crate::calibrate::sensed::residuals::residual::{ResidualKind, residuals};
use crate::measure::filter::derivative;
use crate::mechanism::{JointIndex, Mechanism};

/// One freedom of a machine along a recording.
#[derive(Clone, Debug)]
pub struct Freedom {
    /// Name of the joint.
    pub joint: String,
    /// Whether its coordinate is an angle.
    pub turns: bool,
    /// Effort that acts beside what the model knows of, in N or N·m: `M a − w − Bᵀ τ` along the joint.
    pub effort: Vec<f64>,
    /// Coordinate (m or rad), rate and acceleration; none where nobody measured them.
    pub motion: Option<[Vec<f64>; 3]>,
}

/// All freedoms at the same instants.
#[derive(Clone, Debug)]
pub struct FreedomSeries {
    /// The recording.
    pub run: String,
    /// Time of the first instant in s, from the first row of the recording on.
    pub first: f64,
    /// Time between two instants in s.
    pub interval: f64,
    /// The freedoms.
    pub freedoms: Vec<Freedom>,
}

impl FreedomSeries {
    /// Of a view of a recording under a machine that moves along it; none where the machine cannot be as it was
    /// measured, or nobody knows the efforts of its drives.
    pub fn of(run: &str, view: &View, mechanism: &Mechanism, basis: &Basis) -> Option<Self> {
        let rows = view.rows();
        let found = residuals(view, mechanism, basis, rows.clone(), &Motions::default())?;
        let dynamics = found.names.iter().zip(found.signals);
        let freedoms: Vec<Freedom> = dynamics
            .filter(|(name, _)| name.kind == ResidualKind::Dynamics)
            .filter_map(|(name, signal)| {
                let (_, joint) = mechanism.joints().find(|(known, _)| *known == name.of)?;
                let effort = signal.values.iter().map(|value| -value).collect();
                let at =
                    |all: Vec<f64>| rows.clone().step_by(view.stride).map(|i| all[i]).collect();
                let motion = motion(view, mechanism, joint).map(|motion| motion.map(at));
                let turns = matches!(joint, JointIndex::Revolute(_));
                Some(Freedom { joint: name.of.clone(), turns, effort, motion })
            })
            .collect();
        let finite = freedoms.iter().flat_map(|f| &f.effort).all(|value| value.is_finite());
        (finite && !freedoms.is_empty()).then(|| Self {
            run: run.to_owned(),
            first: rows.start as f64 * view.interval,
            interval: view.interval * view.stride as f64,
            freedoms,
        })
    }

    /// Less what the look itself gets wrong: the same of simulated recordings of that very model, on average.
    pub fn without_bias(mut self, simulated: &[Self]) -> Self {
        for own in simulated {
            for (freedom, bias) in self.freedoms.iter_mut().zip(&own.freedoms) {
                let share = 1.0 / simulated.len() as f64;
                let pairs = freedom.effort.iter_mut().zip(&bias.effort);
                pairs.for_each(|(value, bias)| *value -= share * bias);
            }
        }
        self
    }

    /// Number of instants.
    pub fn count(&self) -> usize {
        self.freedoms.first().map_or(0, |freedom| freedom.effort.len())
    }

    /// Instants in so many seconds, at least one.
    pub fn instants(&self, seconds: f64) -> usize {
        (seconds / self.interval).round().max(1.0) as usize
    }

    /// Time of an instant in s, from the first row of the recording on.
    pub fn time(&self, instant: usize) -> f64 {
        self.first + instant as f64 * self.interval
    }
}

fn motion(view: &View, mechanism: &Mechanism, joint: JointIndex) -> Option<[Vec<f64>; 3]> {
    let sensor = position_sensor(mechanism, joint)?;
    let series = view.smooth(sensor)?;
    let errors = &mechanism.sensors[sensor];
    let position: Vec<f64> = (0..series.len()).map(|row| view.shown(errors, series, row)).collect();
    let rate = derivative(&position, view.interval);
    let acceleration = derivative(&rate, view.interval);
    Some([position, rate, acceleration])
}

/// Means of a signal over stretches of `width` instants around each, under a raised cosine that falls to zero at
/// the stretch's ends; empty where the signal is shorter than that.
pub fn means(signal: &[f64], width: usize) -> Vec<f64> {
    use std::f64::consts::TAU;
    let weight = |k: usize| 0.5 - 0.5 * (TAU * (k + 1) as f64 / (width + 1) as f64).cos();
    let weights: Vec<f64> = (0..width).map(weight).collect();
    let total: f64 = weights.iter().sum();
    let mean = |part: &[f64]| part.iter().zip(&weights).map(|(v, w)| v * w).sum::<f64>() / total;
    signal.windows(width).map(mean).collect()
}

/// Median of absolute values, by which a normal number of deviation 1 is 1.
pub fn scatter(values: &[f64]) -> f64 {
    1.4826 * median(values.iter().map(|value| value.abs()).collect())
}

/// Median; 0 of nothing.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
