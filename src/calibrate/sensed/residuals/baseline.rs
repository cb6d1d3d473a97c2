//! What a right model leaves of its own residuals: their mean, which is the look's own fault, and their spread,
//! which is noise.

use super::problem::{RigProblem, Segment, Start, Stopped};
use super::swing::{Likeliest, swing};
use crate::calibrate::sensed::motion::simulate::{misses_by, with_noise};
use crate::calibrate::sensed::motion::start::machine;
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::recorded::view::View;
use crate::calibrate::sensed::thresholds::{BY_FAR, DRAWS, NEARLY_SEEN, SEEN};
use crate::calibrate::values::draws::{Coefficients, difference, mean, without};
use crate::calibrate::values::spectrum::{Covariances, Noise};
use crate::effects::Setting;
use crate::mechanism::Mechanism;
use crate::scenario::Problem as Wrong;
use nalgebra::DVector;
use rayon::prelude::*;
use std::sync::Arc;

/// Bias and noise on one segment.
#[derive(Clone, Debug)]
pub(super) struct BiasAndNoise {
    pub segment: Segment,
    /// The model's machine, through which data and whole simulations are seen alike.
    pub machine: Mechanism,
    pub bias: Coefficients,
    /// Residuals of the data less that.
    pub left: Coefficients,
    pub noise: Noise,
    /// Simulations of the model without noise, replica by replica, and draws of the first one with noise.
    pub clean: Vec<View>,
    noisy: Vec<View>,
    /// Σ of squares of the noise of these draws, in units of what is expected.
    power: f64,
    /// What of the noise's logarithm of the determinant is not the sensors'.
    rattle: f64,
    /// What noise alone may look like in units of what other draws have of it, draw by draw.
    draws: Vec<DVector<f64>>,
    /// What the noise has more of, as a logarithm of its determinant, for a recorded swing that is not the
    /// model's.
    lost: f64,
}

/// What simulations of a model say of its own residuals.
#[derive(Clone, Debug)]
pub struct Baseline {
    pub(super) parts: Arc<Vec<BiasAndNoise>>,
    /// Whether replicas differ by more than sensors see.
    pub rattles: bool,
    /// Replicas that its draws are of: the i-th one of that many in turn.
    pub replicas: usize,
}

/// Draws that tell by how much a look at noise shrinks: the same ones before and after, so that two will do.
const SHRUNK: usize = 2;

/// Parts of the draws of a machine that does not rattle, each of which is held against the others: of sixteen the
/// twelve others know a covariance nearly as well as all.
const PARTS: usize = 4;

