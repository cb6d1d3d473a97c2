//! The whole way: from what is asked to a motion, and to how far apart it brings the models.

use super::asked::Question;
use super::instruments::{Ranked, missing, ranked, worth};
use super::motion::{Maker, Motion};
use super::path::Way;
use super::prepare::Prepared;
use super::search::{Effort, best};
use super::separation::{Apart, Posed, apart, detectable, named, nearest, shows, sized};
use super::sight::{Seen, Sight};
use crate::calibrate::result::CalibrateError;
use crate::calibrate::sensed::estimate::effort_sensor;
use crate::calibrate::sensed::recording::Recording;
use crate::calibrate::sensed::thresholds::SURE;
use crate::effects::Setting;
use rayon::prelude::*;

/// Motions of random numbers by which effects are looked for that the present motion does not show.
const RANDOM: usize = 8;

/// How many times its present detection limit a rival is large where nobody says: clearly there, and not so large that
/// anything tells it from anything.
const LARGE: f64 = 2.0;

/// Share of what a linearised rival leaves that its full fit may leave for the search to have been right about it.
const HELD: f64 = 0.7;

/// Shares of a planned motion's size at which drives are strong enough for it with clearances, one after another.
const GENTLER: [f64; 4] = [1.0, 0.9, 0.75, 0.5];

/// How far apart the models of a question are on one motion.
#[derive(Clone, Debug)]
pub struct Answer {
    /// Standard deviations.
    pub sigma: f64,
    /// Residuals that carry it, by name, with their shares of its square, the largest first.
    pub carried: Vec<(String, f64)>,
    /// Smallest size of an effect that would be named.
    pub smallest: Option<f64>,
}

/// A question and its answers.
#[derive(Clone, Debug)]
pub struct Answered {
    /// The question.
    pub posed: Posed,
    /// On the present motion, if there is one.
    pub before: Option<Answer>,
    /// On the planned one.
    pub after: Answer,
}

/// A planned motion.
#[derive(Debug)]
pub struct Outcome {
    /// The motion.
    pub motion: Motion,
    /// What the machine is recorded like along it.
    pub like: Recording,
    /// Noise along it.
    pub sight: Sight,
    /// Questions and answers.
    pub answers: Vec<Answered>,
    /// Further instruments, the best first.
    pub instruments: Vec<Ranked>,
    /// Largest force or torque of each drive along it, clearances included; none where nobody measures it.
    pub forces: Vec<Option<f64>>,
    /// Candidates that were tried.
    pub candidates: usize,
}

/// Searches the motion.
///
/// # Errors
/// Limits within which the machine can follow no motion, effects that no sensor can see, runs that break down.
pub fn plan(prepared: &Prepared, tell: &(dyn Fn(&str) + Sync)) -> Result<Outcome, CalibrateError> {
    let Prepared { described: rig, declared, control, interval, samples, seed, .. } = prepared;
    let way = Way {
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
    let mut posed = pose_all(prepared, reference, frozen, &random)?;
    let before: Option<Vec<Answer>> =
        present.as_ref().map(|sight| posed.iter().map(|posed| answered(sight, posed).1).collect());
    let mut candidates = 0;
    let mut chosen: Option<Chosen> = None;
    for round in 0..2 {
        // The second one refines what the first one found out about rivals.
        let all = prepared.effort;
        let effort =
            if round == 0 { all } else { Effort { generations: all.generations / 2, ..all } };
        let search = Search {
            effort,
            prepared,
            way: &way,
            maker: &maker,
            frozen,
            posed: &posed,
            before: candidates,
            tell,
        };
        let found = search.run(seed + round)?;
        candidates += effort.candidates();
        let better = chosen.as_ref().is_none_or(|chosen| found.worth > chosen.worth);
        let (linear, full) = (found.linear, found.worth);
        if better {
            chosen = Some(found);
        }
        // A rival that came nearer by other values is searched against with these.
        if full >= HELD * linear {
            break;
        }
        if let Some(chosen) = &chosen {
            posed.clone_from(&chosen.posed);
        }
    }
    let Some(Chosen { motion, like, sight, answers, forces, posed, .. }) = chosen else {
        return Err(no_motion(&maker, &way));
    };
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
    Ok(Outcome { answers, motion, like, sight, instruments, forces, candidates })
}

/// Some motions of random numbers that the machine can follow.
fn random(maker: &Maker, way: &Way, seed: u64) -> Vec<(Motion, Recording)> {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x9e37_79b9);
    let mut drawn = || (0..maker.numbers()).map(|_| StandardNormal.sample(&mut random)).collect();
    let numbers: Vec<Vec<f64>> = (0..RANDOM).map(|_| drawn()).collect();
    numbers.par_iter().filter_map(|numbers| way.largest(maker, numbers)).collect()
}

