//! Whether an answer is right.

use super::hidden::Hidden;
use super::trial::HiddenValue;
use super::{Case, Trial, TrialAnswer};
use crate::calibrate::results::verdict::Verdict;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Stopped};
use crate::calibrate::sensed::results::outcome::SensedOutcome;
use crate::calibrate::sensed::values::certainty::Estimated;
use crate::effects::{Setting, Target};
use crate::mechanism::Mechanism;
use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

/// What an answer comes to beside what is hidden; time and simulations are the caller's.
pub(super) fn judge(
    trial: &Trial,
    hidden: &Hidden,
    problem: &RigProblem,
    outcome: &SensedOutcome,
) -> TrialAnswer {
    let mechanism = &problem.declared;
    let found: Vec<Setting> = outcome.effects.iter().map(|(effect, _)| effect.clone()).collect();
    let (said, true_names) = (names(&found, mechanism), names(&hidden.effects, mechanism));
    let explained = outcome.verdict == Verdict::Explained;
    let noises: Vec<&String> = outcome.noises.iter().map(|noise| &noise.column).collect();
    let right = match trial.case {
        Case::Withheld => outcome.verdict == Verdict::Unexplained,
        _ if hidden.effects.is_empty() => {
            outcome.verdict == Verdict::NothingMissing
                && noises == hidden.noisier.iter().collect::<Vec<_>>()
        }
        _ => explained && said == true_names,
    };
    let validation = || outcome.errors.iter().filter(|error| error.role == "validation");
    let as_good = |effect: &Setting| {
        found.iter().any(|found| found.is(effect))
            || outcome
                .rounds
                .iter()
                .any(|r| r.as_good.iter().chain(&r.not_ruled_out).any(|other| other.is(effect)))
    };
    TrialAnswer {
        lacks: lacks(hidden),
        verdict: outcome.verdict,
        found: answer(outcome),
        right,
        wrong_name: explained && !said.is_subset(&true_names),
        as_good: explained && hidden.effects.iter().all(as_good),
        values: hidden.effects.iter().flat_map(|own| values(own, &outcome.effects)).collect(),
        floors: hidden.floors,
        least: hidden.least,
        worst_ratio: validation().map(|e| e.after / e.floor).fold(0.0, f64::max),
        rattle: outcome.rattle,
        simulations: 0,
        seconds: 0.0,
    }
}

/// The answer of a method that stopped: none.
pub(super) fn stopped_short(hidden: &Hidden, stopped: &Stopped) -> TrialAnswer {
    TrialAnswer {
        lacks: lacks(hidden),
        verdict: Verdict::Unexplained,
        found: format!("stopped: {stopped}"),
        right: false,
        wrong_name: false,
        as_good: false,
        values: Vec::new(),
        floors: hidden.floors,
        least: hidden.least,
        worst_ratio: 0.0,
        rattle: 0.0,
        simulations: 0,
        seconds: 0.0,
    }
}

/// Names of effects, target by target: a common cause of several joints is the same as one cause in each, and all
/// joints are the same as each of them.
fn names(effects: &[Setting], mechanism: &Mechanism) -> BTreeSet<(&'static str, String)> {
    let of = |effect: &Setting| {
        let kind = effect.better_known_as(mechanism).unwrap_or(effect.kind.name);
        let targets = match &effect.target {
            Target::Machine if effect.kind.targets.joints().is_some() => {
                effect.kind.joints_of(mechanism)
            }
            Target::Machine => vec![String::new()],
            other => other.names().to_vec(),
        };
        targets.into_iter().map(move |target| (kind, target)).collect::<Vec<_>>()
    };
    effects.iter().flat_map(of).collect()
}

/// An effect with its target and values, in words.
fn words(effect: &Setting) -> String {
    let values = effect.values().map(|(name, value)| format!("{name} {value:.4e}"));
    format!("{effect} ({})", values.collect::<Vec<_>>().join(", "))
}

fn list(effects: &[Setting]) -> String {
    match effects {
        [] => "nothing".to_owned(),
        effects => effects.iter().map(words).collect::<Vec<_>>().join(" and "),
    }
}

