//! How good a model of a drive stage is on stretches that it was not fitted to, by its inverse model and
//! in the simulated closed loop.

use super::candidates::{Candidate, kind_of};
use crate::calibrate::result::CalibrateError;
use crate::calibrate::sensed::held::paired::Ratio;
use crate::identify::Missing;
use crate::identify::inverse::{Model, Term};
use crate::identify::stage::{Recording, halves, simulated_force, stage};
use crate::mechanism::Mechanism;
use std::ops::Range;

/// Stretches in s over which errors are compared: longer than what is left remembers, a tenth of a
/// second at most, with some to spare.
pub(super) const BLOCK: f64 = 1.0;

/// Half widths of a 95 % interval that a candidate has to be better by: three standard errors, since a
/// dozen are tried in each round.
pub(super) const CERTAIN: f64 = 1.5;

/// Share by which a candidate has to be better besides: what is certain and less than this is not worth
/// a parameter.
pub(super) const WORTH: f64 = 0.01;

/// Whether a fitted model means anything: nothing gives back what it should take.
fn physical(model: &Model) -> bool {
    let free = |term: &Term| matches!(term, Term::Offset | Term::Ripple(..));
    model.terms.iter().all(|(term, factor)| free(term) || *factor >= 0.0)
}

/// Recordings ready for the regression, and what of them is for judging.
pub(super) struct Judge {
    pub data: Recording,
    pub held: Vec<Recording>,
}

impl Judge {
    /// A model with these terms, fitted to rows of the data; `None` where it means nothing.
    pub fn fit(&self, rows: Range<usize>, terms: &[Term]) -> Option<Model> {
        Model::fit(&self.data.motion, rows, terms, &[]).filter(physical)
    }

    /// What a model with these terms leaves on stretches that it was not fitted to, N; `None` where it
    /// means nothing.
    pub fn left(&self, terms: &[Term]) -> Option<Vec<f64>> {
        let motion = &self.data.motion;
        if self.held.is_empty() {
            let rows = motion.rows();
            let [first, second] = halves(&rows);
            let [by_first, by_second] = [&first, &second].map(|rows| self.fit(rows.clone(), terms));
            let (by_first, by_second) = (by_first?, by_second?);
            let within = |rows: &Range<usize>| -> Vec<Range<usize>> {
                let inside = |b: &Range<usize>| b.start >= rows.start && b.end <= rows.end;
                motion.blocks(BLOCK).into_iter().filter(inside).collect()
            };
            let on_first = by_second.left(motion, &within(&first));
            return Some([on_first, by_first.left(motion, &within(&second))].concat());
        }
        let model = self.fit(motion.rows(), terms)?;
        let each = self.held.iter().map(|r| model.left(&r.motion, &r.motion.blocks(BLOCK)));
        Some(each.collect::<Vec<_>>().concat())
    }
}

impl Judge {
    /// What closed loops miss of the force in N, stretch by stretch, on runs that were not fitted to (on
    /// the data where there are no others).
    pub fn simulated(
        &self,
        build: impl Fn(&Recording) -> Result<Mechanism, Missing>,
    ) -> Result<Vec<f64>, CalibrateError> {
        let runs =
            if self.held.is_empty() { std::slice::from_ref(&self.data) } else { &self.held[..] };
        let mut left = Vec::new();
        for run in runs {
            let force = simulated_force(&build(run)?, run)?;
            left.extend(run.motion.missed(&force, &run.motion.blocks(BLOCK)));
        }
        Ok(left)
    }

    /// Takes out, latest first, the kinds of effects without which the simulated closed loop is neither
    /// certainly worse stretch by stretch nor worse as a whole: the regression knows the sign of the speed,
    /// the simulation what the machine does around it. Those of the declared terms stay. Returns the kinds that went.
    pub fn drop_idle(
        &self,
        terms: &mut Vec<Term>,
        declared: &[Term],
    ) -> Result<Vec<&'static str>, CalibrateError> {
        let mut dropped = Vec::new();
        let ours = |term: &Term| kind_of(term).filter(|_| !declared.contains(term));
        let mut kinds: Vec<&'static str> = Vec::new();
        for kind in terms.iter().rev().filter_map(ours) {
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        for kind in kinds {
            let without: Vec<Term> =
                terms.iter().filter(|term| ours(term) != Some(kind)).copied().collect();
            let rows = self.data.motion.rows();
            let (Some(with), Some(less)) =
                (self.fit(rows.clone(), terms), self.fit(rows, &without))
            else {
                continue;
            };
            let with = self.simulated(|run| stage(&with, run))?;
            let less = self.simulated(|run| stage(&less, run))?;
            let ratio = Ratio::of(&less, &with);
            let idle = ratio.ci95[0] <= 1.0 || ratio.mean < 1.0 + WORTH;
            // Over all stretches together, too: one that is at rest counts as much as a stroke above.
            if idle && squares(&less) < squares(&with) * (1.0 + WORTH).powi(2) {
                *terms = without;
                dropped.push(kind);
            }
        }
        Ok(dropped)
    }
}

/// Sum of squares.
pub(super) fn squares(left: &[f64]) -> f64 {
    left.iter().map(|x| x * x).sum()
}

/// Of candidates of one form that differ in a number only (a speed, a pitch), the one that fits the data
/// best: numbers are fitted there, and only forms compete elsewhere.
pub(super) fn by_form(judge: &Judge, candidates: Vec<Candidate>) -> Vec<Candidate> {
    let motion = &judge.data.motion;
    let mut best: Vec<(f64, Candidate)> = Vec::new();
    for candidate in candidates {
        let Some(model) = judge.fit(motion.rows(), &candidate.terms) else { continue };
        let error = model.error(motion, motion.rows());
        let scanned = ["film-friction", "stribeck-friction", "screw-ripple"];
        let rival = best
            .iter_mut()
            .find(|(_, other)| other.kind == candidate.kind && scanned.contains(&candidate.kind));
        match rival {
            Some(rival) if error < rival.0 => *rival = (error, candidate),
            Some(_) => {}
            None => best.push((error, candidate)),
        }
    }
    best.into_iter().map(|(_, candidate)| candidate).collect()
}