impl Baseline {
    /// That of a model with these effects; where it rattles, with what their standard `deviations` (none: the
    /// values are exact) and a hair at the start make of it.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn of(
        problem: &RigProblem,
        effects: &[Setting],
        deviations: &[f64],
        segments: &[Segment],
    ) -> Result<Self, Stopped> {
        let mut runs: Vec<usize> = segments.iter().map(|segment| segment.run).collect();
        runs.sort_unstable();
        runs.dedup();
        let starts = problem.starts(effects, &runs)?;
        let (simulated, rattles) = replicas(problem, effects, deviations, &starts)?;
        let still = problem.still(&starts)?;
        let parts = segments.iter().map(|segment| {
            let machine = machine(&problem.rig, effects, &problem.runs[segment.run].recording)?;
            let own = Own { problem, segment, machine };
            let place = runs.iter().position(|run| *run == segment.run).unwrap_or_default();
            own.part(&simulated[place], still[place].as_ref())
        });
        let parts = parts.collect::<Result<Vec<BiasAndNoise>, Stopped>>()?;
        let replicas = simulated.first().map_or(1, Vec::len);
        Ok(Self { parts: Arc::new(parts), rattles, replicas })
    }

    /// Residuals of the data under a model in units of noise, of all these segments in a row; none where the
    /// machine cannot move as it was measured.
    ///
    /// # Errors
    /// An effect that the machine cannot take.
    pub fn white(
        &self,
        problem: &RigProblem,
        effects: &[Setting],
        segments: &[Segment],
    ) -> Result<Option<DVector<f64>>, Wrong> {
        let mut all = Vec::new();
        for part in self.parts.iter().filter(|part| segments.contains(&part.segment)) {
            let run = &problem.runs[part.segment.run];
            let machine = machine(&problem.rig, effects, &run.recording)?;
            let seen = problem.coefficients(&run.view, &machine, &part.segment);
            let Some(seen) = seen else { return Ok(None) };
            all.extend(part.noise.whiten(&difference(&seen, &part.bias)).iter());
        }
        Ok(Some(DVector::from_vec(all)))
    }

    /// The same of a replica of the baseline's own model in place of the data; none where there is no such machine.
    pub fn white_of(
        &self,
        problem: &RigProblem,
        effects: &[Setting],
        segments: &[Segment],
        replica: usize,
    ) -> Option<DVector<f64>> {
        let mut all = Vec::new();
        for part in self.parts.iter().filter(|part| segments.contains(&part.segment)) {
            let recording = &problem.runs[part.segment.run].recording;
            let machine = machine(&problem.rig, effects, recording).ok()?;
            let seen = problem.coefficients(part.clean.get(replica)?, &machine, &part.segment)?;
            all.extend(part.noise.whiten(&difference(&seen, &part.bias)).iter());
        }
        Some(DVector::from_vec(all))
    }

    /// How much of the sum of squares of noise alone other effects than its own take away on segments: a softer servo
    /// makes less of its encoder's steps, and is not right for that; none where there is no such machine.
    pub fn shrunk(
        &self,
        problem: &RigProblem,
        effects: &[Setting],
        segments: &[Segment],
    ) -> Option<f64> {
        let mut sum = 0.0;
        for part in self.parts.iter().filter(|part| segments.contains(&part.segment)) {
            let recording = &problem.runs[part.segment.run].recording;
            let other = machine(&problem.rig, effects, recording).ok()?;
            let look = |view: &View| problem.coefficients(view, &other, &part.segment);
            let clean = look(&part.clean[0])?;
            let own = |noisy: &View| {
                let noise = difference(&look(noisy)?, &clean);
                Some(part.noise.whiten(&noise).norm_squared())
            };
            let power: f64 = part.noisy.iter().map(own).sum::<Option<f64>>()?;
            sum += (part.power - power) / SHRUNK as f64;
        }
        Some(sum)
    }

    /// The same with what a simulation of that very model says of it in place of the bias; both are seen through the
    /// baseline's own model.
    ///
    /// # Errors
    /// An effect that the machine cannot take, a run that broke down.
    pub fn simulated_white(
        &self,
        problem: &RigProblem,
        effects: &[Setting],
        segments: &[Segment],
    ) -> Result<Option<DVector<f64>>, Stopped> {
        let mut all = Vec::new();
        let sensors = problem.declared.sensors.len();
        for part in self.parts.iter().filter(|part| segments.contains(&part.segment)) {
            let simulated = problem.look(effects, part.segment.run, part.segment.rows.end)?;
            let view = View::new(&simulated, sensors);
            let own = problem.coefficients(&view, &part.machine, &part.segment);
            let Some(own) = own else { return Ok(None) };
            let left = difference(&part.left, &difference(&own, &part.bias));
            all.extend(part.noise.whiten(&left).iter());
        }
        Ok(Some(DVector::from_vec(all)))
    }

    /// Coefficients of residuals on one of its segments in units of noise.
    pub fn whiten(&self, segment: &Segment, coefficients: &[Vec<f64>]) -> Option<DVector<f64>> {
        let part = self.parts.iter().find(|part| part.segment == *segment)?;
        Some(part.noise.whiten(coefficients))
    }

    /// What noise alone may be like on segments: as [`white`](Self::white) would see it, draw by draw.
    pub fn draws(&self, segments: &[Segment]) -> Vec<DVector<f64>> {
        let parts = || self.parts.iter().filter(|part| segments.contains(&part.segment));
        let of = |draw: usize| parts().flat_map(move |part| part.draws[draw].iter().copied());
        (0..DRAWS).map(|draw| DVector::from_vec(of(draw).collect())).collect()
    }

    /// What a model pays on segments for having lost the recorded swing: its noise is larger.
    pub fn lost(&self, segments: &[Segment]) -> f64 {
        let parts = self.parts.iter().filter(|part| segments.contains(&part.segment));
        parts.map(|part| part.lost).sum()
    }

    /// Whether a recording swings otherwise than the model.
    pub fn has_lost_the_swing(&self) -> bool {
        self.parts.iter().any(|part| part.lost > 0.0)
    }

    /// Logarithm of the determinant of the noise on segments, less that of the sensors' noise seen through the same model:
    /// what a model pays for rattling. (What changes the look at noise changes both.)
    pub fn log_determinant(&self, segments: &[Segment]) -> f64 {
        let parts = self.parts.iter().filter(|part| segments.contains(&part.segment));
        parts.map(|part| part.rattle).sum()
    }

    /// Residual (by its place among the names) and frequency in Hz of each number of [`white`](Self::white).
    pub fn places(&self, problem: &RigProblem, segments: &[Segment]) -> Vec<(usize, f64)> {
        let parts = self.parts.iter().filter(|part| segments.contains(&part.segment));
        parts
            .flat_map(|part| {
                let interval = problem.runs[part.segment.run].view.interval;
                let step = 0.5 / (part.segment.rows.len() as f64 * interval);
                part.noise.places().into_iter().map(move |(c, k)| (c, k as f64 * step))
            })
            .collect()
    }
}

