//! Whole motions: what every sensor shows of a machine that does not rattle, held against simulations sample by sample.
//!
//! Residuals look at efforts, and forget what these add up to: a pendulum that swings freely is led by a thousandth of its
//! weight to another phase, while at each instant no effort stands above what two derivatives make of an encoder's steps.
//! A simulation remembers, but each look costs one. So this is asked last: where residuals are noise and predictions
//! still miss the recordings. Efforts, positions and accelerations count alike, in units of their sensors' noise; where
//! a machine was let go is fitted with the values.

use super::estimate::View;
use super::problem::{Problem, Stopped};
use super::simulate::with_noise;
use super::thresholds::{DRAWS, MISSED, PLAIN_BAND};
use crate::calibrate::fit::{free, values, with_values};
use crate::calibrate::least_squares::{Effort, Free, jacobian, least_squares};
use crate::calibrate::spectrum::{Noise, Signal, transform};
use crate::effects::Setting;
use crate::mechanism::Sensor;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Change of a coordinate in m or rad by which derivatives by where a machine is let go are taken: far above rounding, far
/// below a swing.
const SMALL: f64 = 1e-4;

/// Steps of Gauss and Newton, and the drop of Σ of squares that is none: a look costs a simulation.
const EFFORT: Effort = Effort { steps: 4, enough: 2.0, secant: true };

/// One run of a model beside its recording.
struct Part {
    run: usize,
    /// Where the model is let go, in m or rad: the coordinates that its drives leave free.
    coordinates: Vec<f64>,
    /// What sensors showed.
    data: Vec<Vec<f64>>,
    noise: Noise,
}

/// Whole motions of a model beside recordings.
pub(super) struct Whole<'a> {
    problem: &'a Problem,
    parts: Vec<Part>,
}

/// Effects with where the machine was let go, fitted to one run, and what they leave on all.
#[derive(Clone)]
pub(super) struct Fitted {
    /// The effects at their values.
    pub effects: Vec<Setting>,
    /// Σ of squares on the run that they were fitted to.
    pub own: f64,
    /// The same on the others.
    pub held: f64,
}

