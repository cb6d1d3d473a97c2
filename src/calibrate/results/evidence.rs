//! What speaks for an effect, and what does as well.

use super::outcome::{LegsOutcome, Verdict};
use crate::calibrate::rounds::screen::Scored;
use crate::calibrate::rounds::way::{LegsRound, name};
use crate::effects::Setting;

/// One sentence on what an effect rests on.
pub fn evidence(outcome: &LegsOutcome, effect: &Setting) -> String {
    if let (Some(_), Some(described)) = (effect.efforts(), &outcome.described) {
        return described.evidence();
    }
    let Some((round, own)) = added(outcome, effect) else { return String::new() };
    let mut text = if own.share > 0.0 {
        let share = 100.0 * own.share;
        format!("removes {share:.1} % of what stood above noise on data not used for its fit")
    } else {
        format!(
            "nothing stands above noise without it, but joints rattle more than the recorded ones then: with it \
             the recordings are e^{:.0} times as likely",
            own.gain / 2.0
        )
    };
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
pub fn as_good<'a>(outcome: &'a LegsOutcome, effect: &Setting) -> Vec<&'a Setting> {
    let last = outcome.rounds.iter().rev().find(|round| round.added.is_some());
    let own = last.filter(|round| round.added.as_ref().is_some_and(|added| added.is(effect)));
    let mut twins: Vec<&Setting> = Vec::new();
    for twin in own.iter().flat_map(|round| &round.as_good) {
        let known = twin.is(effect) || twins.iter().any(|other| other.is(twin));
        if !known && outcome.verdict == Verdict::Explained {
            twins.push(twin);
        }
    }
    twins
}

/// The round that added an effect, and what it brought.
fn added<'a>(outcome: &'a LegsOutcome, effect: &Setting) -> Option<(&'a LegsRound, &'a Scored)> {
    let round =
        outcome.rounds.iter().find(|r| r.added.as_ref().is_some_and(|added| added.is(effect)))?;
    let own = round.ranking.iter().find(|scored| scored.simulated && scored.effect.is(effect))?;
    Some((round, own))
}
