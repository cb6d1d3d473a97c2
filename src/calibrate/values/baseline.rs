//! What simulations of a model say of its own residuals.

use super::model::{Ensemble, Known, LegsCase, LegsSegment, SearchError};
use crate::calibrate::measured::draws::{Coefficients, difference, mean, without};
use crate::calibrate::measured::lens::Lens;
use crate::calibrate::measured::rattle;
use crate::calibrate::measured::replica;
use crate::calibrate::measured::spectrum::Noise;
use crate::calibrate::measured::start::{MISSED, SwingStart};
use crate::effects::Setting;
use crate::measure::log::Log;
use crate::scenario::Problem;
use nalgebra::DVector;
use rayon::prelude::*;
use std::f64::consts::SQRT_2;
use std::sync::Arc;

/// What simulations of a model say of its own residuals: their mean, which is the lens's fault, and
/// their spread, which is noise.
#[derive(Clone, Debug)]
pub struct LegsBaseline {
    /// One per segment.
    parts: Vec<SegmentBaseline>,
    /// How each run's machine starts.
    pub starts: Vec<SwingStart>,
    /// Whether the model's joints rattle.
    pub rattles: bool,
    /// Its noiseless logs, prepared to be looked at: `[run][replica]`.
    views: Arc<Vec<Vec<Lens>>>,
    /// Those logs.
    pub logs: Arc<Vec<Vec<Log>>>,
    /// Noiseless logs of its machines without a swing, run by run.
    still: Arc<Vec<Log>>,
}

/// A baseline that saves time, for a model of which much is known.
#[derive(Clone, Copy, Debug)]
pub enum Like<'a> {
    /// Of a model with other effects: its swing is found from that one's.
    Beside(&'a LegsBaseline),
    /// Of the same model at values nearby: where joints stay loaded its swing is as large.
    Same(&'a LegsBaseline),
}

impl<'a> Like<'a> {
    fn baseline(self) -> &'a LegsBaseline {
        match self {
            Self::Beside(baseline) | Self::Same(baseline) => baseline,
        }
    }
}

#[derive(Clone, Debug)]
struct SegmentBaseline {
    segment: LegsSegment,
    bias: Vec<Vec<f64>>,
    noise: Noise,
    /// The draws from which the noise was taken, in its units.
    draws: Vec<DVector<f64>>,
    /// What of the residual is the platform's swing, by the share that may be missed.
    swing: Vec<Vec<f64>>,
    /// What the noise has more of, as a logarithm of its determinant, for the recorded swing being lost, or
    /// for joints that rattle although they stay loaded as declared.
    lost: f64,
}

/// Draws of sensor noise from which a covariance is taken.
const DRAWS: usize = 16;

impl LegsCase {
    /// The baseline of a model with these effects, from simulations of it.
    ///
    /// Where joints stay loaded the platform swings in their play, and a lens's fault is to see that
    /// swing: what the same machine does without a swing tells where. Where this one does not swing as
    /// recorded, the swing of the model that is `like` it is noise.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn baseline(
        &self,
        effects: &[Setting],
        segments: &[LegsSegment],
        like: Option<Like>,
    ) -> Result<LegsBaseline, SearchError> {
        let same = match like {
            Some(Like::Same(like)) if self.chaotic || !like.rattles => Some(like),
            _ => None,
        };
        let like = like.map(Like::baseline);
        let known = Known {
            starts: like.map(|like| like.starts.as_slice()),
            still: same.map(|same| (&same.still, same.rattles)),
        };
        let Ensemble { starts, logs, still, rattles } =
            self.ensemble(effects, rattle::REPLICAS, known)?;
        let views: Vec<Vec<Lens>> =
            logs.iter().map(|logs| logs.par_iter().map(view).collect()).collect();
        let simulated = Simulated {
            case: self,
            starts: &starts,
            logs: &logs,
            views: &views,
            still: &still,
            rattles,
        };
        let parts = segments.iter().map(|segment| simulated.part(segment, same, like)).collect();
        Ok(LegsBaseline {
            parts,
            starts,
            rattles,
            views: Arc::new(views),
            logs: Arc::new(logs),
            still,
        })
    }

    /// Noiseless logs of a model with these effects, which its baseline is `like`: `[run][replica]`, to
    /// predict with. A search compares models by the same few replicas; a prediction is better for being
    /// the mean of more, and where joints stay loaded for the best start that a log shows.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn predictions(
        &self,
        effects: &[Setting],
        like: &LegsBaseline,
    ) -> Result<Vec<Vec<Log>>, SearchError> {
        let still = like.rattles.then_some((&like.still, true));
        let known = Known { starts: Some(&like.starts), still };
        Ok(self.ensemble(effects, 2 * rattle::REPLICAS, known)?.logs)
    }

    /// Residuals of the data under a model in units of noise, of all segments in a row.
    ///
    /// # Errors
    /// An effect that the machine cannot take.
    pub fn white(
        &self,
        baseline: &LegsBaseline,
        effects: &[Setting],
        segments: &[LegsSegment],
    ) -> Result<DVector<f64>, Problem> {
        self.white_of(baseline, effects, segments, None)
    }

    /// The same of one of the baseline's replicas in place of the data.
    ///
    /// # Errors
    /// An effect that the machine cannot take.
    pub fn white_of(
        &self,
        baseline: &LegsBaseline,
        effects: &[Setting],
        segments: &[LegsSegment],
        replica: Option<usize>,
    ) -> Result<DVector<f64>, Problem> {
        let mut all = Vec::new();
        for part in baseline.parts.iter().filter(|part| segments.contains(&part.segment)) {
            let run = &self.runs[part.segment.run];
            let machine = run.machine(&self.rig, effects)?;
            let lens = replica.map_or(&run.lens, |r| &baseline.views[part.segment.run][r]);
            let mut coefficients = self.coefficients(lens, &machine, &part.segment);
            for (values, bias) in coefficients.iter_mut().zip(&part.bias) {
                for (value, bias) in values.iter_mut().zip(bias) {
                    *value -= bias;
                }
            }
            all.extend(part.noise.whiten(&coefficients).iter());
        }
        Ok(DVector::from_vec(all))
    }
}

