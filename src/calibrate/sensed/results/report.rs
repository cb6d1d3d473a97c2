//! `report.json` and the folder of results.

use super::outcome::SensedOutcome;
use crate::calibrate::quantity;
use crate::calibrate::results::report::{
    ActsOn, Depends, EffectReport, Ranked, RattleReport, ResidualReport, Seeds,
};
use crate::calibrate::results::verdict::Verdict;
use crate::calibrate::sensed::intake::noise::OtherNoise;
use crate::calibrate::sensed::judged::left::Left;
use crate::calibrate::sensed::judged::limits::DetectionLimit;
use crate::calibrate::sensed::rounds::rest::Rest;
use crate::calibrate::sensed::rounds::round::{Round, Tried};
use crate::calibrate::sensed::rounds::words::{name, names};
use crate::calibrate::sensed::windows::horizons::Windows;
use crate::calibrate::values::errors::{ChannelError, worst};
use crate::effects::Setting;
use crate::simulate::Provenance;
use serde::Serialize;

/// The report. Keys are promised to scripts; see the README.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Program, versions, rig as declared.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What the calibration comes to.
    pub verdict: Verdict,
    /// The same in a sentence or two.
    pub summary: String,
    /// What the model was given.
    pub effects: Vec<EffectReport>,
    /// Errors by run and column.
    pub errors: Vec<ChannelError>,
    /// Candidates, round by round, the best first in each.
    pub ranking: Vec<Ranked>,
    /// Sensors whose noise is not what is declared; all else rests on what was measured.
    pub noises: Vec<OtherNoise>,
    /// How large other effects would have to be for these recordings to show them; empty where what is left is
    /// not noise.
    pub limits: Vec<LimitReport>,
    /// Residuals, on the run where most is left, under the declared and under the calibrated model.
    pub residuals: Vec<ResidualReport>,
    /// Whether the declared machine rattles by more than its sensors see, and what follows.
    pub rattle: RattleReport,
    /// Kinds of effects that were excluded by `--without`.
    pub without: Vec<String>,
    /// Velocity error allowed for one step of a simulation in m/s.
    pub tolerance_m_s: f64,
    /// Seeds.
    pub seeds: Seeds,
    /// Simulations of a run that it took.
    pub simulations: usize,
    /// Time of computing in s.
    pub wall_s: f64,
    /// What stands beside this file.
    pub files: Vec<String>,
    /// Of a machine that forgets its start: what errors are, and by how much predictions miss over windows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub windows: Option<Windows>,
}

pub(super) fn summary(outcome: &SensedOutcome) -> String {
    let lasting = || lasting(outcome);
    let list = lasting().map(name).collect::<Vec<_>>().join(" and ");
    let worst = worst(&outcome.errors).map_or_else(String::new, |error| {
        format!(
            " (worst: {} of {}, {:.2} floors)",
            error.channel,
            error.run,
            error.after / error.floor
        )
    });
    match outcome.verdict {
        Verdict::NothingMissing => format!(
            "The declared model explains the recordings to within noise: nothing is missing{worst}."
        ),
        Verdict::Explained if list.is_empty() => format!(
            "With what does not last the declared model explains the recordings to within noise{worst}."
        ),
        Verdict::Explained => format!(
            "The declared model lacks {}. With {} the recordings are explained to within noise{worst}.{}",
            lacking(outcome),
            match lasting().count() {
                _ if lasting().any(|effect| !as_good(outcome, effect).is_empty()) => &list,
                1 => "it",
                _ => "them",
            },
            not_ruled_out(outcome)
        ),
        Verdict::Unexplained if outcome.rest.is_some() => format!(
            "{} leaves residuals that are no more than noise, but {}.",
            names(&outcome.tried),
            outcome.rest.as_ref().map_or_else(String::new, Rest::words)
        ),
        Verdict::Unexplained => format!(
            "What the declared model misses stands above noise, and no effect with a name that was tried \
             explains it{worst}.{}",
            match &outcome.described {
                Some(described) => format!(
                    " It varies with {}: a fitted table stands in for it, which predicts and \
                     explains nothing.",
                    described.words()
                ),
                None => String::new(),
            }
        ),
    }
}

/// The effects that were found and last.
fn lasting(outcome: &SensedOutcome) -> impl Iterator<Item = &Setting> {
    outcome.effects.iter().map(|(effect, _)| effect).filter(|effect| effect.history().is_none())
}

/// The round in which an effect was added.
fn round_of<'a>(outcome: &'a SensedOutcome, effect: &Setting) -> Option<&'a Round> {
    let mut rounds = outcome.rounds.iter();
    rounds.find(|round| round.added.as_ref().is_some_and(|added| added.is(effect)))
}

/// What explains the recordings as well as an effect that was found does, as whole simulations showed.
fn as_good<'a>(outcome: &'a SensedOutcome, effect: &Setting) -> &'a [Setting] {
    round_of(outcome, effect).map_or(&[], |round| &round.as_good)
}

/// What the declared model lacks: of what explains as much these recordings do not say which.
fn lacking(outcome: &SensedOutcome) -> String {
    let one = |effect: &Setting| match as_good(outcome, effect) {
        [] => name(effect),
        others => one_of(std::iter::once(effect).chain(others).map(name).collect()),
    };
    lasting(outcome).map(one).collect::<Vec<_>>().join(", and ")
}

/// What one of several is.
fn one_of(names: Vec<String>) -> String {
    let (last, others) = names.split_last().map_or(("", &[][..]), |(last, others)| (last, others));
    format!("one of {} or {last}, which these recordings do not tell apart", others.join(", "))
}

