//! One effect after another, until what is left of the residual is noise; several ways at once, for the
//! first of two effects is often mistaken for a rival that also takes up a part of the second.

use super::beside::{CHANCE, Fan};
use super::left::{is_noise, left};
use super::needed::needed;
use super::way::{LegsRound, Way, names};
use crate::calibrate::values::fit::LegsFitTarget;
use crate::calibrate::values::instrument::changed;
use crate::calibrate::values::model::{LegsCase, SearchError};
use crate::calibrate::values::settle::{
    FitData, SETTLED, Settled, refined, settle, settle_while, simplified,
};
use crate::effects::{SELDOM, Setting};

/// Drop of Σ of squares on data not used for the fit that an effect has to bring, with loaded joints and
/// with joints that rattle, and how much more for each of its values. Twice the logarithm of the number
/// of candidates, some 150 with their frequencies, is 10. An effect three times as large as what hides
/// it brings a thousand and more.
const GAIN: [f64; 2] = [40.0, 200.0];

/// Models that are followed at once while none of them is noise; the share of the best one's drop that
/// makes another worth following, and how many times as much of it may stand above noise.
const WAYS: usize = 4;
const WAY_SHARE: f64 = 0.9;
const WAY_REST: f64 = 5.0;

/// Simulations after which values have settled, at most; where the declared machine's joints rattle the best
/// of so many counts. Where they rattle under what is missing alone, a first guess is far off.
const SETTLES: [usize; 2] = [7, 4];

/// Most effects that are added.
pub const EFFECTS: usize = 3;

/// Runs simulated ([`LegsCase::simulated`]) after which no third effect is looked for, and of other ways and of
/// rivals only the most promising are, at their first guess: less than half of what two slow cores simulate in
/// two minutes, for runs of three seconds. What follows a search takes the other half.
const BUDGET: f64 = 160.0;

/// Drop of −2 log likelihood from which an effect has calmed the rattle of recordings: misfits of one and the same
/// model, settled again, were up to 1050 apart, and friction of 0.11 in journals brings 2700 and more.
const CALMER: f64 = 1500.0;

/// Drop of Σ of squares through one and the same lens that tells two effects apart; and what a seldom effect
/// has to bring beyond a commoner one.
const APART: f64 = 10.0;
const SELDOM_PRICE: f64 = 20.0;

/// What a search found.
#[derive(Debug)]
pub struct LegsFound {
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
    case: &LegsCase,
    question: &FitData,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<LegsFound, SearchError> {
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
        if is_noise(&left(case, question, &best.model)) {
            let (round, calmer) = calmer(case, question, &best, until, tell)?;
            let Some(calmer) = calmer else {
                best.rounds.push(round);
                break;
            };
            best = calmer;
            ways = vec![best.clone()];
            continue;
        }
        let (round, mut next) = beside_all(case, question, &ways, until, tell)?;
        let won = next.first().is_some_and(|first| first.cost() < best.cost() - threshold);
        if !won {
            best.rounds.extend(round);
            break;
        }
        let winner = next.remove(0);
        let near = best.cost() - WAY_SHARE * (best.cost() - winner.cost());
        best = finished(case, question, winner, tell)?;
        let noise = best.model.baseline.places(case, question.hold).len() as f64;
        if !is_noise(&left(case, question, &best.model)) {
            // A right model may have settled far off, behind a wrong one.
            for way in next.iter_mut().take(WAYS - 1).take_while(|_| case.simulated() < until) {
                tell(&format!("settling {} point by point", names(&way.model.fit.effects)));
                way.model = refined(case, question, way.model.clone())?;
            }
            exchange_for_better(&mut best, &mut next);
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
        best.rename_added();
    }
    Ok(LegsFound { best, declared, certain })
}

/// What is found beside several ways, the best first, and the round of the first way.
fn beside_all(
    case: &LegsCase,
    question: &FitData,
    ways: &[Way],
    until: f64,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<(Option<LegsRound>, Vec<Way>), SearchError> {
    let mut fan = Fan::new(case, question, until, tell);
    let mut searched = Vec::new();
    for way in ways {
        if searched.is_empty() || fan.affords_another() {
            searched.push(fan.beside(way)?);
        }
    }
    let mut next = fan.found();
    next.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    told_apart(case, question, &mut next);
    Ok((searched.into_iter().next(), next))
}

/// Puts the best of others in the place of the best way, and that in its place, if it is better.
fn exchange_for_better(best: &mut Way, others: &mut [Way]) {
    if let Some(better) = others.iter_mut().min_by(|a, b| a.cost().total_cmp(&b.cost()))
        && better.cost() < best.cost()
    {
        std::mem::swap(better, best);
    }
}

impl Way {
    /// Rounds name what is left of what they added.
    fn rename_added(&mut self) {
        let kept = &self.model.fit.effects;
        for added in self.rounds.iter_mut().filter_map(|round| round.added.as_mut()) {
            let inner = kept.iter().find(|effect| added.contains(effect));
            *added = inner.unwrap_or(added).clone();
        }
    }
}

/// What is noise already is not explained any better; but that recorded joints rattle less than those of a
/// model does not show in what is left, only in its size. The round in which that was looked for, and
/// the way with what makes the recordings so much likelier that no chance does.
fn calmer(
    case: &LegsCase,
    question: &FitData,
    way: &Way,
    until: f64,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<(LegsRound, Option<Way>), SearchError> {
    let mut fan = Fan::new(case, question, until, tell);
    let round = fan.beside(way)?;
    let enough = way.cost() - CALMER;
    let calmer = fan.found().into_iter().min_by(|a, b| a.cost().total_cmp(&b.cost()));
    let Some(calmer) = calmer.filter(|calmer| calmer.cost() < enough) else {
        return Ok((round, None));
    };
    let calmer = finished(case, question, calmer, tell)?;
    let right = calmer.cost() < enough && is_noise(&left(case, question, &calmer.model));
    Ok((round, right.then_some(calmer)))
}

/// A way whose values have settled, in its simplest variants.
fn finished(
    case: &LegsCase,
    question: &FitData,
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
fn told_apart(case: &LegsCase, question: &FitData, ways: &mut [Way]) {
    let Some(best) = ways.first() else { return };
    let baseline = &best.model.baseline;
    let target = LegsFitTarget { case, baseline, on: question.hold, fixed: &[], blind: None };
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
    case: &LegsCase,
    question: &FitData,
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