/// What to say where the machine can follow nothing.
fn no_motion(maker: &Maker, way: &Way) -> CalibrateError {
    // At rest, and in a small motion about home.
    let tried = [0.0, 0.1].map(|share| maker.motion(&vec![1.0; maker.numbers()], share));
    let blocked =
        tried.iter().find_map(|motion| way.follows(&way.like(motion), &maker.limits).err());
    let why = match blocked {
        Some(blocked) => blocked.words(&maker.limits),
        None => "none was found that the machine can follow".to_owned(),
    };
    let message = format!(
        "the limits leave no motion: {why}; give wider ones (--stroke, --speed, --acceleration, --drive-force, --gain)"
    );
    CalibrateError::Input(vec![message])
}

/// Questions with numbers. What the present motion does not show is looked for along random ones.
fn pose_all(
    prepared: &Prepared,
    reference: &Sight,
    frozen: &Sight,
    random: &[(Motion, Recording)],
) -> Result<Vec<Posed>, CalibrateError> {
    let seen = reference.own();
    let recorded = |(_, like): &(Motion, Recording)| {
        Seen::ideal(&prepared.described, like, prepared.control).ok()
    };
    let others: Vec<Seen> = random.par_iter().filter_map(recorded).collect();
    let mut wrong = Vec::new();
    let mut posed = Vec::new();
    for question in &prepared.questions {
        match pose(question, reference, &seen, frozen, &others) {
            Ok(one) => posed.push(one),
            Err(message) => wrong.push(message),
        }
    }
    crate::calibrate::result::refuse(wrong)?;
    Ok(posed)
}

/// The size at which an effect would be named, on the present motion or else on the random one that shows it best.
fn size_of(
    effect: &Setting,
    reference: (&Sight, &Seen),
    frozen: &Sight,
    others: &[Seen],
) -> Result<f64, String> {
    let present = detectable(reference.0, reference.1, effect);
    let elsewhere = || {
        let sizes = others.iter().filter_map(|seen| detectable(frozen, seen, effect));
        sizes.reduce(f64::min)
    };
    present.or_else(elsewhere).ok_or_else(|| {
        let columns: Vec<&str> = reference.0.declared().sensors.iter().map(|s| s.column.as_str()).collect();
        format!(
            "{effect}: no sensor of this rig can see it, on the present motion or any of {} others, at any size that \
             makes sense; the residuals of {} stay as they are. Another sensor would have to",
            others.len(),
            columns.join(", ")
        )
    })
}