/// What residuals alone do not rule out in place of what was found.
fn not_ruled_out(outcome: &SensedOutcome) -> String {
    let all = lasting(outcome).filter_map(|effect| {
        let others = &round_of(outcome, effect)?.not_ruled_out;
        let were = if others.len() == 1 { "was" } else { "were" };
        let others = others.iter().map(name).collect::<Vec<_>>().join(" or ");
        (!others.is_empty()).then(|| {
            format!(
                " In place of {} residuals alone do not rule out {others}, which {were} not simulated.",
                name(effect)
            )
        })
    });
    all.collect()
}

/// What is said of instruments that are noisier or quieter than declared.
pub(super) fn noises(noises: &[OtherNoise]) -> String {
    let one = |noise: &OtherNoise| match noise.declared {
        0.0 => {
            let OtherNoise { column, measured, unit, .. } = noise;
            format!(" {column} declares no noise: {} was measured.", quantity(*measured, unit))
        }
        _ => format!(
            " Noise of {} is {:.2} × declared.",
            noise.column,
            noise.measured / noise.declared
        ),
    };
    noises.iter().map(one).collect()
}

pub(super) fn effects(outcome: &SensedOutcome) -> Vec<EffectReport> {
    let report = |(effect, params): &crate::calibrate::sensed::values::certainty::Estimated| {
        let own = outcome.events.iter().find(|event| Some(&event.history) == effect.history());
        if let Some(event) = own {
            return event.report();
        }
        let round = round_of(outcome, effect);
        let gain = round.and_then(|round| {
            round.tried.iter().find(|tried| tried.effect.is(effect)).map(|tried| tried.gain)
        });
        EffectReport {
            kind: effect.kind.name,
            on: ActsOn::of(effect),
            depends_on: Depends::of(effect),
            params: params.clone(),
            evidence: match (&outcome.described, gain) {
                (Some(described), _) => described.evidence(),
                (None, Some(gain)) if gain <= 0.0 => {
                    "shows in how the machine goes on, in whole simulations of it; residuals hardly tell".to_owned()
                }
                (None, Some(gain)) => format!(
                    "takes {gain:.0} off the sum of squares, in units of noise, on data that it was not \
                     fitted to"
                ),
                (None, None) => String::new(),
            },
            as_good: as_good(outcome, effect).iter().map(name).collect(),
            not_ruled_out: round
                .map_or_else(Vec::new, |round| round.not_ruled_out.iter().map(name).collect()),
            equation: effect.kind.equation,
        }
    };
    outcome.effects.iter().map(report).collect()
}

/// The smallest size of an effect that would have been seen.
#[derive(Clone, Debug, Serialize)]
pub struct LimitReport {
    /// Its name.
    pub kind: &'static str,
    /// What it acts on.
    #[serde(flatten)]
    pub on: ActsOn,
    /// Its parameter.
    pub parameter: &'static str,
    /// Unit of that.
    pub unit: &'static str,
    /// How far from its neutral value that would have to be; null where no size would show.
    pub smallest: Option<f64>,
}

pub(super) fn limit(limit: &DetectionLimit) -> LimitReport {
    LimitReport {
        kind: limit.kind.name,
        on: ActsOn::at(&limit.target),
        parameter: limit.parameter,
        unit: limit.unit,
        smallest: limit.smallest,
    }
}

pub(super) fn ranking(outcome: &SensedOutcome) -> Vec<Ranked> {
    let kept = |tried: &Tried| outcome.effects.iter().any(|(effect, _)| effect.is(&tried.effect));
    let mut ranked = Vec::new();
    for (i, round) in outcome.rounds.iter().enumerate() {
        let added = |tried: &&Tried| round.added.as_ref().is_some_and(|a| a.is(&tried.effect));
        // Of the variants of one effect the one that was simulated, if any was.
        let own = round.tried.iter().position(|tried| tried.simulated && added(&tried));
        let own = own.or_else(|| round.tried.iter().position(|tried| added(&tried)));
        for (place, tried) in round.tried.iter().enumerate() {
            let added = own == Some(place);
            ranked.push(Ranked {
                kind: tried.effect.kind.name,
                on: ActsOn::of(&tried.effect),
                validation_score: tried.share,
                kept: added && kept(tried),
                round: i + 1,
                simulated: tried.simulated,
                gain: tried.gain,
            });
        }
    }
    ranked
}

pub(super) fn residuals(before: &[Left], after: &[Left]) -> Vec<ResidualReport> {
    let pair = |(before, after): (&Left, &Left)| ResidualReport {
        residual: format!("{} of {}", before.residual.word(), before.of),
        mean_square_before: before.mean_square,
        mean_square_after: after.mean_square,
        noise_up_to: after.limit,
        largest_before: before.largest,
        largest_after: after.largest,
        largest_noise_up_to: after.largest_limit,
    };
    before.iter().zip(after).map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::one_of;

    #[test]
    fn what_is_not_told_apart_reads_well() {
        let names = |all: &[&str]| all.iter().map(|&name| name.to_owned()).collect();
        let said = one_of(names(&["payload at rod", "drag at rod", "gravity"]));
        let apart = "which these recordings do not tell apart";
        assert_eq!(said, format!("one of payload at rod, drag at rod or gravity, {apart}"));
        assert_eq!(one_of(names(&["wear", "oil"])), format!("one of wear or oil, {apart}"));
    }
}