/// A model on one segment.
struct Own<'a> {
    problem: &'a RigProblem,
    segment: &'a Segment,
    machine: Mechanism,
}

impl Own<'_> {
    fn view(&self, recording: &Recording) -> View {
        View::new(recording, self.problem.declared.sensors.len())
    }

    /// Coefficients of residuals; none where the machine cannot move as it was measured.
    fn seen(&self, view: &View) -> Option<Coefficients> {
        self.problem.coefficients(view, &self.machine, self.segment)
    }

    fn singular(&self) -> Stopped {
        let message = "makes a machine that cannot move as it was measured".to_owned();
        Stopped::Model(self.problem.rig.problem("effect", message, "other values"))
    }

    /// Bias and noise, by simulations without noise, replica by replica, and one without a swing.
    fn part(self, clean: &[Recording], still: Option<&Recording>) -> Result<BiasAndNoise, Stopped> {
        let look = |recording: &Recording| self.seen(&self.view(recording));
        let singular = || self.singular();
        let views: Vec<View> = clean.par_iter().map(|recording| self.view(recording)).collect();
        let seen = views.par_iter().map(|view| self.seen(view));
        let seen: Vec<Coefficients> = seen.collect::<Option<_>>().ok_or_else(singular)?;
        let bias = mean(&seen);
        let sensors = &self.problem.declared.sensors;
        let noisy =
            |draw: usize| with_noise(&clean[draw % clean.len()], sensors, draw as u64 + 1000);
        let looked: Vec<Coefficients> = (0..DRAWS)
            .into_par_iter()
            .map(|draw| look(&noisy(draw)))
            .collect::<Option<_>>()
            .ok_or_else(singular)?;
        let beside = |of: &dyn Fn(usize) -> Coefficients| -> Vec<Coefficients> {
            let own = looked.iter().enumerate();
            own.map(|(draw, noisy)| difference(noisy, &of(draw % seen.len()))).collect()
        };
        // A replica stands for the data, the mean of the others for the bias.
        let draws = beside(&|own| without(&bias, &seen[own], seen.len()));
        let still = still.map(look).unwrap_or(None);
        let swing = swing(&bias, still.as_ref());
        let run = &self.problem.runs[self.segment.run];
        let left = difference(&self.seen(&run.view).ok_or_else(singular)?, &bias);
        let Likeliest { share, noise, lost } = Likeliest::of(&draws, &left, &swing);
        let of_sensors =
            Covariances::from_draws(&beside(&|own| seen[own].clone()), &swing).noise(0.0);
        let rattle = noise.log_determinant() - of_sensors.log_determinant();
        let draws = by_the_others(&draws, clean.len(), &swing, share);
        // Those of the first replica.
        let kept = || (0..SHRUNK).map(|k| k * clean.len());
        let power = kept().map(|draw| difference(&looked[draw], &seen[0]));
        let power = power.map(|own| noise.whiten(&own).norm_squared()).sum();
        let noisy = kept().map(|draw| self.view(&noisy(draw))).collect();
        let segment = self.segment.clone();
        let machine = self.machine;
        Ok(BiasAndNoise {
            segment,
            machine,
            bias,
            left,
            noise,
            clean: views,
            noisy,
            power,
            rattle,
            draws,
            lost,
        })
    }
}

/// Noiseless recordings of a model, run by run, and whether they rattle. Of a machine that does as declared a model need
/// not: what presses its journals on their rings makes it as predictable as any, and one simulation stands for it. Two that
/// are nearly as far apart as sensors see may be so near each other by chance: then all replicas are asked, unless these two
/// [miss](misses_by_far) what was recorded by so much that others could not say otherwise.
fn replicas(
    problem: &RigProblem,
    effects: &[Setting],
    deviations: &[f64],
    starts: &[Start],
) -> Result<(Vec<Vec<Recording>>, bool), Stopped> {
    let two = problem.replicas.min(2);
    let mut simulated = problem.simulated(starts, two)?;
    let gap = problem.apart(&simulated);
    let afar = gap > NEARLY_SEEN && misses_by_far(problem, starts, &simulated);
    let needed = if afar { two } else { problem.replicas };
    let with_others = |mut own: Vec<Vec<Recording>>, kept: usize, deviations: &[f64]| {
        own.iter_mut().for_each(|logs| logs.truncate(kept));
        let others = problem.simulated_about(effects, deviations, starts, kept..needed)?;
        own.iter_mut().zip(others).for_each(|(logs, others)| logs.extend(others));
        Ok::<_, Stopped>(own)
    };
    let about = gap > SEEN && !deviations.is_empty();
    if gap > NEARLY_SEEN && !about && !afar {
        simulated = with_others(simulated, two, &[])?;
    }
    let rattles = problem.apart(&simulated) > SEEN;
    match rattles {
        true if deviations.is_empty() => {}
        true => simulated = with_others(simulated, 1, deviations)?,
        false => simulated.iter_mut().for_each(|logs| logs.truncate(1)),
    }
    Ok((simulated, rattles))
}

