//! The whole way: from what is asked to a motion, and to how far apart it brings the models.

use super::chosen::{Chosen, SearchGround, no_motion, search_twice};
use super::motions::motion::{DrivesMotion, Maker};
use super::motions::path::TriedMachine;
use super::motions::present::present;
use super::posing::pose_all;
use super::prepare::PreparedPlan;
use super::questions::answer::{MotionAnswer, answered};
use super::questions::instruments::{RankedInstrument, missing, ranked};
use super::questions::separation::{PosedQuestion, named};
use super::questions::sight::Sight;
use crate::calibrate::results::result::CalibrateError;
use crate::calibrate::sensed::recording::Recording;
use crate::calibrate::sensed::thresholds::SURE;
use rayon::prelude::*;

/// Motions of random numbers by which effects are looked for that the present motion does not show.
const RANDOM: usize = 8;

/// A question and its answers.
#[derive(Clone, Debug)]
pub struct Answered {
    /// The question.
    pub posed: PosedQuestion,
    /// On the present motion, if there is one.
    pub before: Option<MotionAnswer>,
    /// On the planned one.
    pub after: MotionAnswer,
}

/// A planned motion.
#[derive(Debug)]
pub struct PlanOutcome {
    /// The motion.
    pub motion: DrivesMotion,
    /// What the machine is recorded like along it.
    pub like: Recording,
    /// Noise along it.
    pub sight: Sight,
    /// Questions and answers.
    pub answers: Vec<Answered>,
    /// Further instruments, the best first.
    pub instruments: Vec<RankedInstrument>,
    /// Largest force or torque of each drive along it, clearances included, of the present motion as recorded; none where
    /// nobody measures it.
    pub forces: Vec<Option<f64>>,
    /// Candidates that were tried.
    pub candidates: usize,
}

/// Searches the motion.
///
/// # Errors
/// Limits within which the machine can follow no motion, effects that no sensor can see, runs that break down.
pub fn plan(
    prepared: &PreparedPlan,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<PlanOutcome, CalibrateError> {
    let PreparedPlan { described: rig, declared, control, interval, samples, seed, .. } = prepared;
    let way = TriedMachine {
        rig,
        declared,
        gain: prepared.gain,
        sign: prepared.sign,
        interval: *interval,
        samples: *samples,
    };
    let maker = Maker {
        period: (*samples - 1) as f64 * interval,
        limits: prepared.limits.clone(),
        home: prepared.home.clone(),
        present: prepared
            .present
            .as_ref()
            .and_then(|like| present(declared, like, &prepared.limits, *samples)),
    };
    tell("looking for motions that the machine can follow");
    let random = random(&maker, &way, *seed);
    let Some((_, first)) = random.first() else { return Err(no_motion(&maker, &way)) };
    tell("recording the present motion");
    let present = match &prepared.present {
        Some(like) => Some(Sight::new(rig, like, *control, *seed)?),
        None => None,
    };
    // Noise is frozen while motions are searched: along the present motion, or a random one where that is as long.
    let same = present.as_ref().filter(|sight| sight.clean.samples == *samples);
    let own;
    let frozen = match same {
        Some(sight) => sight,
        None => {
            own = Sight::new(rig, first, *control, *seed)?;
            &own
        }
    };
    tell("posing the questions");
    let reference = present.as_ref().unwrap_or(frozen);
    let posed = pose_all(prepared, reference, frozen, &random)?;
    let before: Option<Vec<MotionAnswer>> =
        present.as_ref().map(|sight| posed.iter().map(|posed| answered(sight, posed).1).collect());
    let ground = SearchGround { prepared, way: &way, maker: &maker, frozen, tell };
    let (chosen, candidates) = search_twice(&ground, posed)?;
    let Chosen { motion, like, sight, answers, forces, posed, .. } = chosen;
    tell("trying one more sensor");
    let with = |machine: &crate::mechanism::Mechanism| {
        motion.like(machine, "planned", *interval, *samples)
    };
    let instruments = missing(rig, declared);
    let instruments = ranked(rig, instruments, &posed, *control, *seed, &with);
    let mut before = before.map(Vec::into_iter);
    let answers = posed.into_iter().zip(answers).map(|(posed, after)| {
        let before = before.as_mut().and_then(Iterator::next);
        Answered { posed, before, after }
    });
    let answers = answers.collect();
    Ok(PlanOutcome { answers, motion, like, sight, instruments, forces, candidates })
}

/// Some motions of random numbers that the machine can follow.
fn random(maker: &Maker, way: &TriedMachine, seed: u64) -> Vec<(DrivesMotion, Recording)> {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x9e37_79b9);
    let mut drawn = || (0..maker.numbers()).map(|_| StandardNormal.sample(&mut random)).collect();
    let numbers: Vec<Vec<f64>> = (0..RANDOM).map(|_| drawn()).collect();
    numbers.par_iter().filter_map(|numbers| way.largest(maker, numbers)).collect()
}

/// Chance that an answer is right: of two rivals a likelihood ratio chooses the right one with `Φ(σ/2)`, and an effect of
/// this size is named with `Φ(σ − √gain)` (Kay 1998, section 4.3).
pub fn chance(posed: &PosedQuestion, sigma: f64) -> f64 {
    match posed {
        PosedQuestion::Between { .. } => normal(0.5 * sigma),
        PosedQuestion::Detect { .. } => normal(sigma - (named() - SURE)),
    }
}

/// Share of a standard normal variable's values below `x`, to 1e-7: M. Abramowitz, I. A. Stegun, *Handbook of
/// Mathematical Functions* (1964), 26.2.17.
fn normal(x: f64) -> f64 {
    const B: [f64; 5] =
        [0.319_381_530, -0.356_563_782, 1.781_477_937, -1.821_255_978, 1.330_274_429];
    let t = 1.0 / (1.0 + 0.231_641_9 * x.abs());
    let series = B.iter().rev().fold(0.0, |sum, b| t * (b + sum));
    let above = (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt() * series;
    if x < 0.0 { above } else { 1.0 - above }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_a_normal_variable() {
        for (x, share) in [(0.0, 0.5), (1.0, 0.841_344_75), (-1.959_964, 0.025), (3.0, 0.998_650_1)]
        {
            assert!((normal(x) - share).abs() < 2e-7, "{x}: {}", normal(x));
        }
    }
}
