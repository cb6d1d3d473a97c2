//! One effect after another, until what is left of the residual is noise; several ways at once, for the
//! first of two effects is often mistaken for a rival that also takes up a part of the second.

use super::fit::Target;
use super::instrument::changed;
use super::left::{is_noise, left};
use super::model::{Case, SearchError};
use super::needed::{contains, needed};
use super::screen::{Scored, screen, share};
use super::settle::{
    GAIN_PER_VALUE, Question, SETTLED, Settled, compared, refined, settle, settle_while, simplified,
};
use crate::effects::{SELDOM, Setting};

/// By how much misfits of equally good models differ by chance, with loaded joints and with joints that
/// rattle: there bias and noise come from six replicas, and settling the same model again changes its
/// misfit by some 300 (measured on worn joints); twice that.
const CHANCE: [f64; 2] = [10.0, 600.0];

/// Drop of Σ of squares on data not used for the fit that an effect has to bring, with loaded joints and
/// with joints that rattle, and how much more for each of its values. Twice the logarithm of the number
/// of candidates, some 150 with their frequencies, is 10. An effect three times as large as what hides
/// it brings a thousand and more.
const GAIN: [f64; 2] = [40.0, 200.0];

/// Gain through the lens from which a candidate is worth simulating, with loaded joints and with joints
/// that rattle: there a lens shows little, in units of a noise that contains what is missing.
const WORTH: [f64; 2] = [40.0, 25.0];

/// How far behind the best a candidate is a rival in any case: what rattle hides from a lens.
const REACH: [f64; 2] = [0.0, 500.0];

/// Rivals that are simulated beside a model, the declared one and one that has effects already, and the
/// share of the best one's gain that makes a rival.
const RIVALS: [usize; 2] = [6, 3];
const RIVAL_SHARE: f64 = 0.6;

/// Candidates that are simulated for what they explain of the data they were fitted to, where a lens sees
/// next to nothing that holds on other data.
const FITTED: usize = 3;

/// Models that are followed at once while none of them is noise; the share of the best one's drop that
/// makes another worth following, and how many times as much of it may stand above noise.
const WAYS: usize = 4;
const WAY_SHARE: f64 = 0.9;
const WAY_REST: f64 = 5.0;

/// Share of the best rival's drop that one has to bring at its first guess, for its values to be worth
/// settling.
const PROMISING: f64 = 0.6;

/// Simulations after which values have settled, at most; where the declared machine's joints rattle the best
/// of so many counts. Where they rattle under what is missing alone, a first guess is far off.
const SETTLES: [usize; 2] = [7, 4];

/// Most effects that are added.
const EFFECTS: usize = 3;

/// Runs simulated after which no third effect is looked for, and rivals are taken at their first guess: half
/// of what two cores simulate in two minutes, for runs of three seconds.
const BUDGET: usize = 220;

/// Share of what stands above noise that an effect has to remove to be believed where something else
/// remains: what passes for an effect without being it rarely removes as much.
const CERTAIN: f64 = 0.9;

/// Drop of Σ of squares through one and the same lens that tells two effects apart; and what a seldom effect
/// has to bring beyond a commoner one.
const APART: f64 = 10.0;
const SELDOM_PRICE: f64 = 20.0;

/// The least such share of an effect that is worth adding: of up to [`EFFECTS`] effects, one removes a
/// third. What removes less takes up some of what it is not.
const LEAST: f64 = 0.2;

/// One round of the search.
#[derive(Clone, Debug)]
pub struct Round {
    /// Candidates, the best first.
    pub ranking: Vec<Scored>,
    /// What was added, if anything was worth it.
    pub added: Option<Setting>,
    /// What could have been added as well.
    pub as_good: Vec<Setting>,
}

impl Round {
    /// A round in which nothing was worth adding.
    fn without_gain(ranking: Vec<Scored>) -> Self {
        Self { ranking, added: None, as_good: Vec::new() }
    }
}

/// A model and how it was come by.
#[derive(Clone, Debug)]
pub struct Way {
    /// The model.
    pub model: Settled,
    /// The rounds that led to it.
    pub rounds: Vec<Round>,
    /// Whether each of its effects removed nearly all that stood above noise before it.
    pub certain: bool,
}

impl Way {
    /// What models of different numbers of values are compared by.
    pub fn cost(&self) -> f64 {
        self.model.misfit + self.price()
    }

