//! How good a model of a held machine is on stretches that it was not fitted to, by its inverse model and as controllers
//! hold it in a simulation.

use super::bench::{Broken, HeldBench};
use super::candidates::Candidate;
use super::model::{HeldModel, squares};
use super::paired::Ratio;
use super::terms::HeldTerm;
use crate::calibrate::sensed::thresholds::{STRETCH, WORTH};
use crate::effects::Setting;
use std::ops::Range;

/// What is fitted to, and what is judged on: the first run and the others, or the halves of one.
#[derive(Clone, Copy, Debug)]
pub struct Judge<'a> {
    /// The machine and its recordings.
    pub bench: &'a HeldBench,
}

/// Root mean square over each of some stretches.
fn sizes(left: &[f64], stretches: &[Range<usize>]) -> Vec<f64> {
    let size =
        |rows: &Range<usize>| (squares(&left[rows.clone()]) / rows.len().max(1) as f64).sqrt();
    stretches.iter().map(size).collect()
}

impl Judge<'_> {
    /// A model with these terms, fitted to rows of the first run; none where it means nothing.
    pub fn fit(&self, rows: Range<usize>, terms: &[HeldTerm]) -> Option<HeldModel> {
        HeldModel::fit(self.bench, 0, rows, terms, &[]).filter(HeldModel::is_physical)
    }

    /// The same of the whole run.
    pub fn fitted(&self, terms: &[HeldTerm]) -> Option<HeldModel> {
        self.fit(self.bench.rows(0), terms)
    }

    /// What a model with these terms leaves on stretches that it was not fitted to; none where it means nothing.
    pub fn left(&self, terms: &[HeldTerm]) -> Option<Vec<f64>> {
        let bench = self.bench;
        if bench.runs.len() > 1 {
            let model = self.fitted(terms)?;
            let of = |run| sizes(&model.left(bench, run), &bench.stretches(run, STRETCH));
            return Some((1..bench.runs.len()).flat_map(of).collect());
        }
        let halves = bench.halves(0);
        let models = [self.fit(halves[0].clone(), terms)?, self.fit(halves[1].clone(), terms)?];
        let other = |(rows, model): (&Range<usize>, &HeldModel)| {
            let inside = |b: &Range<usize>| b.start >= rows.start && b.end <= rows.end;
            let stretches: Vec<_> =
                bench.stretches(0, STRETCH).into_iter().filter(inside).collect();
            sizes(&model.left(bench, 0), &stretches)
        };
        Some(halves.iter().zip(models.iter().rev()).flat_map(other).collect())
    }

    /// What simulations with some effects miss, stretch by stretch, of runs that were not fitted to (of the first where
    /// there are no others).
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub fn simulated(&self, effects: &[Setting]) -> Result<Vec<f64>, Broken> {
        let bench = self.bench;
        let mut left = Vec::new();
        for run in usize::from(bench.runs.len() > 1)..bench.runs.len() {
            let missed = bench.missed(run, &bench.simulated(run, effects)?);
            left.extend(sizes(&missed, &bench.stretches(run, STRETCH)));
        }
        Ok(left)
    }

    /// The model with its values moved by what looks get wrong: a simulation of it is looked at like the recording, and by
    /// as much as the values that it shows are off, those of the recording are taken to be. As it was where that makes no
    /// sense or misses more of the first run.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub fn corrected(&self, model: HeldModel) -> Result<HeldModel, Broken> {
        let bench = self.bench;
        let simulated = bench.simulated(0, &model.settings())?;
        let missed = squares(&bench.missed(0, &simulated));
        let seen = HeldBench::new(&bench.rig, vec![simulated], bench.control, false).ok();
        let seen = seen.and_then(|seen| {
            seen.look_at(0, &model.names());
            HeldModel::fit(&seen, 0, seen.rows(0), &model.names(), &[])
        });
        let Some(seen) = seen else { return Ok(model) };
        let moved = |((term, value), (_, seen)): (&(HeldTerm, f64), &(HeldTerm, f64))| {
            (term.clone(), 2.0 * value - seen)
        };
        let corrected =
            HeldModel { terms: model.terms.iter().zip(&seen.terms).map(moved).collect() };
        if !corrected.is_physical() {
            return Ok(model);
        }
        let simulated = bench.simulated(0, &corrected.settings())?;
        let better = squares(&bench.missed(0, &simulated)) < missed;
        Ok(if better { corrected } else { model })
    }

    /// Takes out, latest first, effects that `terms` have beside those of a `base` and without which the simulated
    /// machine is neither certainly worse stretch by stretch nor worse as a whole: the inverse model knows the sign of
    /// the speed, the simulation what the machine does around it. Returns the terms that went.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub fn drop_idle(
        &self,
        terms: &mut Vec<HeldTerm>,
        base: &[HeldTerm],
    ) -> Result<Vec<HeldTerm>, Broken> {
        let mut dropped = Vec::new();
        let same =
            |a: &HeldTerm, b: &HeldTerm| a.kind().name == b.kind().name && a.target() == b.target();
        let mut effects: Vec<HeldTerm> = Vec::new();
        for term in terms.iter().rev().filter(|term| !base.contains(term)) {
            if !effects.iter().any(|known| same(known, term)) {
                effects.push(term.clone());
            }
        }
        for effect in effects {
            let (idle, rest): (Vec<HeldTerm>, Vec<HeldTerm>) =
                terms.iter().cloned().partition(|t| !base.contains(t) && same(t, &effect));
            let (Some(with), Some(less)) = (self.fitted(terms), self.fitted(&rest)) else {
                continue;
            };
            let with = self.simulated(&with.settings())?;
            let less = self.simulated(&less.settings())?;
            let ratio = Ratio::of(&less, &with);
            let small = ratio.ci95[0] <= 1.0 || ratio.mean < 1.0 + WORTH;
            // Over all stretches together, too: one that is at rest counts as much as a stroke above.
            if small && squares(&less) < squares(&with) * (1.0 + WORTH).powi(2) {
                *terms = rest;
                dropped.extend(idle);
            }
        }
        Ok(dropped)
    }

    /// Of candidates of one form that differ in a number only (a speed, a pitch), the one that fits the first run best:
    /// numbers are fitted there, and only forms compete elsewhere.
    pub fn by_form(&self, candidates: Vec<Candidate>) -> Vec<Candidate> {
        let mut all: Vec<HeldTerm> = Vec::new();
        for term in candidates.iter().flat_map(|candidate| &candidate.terms) {
            if !all.contains(term) {
                all.push(term.clone());
            }
        }
        self.bench.look_at(0, &all);
        let scanned =
            |kind: &str| ["film-friction", "stribeck-friction", "screw-ripple"].contains(&kind);
        let mut best: Vec<(f64, Candidate)> = Vec::new();
        for candidate in candidates {
            let Some(model) = self.fitted(&candidate.terms) else { continue };
            let error = model.error(self.bench, 0, self.bench.rows(0));
            let rival = best.iter_mut().find(|(_, other)| {
                scanned(candidate.kind.name)
                    && other.kind.name == candidate.kind.name
                    && other.target == candidate.target
            });
            match rival {
                Some(rival) if error < rival.0 => *rival = (error, candidate),
                Some(_) => {}
                None => best.push((error, candidate)),
            }
        }
        best.into_iter().map(|(_, candidate)| candidate).collect()
    }
}