fn view(log: &Log) -> Lens {
    Lens::new(log).expect("the channels of the recorded log")
}

/// Simulations of a model.
struct Simulated<'a> {
    case: &'a LegsCase,
    starts: &'a [SwingStart],
    logs: &'a [Vec<Log>],
    views: &'a [Vec<Lens>],
    still: &'a [Log],
    rattles: bool,
}

impl Simulated<'_> {
    /// Bias and noise on one segment, with the swing of the `same` model at values nearby, or one as large as that of a
    /// model like it, where they are known.
    fn part(
        &self,
        segment: &LegsSegment,
        same: Option<&LegsBaseline>,
        like: Option<&LegsBaseline>,
    ) -> SegmentBaseline {
        let views = &self.views[segment.run];
        let clean: Vec<Coefficients> =
            views.par_iter().map(|lens| self.seen(lens, segment)).collect();
        let bias = mean(&clean);
        let draws = self.draws(segment, &clean, &bias);
        let swing =
            self.known_swing(same, segment).unwrap_or_else(|| self.swing(segment, &clean, &bias));
        let (noise, swing, lost) = self.noise(segment, &clean, &draws, swing, like);
        let draws = draws.iter().map(|draw| noise.whiten(draw)).collect();
        SegmentBaseline { segment: segment.clone(), bias, noise, draws, swing, lost }
    }

    /// Coefficients of residuals.
    fn seen(&self, lens: &Lens, segment: &LegsSegment) -> Coefficients {
        self.case.coefficients(lens, &self.starts[segment.run].machine, segment)
    }

    /// The same of a log with noise of its own.
    fn noisy(&self, log: &Log, draw: usize, segment: &LegsSegment) -> Coefficients {
        let log = replica::with_noise(log, &self.case.simulator.sensors, draw as u64 + 1000);
        self.seen(&view(&log), segment)
    }

    /// The swing that another baseline has on a segment, if joints rattle in both or in none.
    fn known_swing(
        &self,
        like: Option<&LegsBaseline>,
        segment: &LegsSegment,
    ) -> Option<Coefficients> {
        let parts = &like.filter(|like| like.rattles == self.rattles)?.parts;
        Some(parts.iter().find(|part| part.segment == *segment)?.swing.clone())
    }

    /// A replica stands for the data, the mean of the others for the bias: sensor noise, the rattle of one
    /// run, and what is left of it in a mean.
    fn draws(
        &self,
        segment: &LegsSegment,
        clean: &[Coefficients],
        bias: &[Vec<f64>],
    ) -> Vec<Coefficients> {
        let logs = &self.logs[segment.run];
        let draw = |draw: usize| {
            let index = draw % clean.len();
            let seen = self.noisy(&logs[index], draw, segment);
            difference(&seen, &without(bias, &clean[index], clean.len()))
        };
        (0..DRAWS).into_par_iter().map(draw).collect()
    }

    /// What of the residual is the platform's swing, by the share that may be missed.
    fn swing(
        &self,
        segment: &LegsSegment,
        clean: &[Coefficients],
        bias: &[Vec<f64>],
    ) -> Coefficients {
        let mut swing = difference(bias, &self.seen(&view(&self.still[segment.run]), segment));
        for (channel, swing) in swing.iter_mut().enumerate() {
            let share =
                if self.rattles { SQRT_2 * coherence(clean, channel, swing) } else { MISSED };
            swing.iter_mut().for_each(|value| *value *= share);
        }
        swing
    }

    /// Noise that these draws are of, the swing in it, and what it has more of: see [`SegmentBaseline`].
    fn noise(
        &self,
        segment: &LegsSegment,
        clean: &[Coefficients],
        draws: &[Coefficients],
        swing: Coefficients,
        like: Option<&LegsBaseline>,
    ) -> (Noise, Coefficients, f64) {
        if self.rattles && !self.case.chaotic {
            // Beside models whose noise is the sensors' alone.
            let log = &self.logs[segment.run][0];
            let draw = |draw| difference(&self.noisy(log, draw, segment), &clean[0]);
            let sensors: Vec<_> = (0..DRAWS).into_par_iter().map(draw).collect();
            let sensors = Noise::from_draws(&sensors, &swing).log_determinant();
            let noise = Noise::from_draws(draws, &swing);
            let lost = noise.log_determinant() - sensors;
            return (noise, swing, lost);
        }
        if self.rattles || self.starts[segment.run].shown {
            return (Noise::from_draws(draws, &swing), swing, 0.0);
        }
        // Two swings of one size and any phase; the size that models beside it have, for they are
        // compared.
        let swing = self.known_swing(like, segment).unwrap_or(swing);
        let larger: Coefficients = swing
            .iter()
            .map(|channel| channel.iter().map(|value| value * SQRT_2 / MISSED).collect())
            .collect();
        let noise = Noise::from_draws(draws, &larger);
        let lost = noise.swinging() - Noise::from_draws(draws, &swing).swinging();
        (noise, swing, lost)
    }
}