impl<'a> Whole<'a> {
    /// Those of a model with these effects.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn of(problem: &'a Problem, effects: &[Setting]) -> Result<Self, Stopped> {
        let starts = problem.starts(effects)?;
        let simulated = problem.simulated(&starts, 1)?;
        let still = problem.still(&starts)?;
        let sensors = &problem.declared.sensors;
        let part = |run: usize| {
            let (clean, view) = (&simulated[run][0], &problem.runs[run].view);
            let own = shown(sensors, &View::new(clean, sensors.len()));
            let draws: Vec<Vec<Vec<f64>>> = (0..DRAWS as u64)
                .into_par_iter()
                .map(|draw| {
                    let noisy = with_noise(clean, sensors, draw + 7000);
                    difference(&shown(sensors, &View::new(&noisy, sensors.len())), &own, 1.0)
                })
                .collect();
            // How bodies swing in their play when a recording begins is known in its size alone.
            let swing = match &still[run] {
                Some(still) => {
                    let still = shown(sensors, &View::new(still, sensors.len()));
                    difference(&own, &still, MISSED)
                }
                None => own.iter().map(|column| vec![0.0; column.len()]).collect(),
            };
            let noise = Noise::from_draws(&draws, &swing);
            let coordinates = starts[run].coordinates().to_vec();
            Part { run, coordinates, data: shown(sensors, view), noise }
        };
        Ok(Self { problem, parts: (0..problem.runs.len()).map(part).collect() })
    }

    /// What a model misses of a run in units of noise; none where there is no such machine.
    fn missed(&self, part: &Part, effects: &[Setting], from: &[f64]) -> Option<DVector<f64>> {
        let sensors = &self.problem.declared.sensors;
        let simulated = self.problem.from(effects, part.run, from).ok()?;
        let own = shown(sensors, &View::new(&simulated, sensors.len()));
        let white = part.noise.whiten(&difference(&part.data, &own, 1.0));
        white.iter().all(|value| value.is_finite()).then_some(white)
    }

    /// What a model misses of the run that values are fitted to, and the derivatives of that by its values and by where it
    /// is let go.
    pub fn at(&self, effects: &[Setting]) -> Option<(DVector<f64>, Option<DMatrix<f64>>)> {
        let part = &self.parts[0];
        let (free, start) = unknown(effects, part);
        let look = |all: &[f64]| self.look(part, effects, all);
        let white = look(&start)?;
        let columns = jacobian(&look, &free, &start, &white);
        Some((white, columns))
    }

    /// What a model misses of that run beside `last`, one more effect, and the derivatives by the values of that.
    pub fn beside(
        &self,
        effects: &[Setting],
        last: &Setting,
    ) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let part = &self.parts[0];
        let one = std::slice::from_ref(last);
        let look = |own: &[f64]| {
            let all = [effects, &with_values(one, own)].concat();
            self.missed(part, &all, &part.coordinates)
        };
        let own = values(one);
        let white = look(&own)?;
        let columns = jacobian(&look, &free(one), &own, &white)?;
        Some((white, columns))
    }

    fn look(&self, part: &Part, effects: &[Setting], all: &[f64]) -> Option<DVector<f64>> {
        let (own, from) = all.split_at(all.len() - part.coordinates.len());
        self.missed(part, &with_values(effects, own), from)
    }

    /// The effects with the values that explain the first run best, from these on, judged by the others: there where the
    /// machine was let go alone is fitted.
    pub fn fitted(&self, effects: &[Setting]) -> Option<Fitted> {
        let part = &self.parts[0];
        let (free, start) = unknown(effects, part);
        let look = |all: &[f64]| self.look(part, effects, all);
        let best = least_squares(&look, &free, start, EFFORT, None)?;
        let count = best.values.len() - part.coordinates.len();
        let effects = with_values(effects, &best.values[..count]);
        let own = best.residual.norm_squared();
        let others: Option<Vec<f64>> =
            self.parts[1..].iter().map(|part| self.judged(part, &effects)).collect();
        Some(Fitted { held: others?.iter().sum(), effects, own })
    }

    /// Σ of squares of a run that no value is fitted to.
    fn judged(&self, part: &Part, effects: &[Setting]) -> Option<f64> {
        let look = |from: &[f64]| self.missed(part, effects, from);
        let free = vec![start(); part.coordinates.len()];
        let best = least_squares(&look, &free, part.coordinates.clone(), EFFORT, None)?;
        Some(best.residual.norm_squared())
    }
}

/// Steps and values of everything that a fit to a run chooses: values of effects, and where the machine is let go.
fn unknown(effects: &[Setting], part: &Part) -> (Vec<Free>, Vec<f64>) {
    let more = part.coordinates.iter().map(|_| start());
    let free = free(effects).into_iter().chain(more).collect();
    (free, [values(effects), part.coordinates.clone()].concat())
}

fn start() -> Free {
    Free { step: SMALL, bounds: [-f64::MAX, f64::MAX] }
}

/// What measuring sensors show, by frequency.
fn shown(sensors: &[Sensor], view: &View) -> Vec<Vec<f64>> {
    let measuring = (0..sensors.len()).filter(|&i| !sensors[i].tells());
    let signals: Vec<Signal> = measuring
        .filter_map(|i| {
            let series = view.plain(i)?;
            let values = view.rows().step_by(view.stride).map(|row| series[row]).collect();
            Some(Signal { values, band: PLAIN_BAND })
        })
        .collect();
    transform(&signals, view.interval * view.stride as f64)
}

/// A share of the difference of coefficients.
fn difference(a: &[Vec<f64>], b: &[Vec<f64>], share: f64) -> Vec<Vec<f64>> {
    let columns = a.iter().zip(b);
    columns.map(|(a, b)| a.iter().zip(b).map(|(a, b)| share * (a - b)).collect()).collect()
}