fn pose(
    question: &Question,
    reference: &Sight,
    seen: &Seen,
    frozen: &Sight,
    others: &[Seen],
) -> Result<Posed, String> {
    match question {
        Question::Detect(effect, size) => {
            let found = size_of(effect, (reference, seen), frozen, others)?;
            let mut ways = sized(effect, size.unwrap_or(found));
            ways.retain(|way| {
                shows(reference, seen, way) || others.iter().any(|seen| shows(frozen, seen, way))
            });
            Ok(Posed::Detect { effect: effect.clone(), ways })
        }
        Question::Between(a, b) => {
            // An effect of a report comes with its values.
            let names: Vec<&'static str> = a.values().map(|(name, _)| name).collect();
            let neutral = Setting::neutral(a.kind, a.target.clone(), &names, reference.declared());
            let given = neutral.is_none_or(|neutral| *a != neutral);
            let large = |effect: &Setting| -> Result<Setting, String> {
                let size = LARGE * size_of(effect, (reference, seen), frozen, others)?;
                Ok(sized(effect, size).into_iter().next().unwrap_or_else(|| effect.clone()))
            };
            let by = |truth: &Setting, rival: &Setting| {
                let found = nearest(reference, seen, std::slice::from_ref(truth), rival);
                found
                    .map(|(rival, _)| rival)
                    .ok_or_else(|| format!("{rival}: no value of it makes a machine that moves so"))
            };
            let (first, second) = (if given { a.clone() } else { large(a)? }, large(b)?);
            let rival = by(&first, b)?;
            // What a report holds for as good is as large as it has to be.
            let back = if given {
                [rival.clone(), first.clone()]
            } else {
                [second.clone(), by(&second, a)?]
            };
            Ok(Posed::Between { rivals: [a.clone(), b.clone()], pairs: vec![[first, rival], back] })
        }
    }
}

/// How far apart the models of a question are on a motion, rivals fitted to each other with all their values, and the
/// question with the nearest values.
fn answered(sight: &Sight, posed: &Posed) -> (Posed, Answer) {
    let seen = sight.own();
    let carried = |apart: &Apart| {
        let names = sight.names.iter().map(|name| format!("{} of {}", name.kind.word(), name.of));
        let mut carried: Vec<(String, f64)> = names.zip(sight.shares(&apart.difference)).collect();
        carried.sort_by(|a, b| b.1.total_cmp(&a.1));
        carried
    };
    let nothing = || Answer { sigma: 0.0, carried: Vec::new(), smallest: None };
    match posed {
        Posed::Detect { effect, .. } => {
            let found = apart(sight, &seen, posed);
            let smallest = detectable(sight, &seen, effect);
            let answer = found.map(|apart| Answer {
                sigma: apart.sigma,
                carried: carried(&apart),
                smallest,
            });
            (posed.clone(), answer.unwrap_or_else(nothing))
        }
        Posed::Between { rivals, pairs } => {
            let fitted = |[truth, rival]: &[Setting; 2]| {
                let (rival, apart) = nearest(sight, &seen, std::slice::from_ref(truth), rival)?;
                Some(([truth.clone(), rival], apart))
            };
            let fits: Option<Vec<_>> = pairs.iter().map(fitted).collect();
            let Some(mut fits) = fits else { return (posed.clone(), nothing()) };
            fits.sort_by(|a, b| a.1.sigma.total_cmp(&b.1.sigma));
            let answer = fits.first().map(|(_, apart)| Answer {
                sigma: apart.sigma,
                carried: carried(apart),
                smallest: None,
            });
            let pairs = fits.into_iter().map(|(pair, _)| pair).collect();
            (Posed::Between { rivals: rivals.clone(), pairs }, answer.unwrap_or_else(nothing))
        }
    }
}

/// One search, and what it works with.
struct Search<'a> {
    prepared: &'a Prepared,
    way: &'a Way<'a>,
    maker: &'a Maker,
    frozen: &'a Sight,
    posed: &'a [Posed],
    effort: Effort,
    before: usize,
    tell: &'a (dyn Fn(&str) + Sync),
}

/// A motion that was chosen.
struct Chosen {
    motion: Motion,
    like: Recording,
    sight: Sight,
    answers: Vec<Answer>,
    posed: Vec<Posed>,
    forces: Vec<Option<f64>>,
    /// The least separation over what is wanted, with rivals fitted and noise of this motion; and as the search saw it.
    worth: f64,
    linear: f64,
}

