//! From questions with numbers to the motion that answers them best: searches without clearance, then the best
//! candidates with clearance, noise of their own and rivals fitted.

use super::motions::limits::measured;
use super::motions::motion::{DrivesMotion, Maker};
use super::motions::path::TriedMachine;
use super::motions::search::{SearchEffort, best};
use super::prepare::PreparedPlan;
use super::questions::answer::{MotionAnswer, answered};
use super::questions::instruments::worth;
use super::questions::separation::{PosedQuestion, apart};
use super::questions::sight::{Seen, Sight};
use crate::calibrate::results::result::CalibrateError;
use crate::calibrate::sensed::recording::Recording;

/// Share of what a linearised rival leaves that its full fit may leave for the search to have been right about it.
const HELD: f64 = 0.7;

/// Shares of a planned motion's size at which drives are strong enough for it with clearances, one after another.
const GENTLER: [f64; 4] = [1.0, 0.9, 0.75, 0.5];

/// Searches the motion that tells most, once more where rivals turn out nearer; with how many candidates were tried.
pub fn search_twice(
    ground: &SearchGround,
    mut posed: Vec<PosedQuestion>,
) -> Result<(Chosen, usize), CalibrateError> {
    let PreparedPlan { effort: all, seed, .. } = ground.prepared;
    let mut candidates = 0;
    let mut chosen: Option<Chosen> = None;
    for round in 0..2 {
        // The second one refines what the first one found out about rivals.
        let effort = if round == 0 {
            *all
        } else {
            SearchEffort { generations: all.generations / 2, ..*all }
        };
        let search = MotionSearch { ground, posed: &posed, effort, before: candidates };
        let found = search.run(seed + round)?;
        candidates += effort.candidates();
        let Some(found) = found else { break };
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
    let chosen = chosen.ok_or_else(|| no_motion(ground.maker, ground.way))?;
    Ok((chosen, candidates))
}

/// What to say where the machine can follow nothing.
pub fn no_motion(maker: &Maker, way: &TriedMachine) -> CalibrateError {
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

/// What all searches work with.
pub struct SearchGround<'a> {
    pub prepared: &'a PreparedPlan,
    pub way: &'a TriedMachine<'a>,
    pub maker: &'a Maker,
    /// Noise that stays as it is while motions are searched.
    pub frozen: &'a Sight,
    pub tell: &'a (dyn Fn(&str) + Sync),
}

/// One search.
struct MotionSearch<'a> {
    ground: &'a SearchGround<'a>,
    posed: &'a [PosedQuestion],
    effort: SearchEffort,
    /// Candidates of searches before it.
    before: usize,
}

/// A motion that was chosen.
pub struct Chosen {
    pub motion: DrivesMotion,
    pub like: Recording,
    pub sight: Sight,
    pub answers: Vec<MotionAnswer>,
    pub posed: Vec<PosedQuestion>,
    pub forces: Vec<Option<f64>>,
    /// The least separation over what is wanted, with rivals fitted and noise of this motion; and as the search saw it.
    worth: f64,
    linear: f64,
}

impl MotionSearch<'_> {
    /// The best motion; none where the machine can follow none that was tried.
    fn run(&self, seed: u64) -> Result<Option<Chosen>, CalibrateError> {
        let worth = |numbers: &[f64]| {
            let (_, like) = self.ground.way.largest(self.ground.maker, numbers)?;
            let seen =
                Seen::ideal(self.ground.way.rig, &like, self.ground.prepared.control).ok()?;
            self.worth(self.ground.frozen, &seen)
        };
        let said = |tried: usize, worth: f64| {
            let all = self.before + self.effort.candidates();
            let tried = self.before + tried;
            (self.ground.tell)(&format!(
                "{tried} of {all} motions; the best has {worth:.2} of what answers all questions"
            ));
        };
        let found = best(self.ground.maker.numbers(), seed, self.effort, &worth, &said);
        (self.ground.tell)("looking at the best motions with clearance and noise");
        let mut chosen: Option<Chosen> = None;
        // The present motion as well, in the first search: a planned one is never worse.
        let present = self.ground.maker.present().filter(|_| self.before == 0).into_iter();
        let largest = |numbers: &[f64]| self.ground.way.largest(self.ground.maker, numbers);
        let found = found.iter().filter_map(|candidate| largest(&candidate.numbers));
        for motion in present.chain(found.map(|(motion, _)| motion)) {
            let Some(finished) = self.finished(&motion)? else { continue };
            if chosen.as_ref().is_none_or(|chosen| finished.worth > chosen.worth) {
                chosen = Some(finished);
            }
        }
        Ok(chosen)
    }

    fn worth(&self, sight: &Sight, seen: &Seen) -> Option<f64> {
        let sigma = self.posed.iter().map(|posed| Some(apart(sight, seen, posed)?.sigma));
        Some(worth(self.posed, &sigma.collect::<Option<Vec<f64>>>()?))
    }

    /// A candidate with clearances, noise of its own, and rivals fitted with all their values; so much smaller that its
    /// drives are strong enough. None where that cannot be.
    fn finished(&self, largest: &DrivesMotion) -> Result<Option<Chosen>, CalibrateError> {
        let PreparedPlan { described: rig, control, seed, limits, present, .. } =
            self.ground.prepared;
        for share in GENTLER {
            let motion = self.ground.maker.gentler(largest, share);
            let like = self.ground.way.like(&motion);
            if self.ground.way.follows(&like, limits).is_err() {
                continue;
            }
            // What breaks down is no motion for this machine.
            let Ok(sight) = Sight::new(rig, &like, *control, *seed) else { continue };
            let machine = sight.declared();
            // Of the present motion it is measured what it takes; peaks of a simulation are another draw.
            let recorded = present.as_ref().filter(|_| motion.is_present());
            let force = |drive: usize| {
                let recorded = recorded.and_then(|recording| measured(machine, drive, recording));
                recorded.or_else(|| measured(machine, drive, &sight.clean))
            };
            let forces: Vec<Option<f64>> = (0..machine.actuators.len()).map(force).collect();
            let strong = forces.iter().zip(limits).all(|(force, limit)| {
                force.zip(limit.force).is_none_or(|(force, most)| force <= most)
            });
            if !strong {
                continue;
            }
            let linear = self.worth(&sight, &sight.own()).unwrap_or(0.0);
            let answers: Vec<(PosedQuestion, MotionAnswer)> =
                self.posed.iter().map(|posed| answered(&sight, posed)).collect();
            let (posed, answers): (Vec<PosedQuestion>, Vec<MotionAnswer>) =
                answers.into_iter().unzip();
            let sigma: Vec<f64> = answers.iter().map(|answer| answer.sigma).collect();
            let worth = worth(&posed, &sigma);
            return Ok(Some(Chosen { motion, like, sight, answers, posed, forces, worth, linear }));
        }
        Ok(None)
    }
}