/// Whether a run is missed by [far](BY_FAR) more than noise and these replicas' scatter explain. What nothing holds may fall alike twice,
/// and otherwise in the recording.
fn misses_by_far(problem: &RigProblem, starts: &[Start], simulated: &[Vec<Recording>]) -> bool {
    let held = starts.iter().all(|start| !start.is_fitted());
    held && starts.iter().zip(simulated).any(|(start, clean)| {
        let recording = &problem.runs[start.run].recording;
        misses_by(&problem.declared.sensors, recording, [&clean[0], &clean[1]]) > BY_FAR
    })
}

/// Draws of noise of so many replicas in units of what the others have of it, as a recording is seen: replicas that a
/// covariance was taken from look more like noise than one that it never saw.
fn by_the_others(
    draws: &[Coefficients],
    replicas: usize,
    swing: &[Vec<f64>],
    share: f64,
) -> Vec<DVector<f64>> {
    // Those of one replica have its rattle in common.
    let parts = if replicas > 1 { replicas } else { PARTS };
    let noises: Vec<Noise> = (0..parts)
        .into_par_iter()
        .map(|part| {
            let others = draws.iter().enumerate().filter(|(draw, _)| draw % parts != part);
            let others: Vec<Coefficients> = others.map(|(_, draw)| draw.clone()).collect();
            Covariances::from_draws(&others, swing).noise(share)
        })
        .collect();
    draws.iter().enumerate().map(|(draw, own)| noises[draw % parts].whiten(own)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::sensed::thresholds::REPLICAS;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// A softer servo makes less of its encoder's steps, and a model as it is nothing else of its noise.
    #[test]
    fn a_softer_servo_shrinks_noise() {
        use crate::effects::{Target, named};
        let problem = RigProblem::planar("planar-2");
        let segments = problem.split().hold;
        let baseline = Baseline::of(&problem, &[], &[], &segments).unwrap();
        let shrunk = |relative: f64| {
            let drive = problem.declared.actuators[0].name.clone();
            let target = Target::Joints(vec![drive]);
            let gain = Setting::on(
                named("servo-gain").unwrap(),
                target,
                &[("stiffness_relative", relative), ("damping_relative", relative)],
            );
            baseline.shrunk(&problem, &[gain], &segments).unwrap()
        };
        assert!(shrunk(0.0).abs() < 1e-6, "{}", shrunk(0.0));
        assert!(shrunk(-0.3) > 1.0, "{}", shrunk(-0.3));
        assert!(shrunk(0.3) < -1.0, "{}", shrunk(0.3));
    }

    /// A machine that rattles as its model does is held against all replicas, and one that does not lag by 10 ms as that does against two.
    #[test]
    fn what_misses_by_far_needs_few_replicas() {
        use crate::effects::named;
        let rig = RigProblem::of("rigs/rig-1", "run-a.csv");
        let recorded = rig.simulated(&rig.let_go(&[]).unwrap(), 1).unwrap().remove(0).remove(0);
        let mut problem = rig.recorded_as(recorded);
        problem.replicas = REPLICAS;
        let segments = problem.split().hold;
        let lag = Setting::new(named("servo-lag").unwrap(), None, &[("time_constant_s", 0.01)]);
        let of = |effects: &[Setting]| Baseline::of(&problem, effects, &[], &segments).unwrap();
        assert_eq!([of(&[]).replicas, of(&[lag]).replicas], [REPLICAS, 2]);
    }

    /// One replica of four that rattles three times as much as the others stands out as far as a recording that does so
    /// would, although its own draws are among those that noise is taken from.
    #[test]
    fn a_restless_replica_does_not_excuse_itself() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut draw = |number: usize| -> Coefficients {
            let size = if number.is_multiple_of(4) { 3.0 } else { 1.0 };
            vec![
                (0..200)
                    .map(|_| size * Distribution::<f64>::sample(&StandardNormal, &mut random))
                    .collect(),
            ]
        };
        let draws: Vec<Coefficients> = (0..DRAWS).map(&mut draw).collect();
        let still = vec![vec![0.0; 200]];
        let mean_square = |white: &DVector<f64>| white.norm_squared() / white.len() as f64;
        let by_all = mean_square(&Noise::from_draws(&draws, &still).whiten(&draws[0]));
        let by_others = mean_square(&by_the_others(&draws, 4, &still, 1.0)[0]);
        assert!((2.5..3.5).contains(&by_all), "{by_all}");
        assert!((7.0..11.0).contains(&by_others), "{by_others}");
    }
}