impl Search<'_> {
    fn run(&self, seed: u64) -> Result<Chosen, CalibrateError> {
        let worth = |numbers: &[f64]| {
            let (_, like) = self.way.largest(self.maker, numbers)?;
            let seen = Seen::ideal(self.way.rig, &like, self.prepared.control).ok()?;
            self.worth(self.frozen, &seen)
        };
        let said = |tried: usize, worth: f64| {
            let all = self.before + self.effort.candidates();
            let tried = self.before + tried;
            (self.tell)(&format!(
                "{tried} of {all} motions; the best has {worth:.2} of what answers all questions"
            ));
        };
        let found = best(self.maker.numbers(), seed, self.effort, &worth, &said);
        (self.tell)("looking at the best motions with clearance and noise");
        let mut chosen: Option<Chosen> = None;
        for candidate in found {
            let Some(finished) = self.finished(&candidate.numbers)? else { continue };
            if chosen.as_ref().is_none_or(|chosen| finished.worth > chosen.worth) {
                chosen = Some(finished);
            }
        }
        chosen.ok_or_else(|| no_motion(self.maker, self.way))
    }

    fn worth(&self, sight: &Sight, seen: &Seen) -> Option<f64> {
        let sigma = self.posed.iter().map(|posed| Some(apart(sight, seen, posed)?.sigma));
        Some(worth(self.posed, &sigma.collect::<Option<Vec<f64>>>()?))
    }

    /// A candidate with clearances, noise of its own, and rivals fitted with all their values; so much smaller that its
    /// drives are strong enough. None where that cannot be.
    fn finished(&self, numbers: &[f64]) -> Result<Option<Chosen>, CalibrateError> {
        let Prepared { described: rig, control, seed, limits, .. } = self.prepared;
        let Some((largest, _)) = self.way.largest(self.maker, numbers) else { return Ok(None) };
        for share in GENTLER {
            let motion = self.maker.gentler(&largest, share);
            let like = self.way.like(&motion);
            if self.way.follows(&like, limits).is_err() {
                continue;
            }
            // What breaks down is no motion for this machine.
            let Ok(sight) = Sight::new(rig, &like, *control, *seed) else { continue };
            let forces = forces(&sight);
            let strong = forces.iter().zip(limits).all(|(force, limit)| {
                force.zip(limit.force).is_none_or(|(force, most)| force <= most)
            });
            if !strong {
                continue;
            }
            let linear = self.worth(&sight, &sight.own()).unwrap_or(0.0);
            let answers: Vec<(Posed, Answer)> =
                self.posed.iter().map(|posed| answered(&sight, posed)).collect();
            let (posed, answers): (Vec<Posed>, Vec<Answer>) = answers.into_iter().unzip();
            let sigma: Vec<f64> = answers.iter().map(|answer| answer.sigma).collect();
            let worth = worth(&posed, &sigma);
            return Ok(Some(Chosen { motion, like, sight, answers, posed, forces, worth, linear }));
        }
        Ok(None)
    }
}

/// Largest measured force or torque of each drive, noise aside.
fn forces(sight: &Sight) -> Vec<Option<f64>> {
    let machine = sight.declared();
    (0..machine.actuators.len())
        .map(|drive| {
            let column = sight.clean.get(effort_sensor(machine, drive)?)?;
            Some(column.iter().map(|force| force.abs()).fold(0.0, f64::max))
        })
        .collect()
}

/// Chance that an answer is right: of two rivals a likelihood ratio chooses the right one with `Φ(σ/2)`, and an effect of
/// this size is named with `Φ(σ − √gain)` (Kay 1998, section 4.3).
pub fn chance(posed: &Posed, sigma: f64) -> f64 {
    match posed {
        Posed::Between { .. } => normal(0.5 * sigma),
        Posed::Detect { .. } => normal(sigma - (named() - SURE)),
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