    /// What its values have to bring.
    fn price(&self) -> f64 {
        let values = self.model.fit.effects.iter().map(|effect| effect.values().count());
        GAIN_PER_VALUE * values.sum::<usize>() as f64
    }

    /// What was added last.
    fn added(&self) -> Option<&Setting> {
        self.rounds.last()?.added.as_ref()
    }

    /// Its effects, whatever their order and values.
    fn key(effects: &[Setting]) -> Vec<String> {
        let with_values = |effect: &Setting| {
            let values: Vec<&str> = effect.values().map(|(name, _)| name).collect();
            format!("{}: {}", name(effect), values.join(" "))
        };
        let mut names: Vec<String> = effects.iter().map(with_values).collect();
        names.sort();
        names
    }
}

/// What a search found.
#[derive(Debug)]
pub struct Found {
    /// The best model, with all rounds.
    pub best: Way,
    /// The model as declared.
    pub declared: Settled,
    /// Models whose effects are certain, should the best one not be noise.
    pub certain: Vec<Way>,
}

/// Searches for what the declared model lacks; `tell` hears what is being tried.
///
/// # Errors
/// A rig that cannot be simulated.
pub fn search(
    case: &Case,
    question: &Question,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Found, SearchError> {
    tell("simulating the model as declared");
    let declared = settle(case, question, &[], 1, None)?;
    let threshold = GAIN[usize::from(case.chaotic)];
    let mut best = Way { model: declared.clone(), rounds: Vec::new(), certain: true };
    let mut ways = vec![best.clone()];
    let mut certain = Vec::new();
    let until = case.simulated() + BUDGET;
    while best.model.fit.effects.len() < EFFECTS
        && (best.rounds.len() < 2 || case.simulated() < until)
    {
        // What is noise already is not explained any better, only looked through for the record.
        if is_noise(&left(case, question, &best.model)) {
            let ranking = screen(case, question, &best.model).into_iter().map(|(scored, _)| scored);
            best.rounds.push(Round::without_gain(ranking.collect()));
            break;
        }
        let mut next: Vec<Way> = Vec::new();
        let mut searched = Vec::new();
        let mut tried: Vec<Vec<String>> = Vec::new();
        for way in &ways {
            tell(&format!("trying every effect beside {}", names(&way.model.fit.effects)));
            let (found, round) = beside(case, question, way, &next, &mut tried, until, tell)?;
            next.extend(found);
            searched.push(round);
        }
        next.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        told_apart(case, question, &mut next);
        let won = next.first().is_some_and(|first| first.cost() < best.cost() - threshold);
        if !won {
            best.rounds.extend(searched.into_iter().next());
            break;
        }
        let winner = next.remove(0);
        let near = best.cost() - WAY_SHARE * (best.cost() - winner.cost());
        best = finished(case, question, winner, tell)?;
        let noise = best.model.baseline.places(case, question.hold).len() as f64;
        if !is_noise(&left(case, question, &best.model)) {
            // A right model may have settled far off, behind a wrong one.
            for way in next.iter_mut().take(WAYS - 1) {
                tell(&format!("settling {} point by point", names(&way.model.fit.effects)));
                way.model = refined(case, question, way.model.clone())?;
            }
            if let Some(better) = next.iter_mut().min_by(|a, b| a.cost().total_cmp(&b.cost()))
                && better.cost() < best.cost()
            {
                std::mem::swap(better, &mut best);
            }
        }
        ways = vec![best.clone()];
        certain.extend(next.iter().chain([&best]).filter(|way| way.certain).cloned());
        let rest = |way: &Way| way.model.held - noise;
        let most = WAY_REST * rest(&best).max(noise);
        next.retain(|way| way.cost() < near && rest(way) < most);
        next.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        next.truncate(WAYS - 1);
        ways.append(&mut next);
    }
    if is_noise(&left(case, question, &best.model)) {
        best.model = needed(case, question, best.model, threshold, tell)?;
        let kept = &best.model.fit.effects;
        for added in best.rounds.iter_mut().filter_map(|round| round.added.as_mut()) {
            let inner = kept.iter().find(|effect| contains(added, effect));
            *added = inner.unwrap_or(added).clone();
        }
    }
    Ok(Found { best, declared, certain })
}

/// A way whose values have settled, in its simplest variants.
fn finished(
    case: &Case,
    question: &Question,
    way: Way,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Way, SearchError> {
    let like = Some(&way.model.baseline);
    let settles = SETTLES[usize::from(case.chaotic)];
    let settled = |effects: &[Setting]| {
        tell(&format!("settling {}", names(effects)));
        let (mut least, mut in_vain) = (f64::INFINITY, 0);
        settle_while(case, question, effects, settles, like, |model, change| {
            in_vain = if model.misfit < least { 0 } else { in_vain + 1 };
            least = model.misfit;
            // Where joints rattle values never come to rest; of what may be the last model the best of
            // replicas that differ are taken.
            let patience = match case.chaotic {
                true if is_noise(&left(case, question, model)) => settles,
                true => 1,
                false => 2,
            };
            change > SETTLED && (!model.baseline.rattles || in_vain < patience)
        })
    };
    let effects = &way.model.fit.effects;
    let mut model = simplified(case, question, settled(effects)?);
    if Way::key(&model.fit.effects) != Way::key(effects) {
        // What a lens is wrong by depends on all values.
        model = settled(&model.fit.effects)?;
    }
    if !model.baseline.rattles {
        tell(&format!("settling {} point by point", names(&model.fit.effects)));
        model = refined(case, question, model)?;
    }
    Ok(Way { model, ..way })
}

/// Puts first which of the best models, whose misfits differ by no more than chance, is the best by a
/// better measure, and tells it which are as good. Where joints rattle that is the lens of the very best:
/// the data's rattle and the replicas' are the same for all of them there.
fn told_apart(case: &Case, question: &Question, ways: &mut [Way]) {
    let Some(best) = ways.first() else { return };
    let baseline = &best.model.baseline;
    let target = Target { case, baseline, on: question.hold, fixed: &[], blind: None };
    let left = |way: &Way| {
        if !baseline.rattles {
            return Some(way.cost());
        }
        let effects = &way.model.fit.effects;
        let white = changed(&target, &best.model.fit.effects, effects)?;
        Some(white.norm_squared() + way.price())
    };
    let reach = best.cost() + CHANCE[usize::from(baseline.rattles)];
    let near = ways.iter().take_while(|way| way.cost() < reach).enumerate();
    let near: Vec<(usize, f64)> = near.filter_map(|(i, way)| Some((i, left(way)?))).collect();
    let seldom = |way: &Way| {
        let known = |effect: &&Setting| SELDOM.iter().any(|kind| kind.name == effect.kind.name);
        SELDOM_PRICE * way.model.fit.effects.iter().filter(known).count() as f64
    };
    let cost = |(i, left): &(usize, f64)| left + seldom(&ways[*i]);
    let Some(&(first, least)) = near.iter().min_by(|a, b| cost(a).total_cmp(&cost(b))) else {
        return;
    };
    let first = simplest(case, question, ways, near.iter().map(|(i, _)| *i), first);
    let others = near.iter().filter(|(i, left)| *i != first && left - least < APART);
    let as_good: Vec<Setting> = others.filter_map(|(i, _)| ways[*i].added().cloned()).collect();
    if let Some(round) = ways[first].rounds.last_mut() {
        round.as_good = as_good;
    }
    ways[..=first].rotate_right(1);
}

/// Which of the ways that are `near` has the effects of the `first` in variants with the fewest values, and
/// still is noise, where joints rattle: what rattle leaves open between variants is more than values
/// that are none take up.
fn simplest(
    case: &Case,
    question: &Question,
    ways: &[Way],
    near: impl Iterator<Item = usize>,
    first: usize,
) -> usize {
    if !ways[first].model.baseline.rattles {
        return first;
    }
    let effects = |i: usize| &ways[i].model.fit.effects;
    let values = |i: usize| effects(i).iter().map(|effect| effect.values().count()).sum::<usize>();
    let simpler = near.filter(|&i| {
        let same = names(effects(i)) == names(effects(first)) && values(i) < values(first);
        same && is_noise(&left(case, question, &ways[i].model))
    });
    simpler.min_by_key(|&i| values(i)).unwrap_or(first)
}

/// The models that one more effect makes of one, and its round. Values of rivals are settled up to so many
/// simulated runs, and if they may be as good as what was found `before` beside other models. The first way
/// has its best rivals simulated even if another way has come to the same.
fn beside(
    case: &Case,
    question: &Question,
    way: &Way,
    before: &[Way],
    tried: &mut Vec<Vec<String>>,
    until: usize,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<(Vec<Way>, Round), SearchError> {
    let model = &way.model;
    let rattles = usize::from(model.baseline.rattles);
    let mut ranking = screen(case, question, model);
    let best = ranking.first().map_or(0.0, |(scored, _)| scored.gain);
    // What shows in the swing alone, as friction that damps it, a lens does not see, nor what makes joints
    // rattle that stay loaded without: then any candidate is as good a guess as the first, and so are those
    // that explain what they were fitted to.
    let blind = ranking.first().is_some_and(|(scored, _)| scored.share < LEAST);
    let reach = f64::min(RIVAL_SHARE * best, best - REACH[rattles]);
    let untried = |&i: &usize| !tried.contains(&Way::key(&ranking[i].1));
    let worth = |&i: &usize| {
        let gain = ranking[i].0.gain;
        gain > WORTH[rattles] && (blind || gain > reach)
    };
    let mut rivals: Vec<usize> = (0..ranking.len())
        .filter(worth)
        .filter(untried)
        .take(RIVALS[usize::from(!model.fit.effects.is_empty())])
        .collect();
    if blind && before.is_empty() {
        let fitted = |i: &usize| ranking[*i].0.fitted;
        let mut others: Vec<usize> = (0..ranking.len())
            .filter(|i| fitted(i) > WORTH[rattles] && !rivals.contains(i))
            .filter(untried)
            .collect();
        others.sort_by(|a, b| fitted(b).total_cmp(&fitted(a)));
        rivals.extend(others.into_iter().take(FITTED));
    }
    let mut settled: Vec<(Scored, Settled)> = Vec::new();
    for &i in &rivals {
        let (scored, effects) = &ranking[i];
        tried.push(Way::key(effects));
        tell(&format!("simulating {}", names(effects)));
        let like = Some(&model.baseline);
        let others =
            before.iter().map(|way| &way.model).chain(settled.iter().map(|(_, model)| model));
        let best = others.map(|other| other.misfit).fold(model.misfit, f64::min);
        let enough = model.misfit - PROMISING * (model.misfit - best) + CHANCE[rattles];
        let promises = |rival: &Settled| {
            // What rattles under a guess may be far off with right values.
            let far_off = rival.baseline.rattles != model.baseline.rattles;
            let hopeful = rival.misfit < enough || best == model.misfit || far_off;
            hopeful && case.simulated() < until
        };
        let Ok(rival) = compared(case, question, effects, like, promises) else { continue };
        let values = scored.effect.values().count() as f64;
        let (scored, _) = &mut ranking[i];
        let drop = model.misfit - rival.misfit;
        scored.gain = drop - GAIN_PER_VALUE * values;
        scored.share = share(model.held, model.held - drop, case, question, &rival.baseline);
        scored.simulated = true;
        if let Some(own) = rival.fit.effects.last() {
            scored.effect = own.clone();
        }
        settled.push((scored.clone(), rival));
    }
    let mut ranking: Vec<Scored> = ranking.into_iter().map(|(scored, _)| scored).collect();
    ranking.sort_by(|a, b| {
        let order = (b.simulated, b.gain).partial_cmp(&(a.simulated, a.gain));
        order.unwrap_or(std::cmp::Ordering::Equal)
    });
    let round = Round::without_gain(ranking);
    let worth = settled.into_iter().filter(|(scored, _)| scored.share > LEAST);
    let ways = worth.map(|(scored, model)| {
        let certain = way.certain && scored.share > CERTAIN;
        let added = Some(scored.effect);
        let own = Round { added, ..round.clone() };
        let rounds = way.rounds.iter().cloned().chain([own]).collect();
        Way { model, rounds, certain }
    });
    Ok((ways.collect(), round))
}

/// An effect in words: `joint-wear at A2`.
pub fn name(effect: &Setting) -> String {
    match &effect.joint {
        Some(joint) => format!("{} at {joint}", effect.kind.name),
        None => effect.kind.name.to_owned(),
    }
}

/// Effects in words.
pub fn names(effects: &[Setting]) -> String {
    if effects.is_empty() {
        return "the model as declared".to_owned();
    }
    effects.iter().map(name).collect::<Vec<_>>().join(", ")
}
