//! One more effect beside those that a model has: which candidates are worth simulating, and what they bring.

use super::left::{is_noise, left};
use super::screen::{Scored, screen, share};
use super::way::{LegsRound, Way, names};
use crate::calibrate::values::model::{LegsCase, SearchError};
use crate::calibrate::values::settle::{FitData, GAIN_PER_VALUE, Settled, compared};
use crate::effects::{CALMING, Kind, Setting, Target as On};

/// Gain through the lens from which a candidate is worth simulating, with loaded joints and with joints
/// that rattle: there a lens shows little, in units of a noise that contains what is missing.
const WORTH: [f64; 2] = [40.0, 25.0];

/// How far behind the best a candidate is a rival in any case: what rattle hides from a lens.
const REACH: [f64; 2] = [0.0, 500.0];

/// Rivals that are simulated beside a model, the declared one and one that has effects already, and the
/// share of the best one's gain that makes a rival.
const RIVALS: [usize; 2] = [6, 3];
const RIVAL_SHARE: f64 = 0.6;

/// Rivals that are simulated in any case.
const FEW: usize = 2;

/// Candidates that are simulated for what they explain of the data they were fitted to, where a lens sees
/// next to nothing that holds on other data.
const FITTED: usize = 3;

/// Share of the best rival's drop that one has to bring at its first guess, for its values to be worth
/// settling.
const PROMISING: f64 = 0.6;

/// Share of what stands above noise that an effect has to remove to be believed where something else
/// remains: what passes for an effect without being it rarely removes as much.
const CERTAIN: f64 = 0.9;

/// The least such share of an effect that is worth adding: of up to three effects ([`EFFECTS`]) one removes
/// a third. What removes less takes up some of what it is not.
///
/// [`EFFECTS`]: super::search::EFFECTS
const LEAST: f64 = 0.2;

/// By how much misfits of equally good models differ by chance, with loaded joints and with joints that
/// rattle: there bias and noise come from six replicas, and misfits of one and the same model, settled again, were up to
/// 1050 apart.
pub const CHANCE: [f64; 2] = [10.0, 1050.0];

/// What one more effect makes of several models in turn.
pub struct Fan<'a> {
    case: &'a LegsCase,
    question: &'a FitData<'a>,
    /// Simulated runs up to which rivals are simulated, and their values settled.
    until: f64,
    tell: &'a (dyn Fn(&str) + Sync),
    /// Models that were simulated.
    tried: Vec<Vec<String>>,
    /// Models that were worth adding an effect to, with it.
    found: Vec<Way>,
    /// What made one of them noise.
    enough: Option<Scored>,
}

impl<'a> Fan<'a> {
    /// Nothing tried yet; `tell` hears what is.
    pub fn new(
        case: &'a LegsCase,
        question: &'a FitData<'a>,
        until: f64,
        tell: &'a (dyn Fn(&str) + Sync),
    ) -> Self {
        Self { case, question, until, tell, tried: Vec::new(), found: Vec::new(), enough: None }
    }

    /// The models that were found.
    pub fn found(self) -> Vec<Way> {
        self.found
    }

    /// Tries every effect beside those of a model; beside one that leaves nothing but noise, what would calm its
    /// rattle. Once one has left nothing but noise it is the only one
    /// that is tried beside others, which may have been mistaken for a part of it.
    ///
    /// # Errors
    /// A machine that cannot be simulated.
    pub fn beside(&mut self, way: &Way) -> Result<LegsRound, SearchError> {
        let Self { case, question, .. } = *self;
        let effects = &way.model.fit.effects;
        let noise = is_noise(&left(case, question, &way.model));
        let (mut ranking, rivals) = match &self.enough {
            None => {
                (self.tell)(&format!("trying every effect beside {}", names(effects)));
                let ranking = screen(case, question, &way.model);
                let rivals = match noise {
                    true if case.chaotic && way.model.baseline.rattles => calming(way, &ranking),
                    true => Vec::new(),
                    false => self.rivals(way, &ranking),
                };
                (ranking, rivals)
            }
            Some(scored) if effects.iter().any(|effect| effect.is(&scored.effect)) => {
                (Vec::new(), Vec::new())
            }
            Some(scored) => {
                let with = [effects.as_slice(), std::slice::from_ref(&scored.effect)].concat();
                let untried = !self.tried.contains(&Way::key(&with));
                (vec![(scored.clone(), with)], Vec::from_iter(untried.then_some(0)))
            }
        };
        let mut settled: Vec<(Scored, Settled)> = Vec::new();
        for (place, i) in rivals.into_iter().enumerate() {
            if place >= FEW && case.simulated() > self.until {
                break;
            }
            let (scored, effects) = &mut ranking[i];
            self.tried.push(Way::key(effects));
            if let Some(rival) = self.simulated(way, &settled, scored, effects) {
                if noise {
                    // It removes nothing that stands above it.
                    scored.share = 0.0;
                }
                settled.push((scored.clone(), rival));
            }
        }
        let mut ranking: Vec<Scored> = ranking.into_iter().map(|(scored, _)| scored).collect();
        ranking.sort_by(|a, b| {
            let order = (b.simulated, b.gain).partial_cmp(&(a.simulated, a.gain));
            order.unwrap_or(std::cmp::Ordering::Equal)
        });
        let round = LegsRound::without_gain(ranking);
        let worth = |(scored, _): &(Scored, Settled)| noise || scored.share > LEAST;
        for (scored, model) in settled.into_iter().filter(worth) {
            if self.enough.is_none() && is_noise(&left(case, question, &model)) {
                self.enough = Some(scored.clone());
            }
            let certain = way.certain && scored.share > CERTAIN;
            let own = LegsRound { added: Some(scored.effect), ..round.clone() };
            let rounds = way.rounds.iter().cloned().chain([own]).collect();
            self.found.push(Way { model, rounds, certain });
        }
        Ok(round)
    }