impl LegsBaseline {
    /// How many replicas it rests on.
    pub fn replicas(&self) -> usize {
        self.views.first().map_or(0, Vec::len)
    }

    /// Logarithm of the determinant of the noise on segments.
    pub fn log_determinant(&self, on: &[LegsSegment]) -> f64 {
        let parts = self.parts.iter().filter(|part| on.contains(&part.segment));
        parts.map(|part| part.noise.log_determinant()).sum()
    }

    /// What a model pays on segments for having lost the recorded swing, or for a rattle that the declared
    /// machine has not: its noise is larger.
    pub fn lost(&self, on: &[LegsSegment]) -> f64 {
        let parts = self.parts.iter().filter(|part| on.contains(&part.segment));
        parts.map(|part| part.lost).sum()
    }

    /// What noise alone may be like on segments: as [`LegsCase::white`] would see it, draw by draw.
    pub fn draws(&self, on: &[LegsSegment]) -> Vec<DVector<f64>> {
        let parts = || self.parts.iter().filter(|part| on.contains(&part.segment));
        let of = |draw: usize| parts().flat_map(move |part| part.draws[draw].iter().copied());
        (0..DRAWS).map(|draw| DVector::from_vec(of(draw).collect())).collect()
    }

    /// Channel (servo, closure, dynamics of each leg) and frequency in Hz of each number of
    /// [`LegsCase::white`] for these segments.
    pub fn places(&self, case: &LegsCase, segments: &[LegsSegment]) -> Vec<(usize, f64)> {
        let parts = self.parts.iter().filter(|part| segments.contains(&part.segment));
        parts
            .flat_map(|part| {
                let rows = part.segment.rows.len() as f64;
                let step = 0.5 / (rows * case.runs[part.segment.run].log.interval);
                part.noise.places().into_iter().map(move |(c, k)| (c, k as f64 * step))
            })
            .collect()
    }
}

/// Share of a swing, mean of replicas less a machine at rest, that is no rattle: what replicas differ by
/// would be as large in both. Its phase is anybody's guess after some seconds, and two swings of one size
/// and any phase differ by √2 of it.
fn coherence(replicas: &[Vec<Vec<f64>>], channel: usize, swing: &[f64]) -> f64 {
    let count = replicas.len() as f64;
    let square = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
    let mean = &mean(replicas)[channel];
    let from_mean = |replica: &Vec<Vec<f64>>| {
        square(&replica[channel].iter().zip(mean).map(|(a, b)| a - b).collect::<Vec<_>>())
    };
    let rattle = replicas.iter().map(from_mean).sum::<f64>() / (count - 1.0);
    (1.0 - (1.0 + 1.0 / count) * rattle / square(swing).max(f64::MIN_POSITIVE)).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Six replicas of one channel that swing alike, and differ by a rattle of this size besides.
    fn replicas(swing: f64, rattle: f64) -> Vec<Vec<Vec<f64>>> {
        let of = |replica: usize| {
            let value = |k: usize| {
                // Tones that stand at right angles to each other and to the swing.
                let own = (TAU * (20.0 + replica as f64) * k as f64 / 200.0).sin();
                swing * (TAU * 3.0 * k as f64 / 200.0).sin() + rattle * own
            };
            vec![(0..200).map(value).collect()]
        };
        (0..6).map(of).collect()
    }

    fn share(swing: f64, rattle: f64) -> f64 {
        let replicas = replicas(swing, rattle);
        // The machine at rest does not move.
        let swing = mean(&replicas).remove(0);
        coherence(&replicas, 0, &swing)
    }

    #[test]
    fn what_replicas_have_in_common_is_a_swing() {
        assert!((share(1.0, 0.0) - 1.0).abs() < 1e-12);
        assert!(share(0.0, 1.0) == 0.0);
        // Rattle of amplitude 0.5: of the difference 1 + 0.25/6 is the mean's and 0.25 (1 + 1/6) rattle's.
        let expected = f64::sqrt(1.0 - 0.25 * (1.0 + 1.0 / 6.0) / (1.0 + 0.25 / 6.0));
        assert!((share(1.0, 0.5) - expected).abs() < 1e-9);
    }
}