fn lacks(hidden: &Hidden) -> String {
    match &hidden.noisier {
        Some(column) => format!("noise of {column}"),
        None => list(&hidden.effects),
    }
}

/// What was found in words, and where nothing explains what was tried and what it left.
fn answer(outcome: &SensedOutcome) -> String {
    let noises = outcome.noises.iter().map(|noise| format!("; noise of {}", noise.column));
    let noises: String = noises.collect();
    if outcome.verdict != Verdict::Unexplained {
        let found: Vec<Setting> =
            outcome.effects.iter().map(|(effect, _)| effect.clone()).collect();
        return list(&found) + &noises;
    }
    let most = |score: &dyn Fn(&crate::calibrate::sensed::judged::left::Left) -> f64| {
        let left = outcome.after.iter().max_by(|a, b| score(a).total_cmp(&score(b)));
        left.map_or_else(String::new, |left| {
            format!("{} of {} {:.2}", left.residual.word(), left.of, score(left))
        })
    };
    let worst = crate::calibrate::values::errors::worst(&outcome.errors)
        .map_or_else(String::new, |e| {
            format!("{} of {} by {:.2} floors", e.channel, e.run, e.after / e.floor)
        });
    let rest = outcome.rest.as_ref().map_or_else(String::new, |rest| format!("; {}", rest.words()));
    format!(
        "tried {}; leaves mean square {}, largest {}; misses {worst}{rest}{noises}",
        list(&outcome.tried),
        most(&|left| left.mean_square),
        most(&|left| left.largest),
    )
}

/// Values of a hidden effect beside those that were found of it, phases on the same turn.
fn values(lacking: &Setting, found: &[Estimated]) -> Vec<HiddenValue> {
    let Some((_, estimates)) = found.iter().find(|(effect, _)| effect.is(lacking)) else {
        return Vec::new();
    };
    let estimate = |name: &str| estimates.iter().find(|(known, _)| *known == name);
    // The same wave half a turn on has the other sign.
    let phase = lacking.kind.scan.map(|scan| scan.phase);
    let turned = phase.is_some_and(|phase| {
        let pair = lacking.value(phase).zip(estimate(phase));
        pair.is_some_and(|(truth, (_, found))| (found.value - truth).cos() < 0.0)
    });
    let over = lacking.kind.scan.map(|scan| scan.over);
    let one = |(name, truth): (&'static str, f64)| {
        let (_, fitted) = estimate(name)?;
        let value = if name.ends_with("phase_rad") {
            let near = if turned { fitted.value + PI } else { fitted.value };
            near - ((near - truth) / TAU).round() * TAU
        } else if turned && over != Some(name) {
            -fitted.value
        } else {
            fitted.value
        };
        let std = Some(fitted.std).filter(|std| std.is_finite());
        Some(HiddenValue { name: format!("{}.{name}", lacking.kind.name), truth, value, std })
    };
    lacking.values().filter_map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::super::Trial;
    use super::super::record::TrialBench;
    use super::*;
    use crate::effects::{Kind, named};

    /// A common cause is the same as a cause in each joint, and not the same as one in one of them.
    #[test]
    fn a_common_cause_goes_by_the_names_of_its_joints() {
        let seed = (0..).find(|seed| Trial::draw(*seed).machine == "five-bar").unwrap();
        let mechanism = TrialBench::new(&Trial::draw(seed)).unwrap().declared;
        let kind: &'static Kind = named("journal-friction").unwrap();
        let at = |joints: &[&str]| {
            let target = Target::Joints(joints.iter().map(|&joint| joint.to_owned()).collect());
            Setting::on(kind, target, &[("mu", 0.1)])
        };
        let of = |effects: &[Setting]| names(effects, &mechanism);
        assert_eq!(of(&[at(&["A1", "A2"])]), of(&[at(&["A2"]), at(&["A1"])]));
        assert_ne!(of(&[at(&["A1", "A2"])]), of(&[at(&["A1"])]));
        let everywhere = Setting::on(kind, Target::Machine, &[("mu", 0.1)]);
        assert!(of(&[at(&["A1", "A2", "E"])]).is_subset(&of(&[everywhere])));
    }
}