    /// Whether one more model is worth looking at: where an effect is known that makes another one noise
    /// it takes a single simulation.
    pub fn affords_another(&self) -> bool {
        self.enough.is_some() || self.case.simulated() < self.until
    }

    /// Which candidates are worth simulating. The first way has its best rivals simulated even if another
    /// way has come to the same.
    fn rivals(&self, way: &Way, ranking: &[(Scored, Vec<Setting>)]) -> Vec<usize> {
        let rattles = usize::from(way.model.baseline.rattles);
        let best = ranking.first().map_or(0.0, |(scored, _)| scored.gain);
        // What shows in the swing alone, as friction that damps it, a lens does not see, nor what makes
        // joints rattle that stay loaded without: then any candidate is as good a guess as the first,
        // and so are those that explain what they were fitted to.
        let blind = ranking.first().is_some_and(|(scored, _)| scored.share < LEAST);
        let reach = f64::min(RIVAL_SHARE * best, best - REACH[rattles]);
        let untried = |&i: &usize| !self.tried.contains(&Way::key(&ranking[i].1));
        let worth = |&i: &usize| {
            let gain = ranking[i].0.gain;
            gain > WORTH[rattles] && (blind || gain > reach)
        };
        let mut rivals: Vec<usize> = (0..ranking.len())
            .filter(worth)
            .filter(untried)
            .take(RIVALS[usize::from(!way.model.fit.effects.is_empty())])
            .collect();
        if blind && self.found.is_empty() {
            let fitted = |i: &usize| ranking[*i].0.fitted;
            let mut others: Vec<usize> = (0..ranking.len())
                .filter(|i| fitted(i) > WORTH[rattles] && !rivals.contains(i))
                .filter(untried)
                .collect();
            others.sort_by(|a, b| fitted(b).total_cmp(&fitted(a)));
            rivals.extend(others.into_iter().take(FITTED));
        }
        rivals
    }

    /// A rival, its values settled if it may be as good as what was found beside other models and what has
    /// `settled` beside this one, and its score; none where it cannot be simulated.
    fn simulated(
        &self,
        way: &Way,
        settled: &[(Scored, Settled)],
        scored: &mut Scored,
        effects: &[Setting],
    ) -> Option<Settled> {
        let Self { case, question, .. } = *self;
        let model = &way.model;
        let rattles = usize::from(model.baseline.rattles);
        (self.tell)(&format!("simulating {}", names(effects)));
        let others = self.found.iter().map(|way| &way.model);
        let others = others.chain(settled.iter().map(|(_, model)| model));
        let best = others.map(|other| other.misfit).fold(model.misfit, f64::min);
        let enough = model.misfit - PROMISING * (model.misfit - best) + CHANCE[rattles];
        let promises = |rival: &Settled| {
            // What rattles under a guess may be far off with right values.
            let far_off = rival.baseline.rattles != model.baseline.rattles;
            let hopeful = rival.misfit < enough || best == model.misfit || far_off;
            hopeful && case.simulated() < self.until
        };
        let rival = compared(case, question, effects, Some(&model.baseline), promises).ok()?;
        let values = scored.effect.values().count() as f64;
        let drop = model.misfit - rival.misfit;
        scored.gain = drop - GAIN_PER_VALUE * values;
        scored.share = share(model.held, model.held - drop, case, question, &rival.baseline);
        scored.simulated = true;
        if let Some(own) = rival.fit.effects.last() {
            scored.effect = own.clone();
        }
        Some(rival)
    }
}

/// What may have calmed a rattle: of each kind that a model has not, the variant that explains most of the data it
/// was fitted to.
fn calming(way: &Way, ranking: &[(Scored, Vec<Setting>)]) -> Vec<usize> {
    let has =
        |kind: &Kind| way.model.fit.effects.iter().any(|effect| effect.kind.name == kind.name);
    let best = |kind: &&Kind| {
        let own = |i: &usize| {
            let effect = &ranking[*i].0.effect;
            effect.kind.name == kind.name && effect.target == On::Machine
        };
        let fitted = |i: &usize| ranking[*i].0.fitted;
        (0..ranking.len()).filter(own).max_by(|a, b| fitted(a).total_cmp(&fitted(b)))
    };
    CALMING.iter().filter(|kind| !has(kind)).filter_map(best).collect()
}
