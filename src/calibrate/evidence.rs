//! What speaks for an effect, and what does as well.

use super::outcome::{Outcome, Verdict};
use super::screen::Scored;
use super::search::{Round, name};
use crate::effects::Setting;

/// One sentence on what an effect rests on.
pub fn evidence(outcome: &Outcome, effect: &Setting) -> String {
    if let (Some(_), Some(described)) = (effect.map(), &outcome.described) {
        let depends = described.others.first().map_or("", |(class, _)| class.words());
        return format!(
            "a force that varies with {depends} removes {:.0} % of what stands above noise on data \
             not used for its fit; no effect with a name does",
            100.0 * described.share
        );
    }
    let Some((round, own)) = added(outcome, effect) else { return String::new() };
    let mut text = format!(
        "removes {:.1} % of what stood above noise on data not used for its fit",
        100.0 * own.share
    );
    let twins = as_good(outcome, effect);
    let mut rivals = round.ranking.iter().filter(|scored| scored.simulated);
    if !twins.is_empty() {
        let traces =
            twins.iter().map(|twin| format!("{} shows in {}", name(twin), twin.kind.trace));
        text += &format!(
            "; on this motion it cannot be told from {}. A motion on which their traces differ more would \
             tell: {} shows in {}; {}",
            twins.iter().map(|twin| name(twin)).collect::<Vec<_>>().join(", "),
            name(effect),
            effect.kind.trace,
            traces.collect::<Vec<_>>().join("; ")
        );
    } else if let Some(rival) = rivals.find(|rival| !rival.effect.is(effect)) {
        let (rival, ahead) = (name(&rival.effect), own.gain - rival.gain);
        text += &if ahead > 0.0 {
            format!("; the next best, {rival}, leaves {ahead:.0} more in units of squared noise")
        } else {
            format!("; {rival} did as well by itself, but not with what was found after it")
        };
    }
    text
}

/// Effects that explain these recordings as well as one that was found, but for chance; none where another
/// was found after it, beside which they did worse.
pub fn as_good<'a>(outcome: &'a Outcome, effect: &Setting) -> Vec<&'a Setting> {
    let Some((round, own)) = added(outcome, effect) else { return Vec::new() };
    let later = outcome.rounds.iter().rev().take_while(|later| !std::ptr::eq(*later, round));
    if outcome.verdict != Verdict::Explained || later.into_iter().any(|r| r.added.is_some()) {
        return Vec::new();
    }
    let mut twins: Vec<&Setting> = Vec::new();
    for scored in round.ranking.iter().filter(|scored| scored.simulated) {
        let known = scored.effect.is(effect) || twins.iter().any(|t| t.is(&scored.effect));
        if !known && scored.gain > own.gain - outcome.chance {
            twins.push(&scored.effect);
        }
    }
    twins
}

/// The round that added an effect, and what it brought.
fn added<'a>(outcome: &'a Outcome, effect: &Setting) -> Option<(&'a Round, &'a Scored)> {
    let round =
        outcome.rounds.iter().find(|r| r.added.as_ref().is_some_and(|added| added.is(effect)))?;
    let own = round.ranking.iter().find(|scored| scored.simulated && scored.effect.is(effect))?;
    Some((round, own))
}
