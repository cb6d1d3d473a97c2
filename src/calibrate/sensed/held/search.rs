//! What a held machine lacks: terms of its efforts, one after another, as long as data that they were not fitted to say
//! so.

use super::bench::{Broken, HeldBench};
use super::candidates::{Candidate, of_declared};
use super::judge::Judge;
use super::model::{HeldModel, squares, told};
use super::paired::Ratio;
use super::terms::HeldTerm;
use crate::calibrate::results::report::Fitted;
use crate::calibrate::sensed::thresholds::{BETTER, STRETCH, WORTH};
use crate::effects::{Kind, Setting, Target};
use crate::measure::student::NORMAL95;
use crate::scenario::Problem;

/// A candidate in a round.
#[derive(Clone, Debug)]
pub struct HeldTried {
    /// Its kind.
    pub kind: &'static Kind,
    /// What it acts on.
    pub target: Target,
    /// Round, from 1.
    pub round: usize,
    /// Share of the sum of squares that it takes off on data not used for its fit, of what the rounds before left.
    pub share: f64,
    /// Drop of that sum in units of what it leaves in a stretch.
    pub gain: f64,
    /// Whether the model has it from this round.
    pub kept: bool,
}

/// An effect of the calibrated model: its values that were fitted, and what it rests on.
#[derive(Clone, Debug)]
pub struct HeldEffect {
    /// The effect.
    pub effect: Setting,
    /// The values.
    pub params: Vec<(&'static str, Fitted)>,
    /// In a sentence.
    pub evidence: String,
}

/// What a search comes to.
#[derive(Clone, Debug)]
pub struct HeldOutcome {
    /// The model's effects whose values were sought; as declared where nothing is certainly better.
    pub effects: Vec<HeldEffect>,
    /// Names of those that the rig does not declare, or not so.
    pub lacking: Vec<String>,
    /// Candidates, round by round.
    pub tried: Vec<HeldTried>,
}

/// Why there is none.
#[derive(Debug, thiserror::Error)]
pub enum Failed {
    /// The recordings do not tell what is to be known.
    #[error("{0}")]
    Model(#[from] Problem),
    /// A simulation broke down.
    #[error(transparent)]
    Broken(#[from] Broken),
}

/// What the rig declares and what every machine has, as terms that the first run tells apart.
fn base(bench: &HeldBench, without: &[&str]) -> Vec<HeldTerm> {
    let declared = bench.declared.iter().flat_map(|effect| of_declared(bench, effect));
    let mut terms: Vec<HeldTerm> = declared.map(|(term, _)| term).collect();
    let common = bench.common().into_iter().filter(|term| {
        let both = |own: &HeldTerm| {
            let way = |way: &str| own.sought.starts_with("viscous_") && way.starts_with("viscous_");
            own.kind().name == term.kind().name
                && own.target() == term.target()
                && (own.sought == term.sought || way(term.sought))
        };
        !terms.iter().any(both) && !without.contains(&term.kind().name)
    });
    let common: Vec<HeldTerm> = common.collect();
    terms.extend(common);
    told(bench, 0, terms)
}

/// Searches for what the declared machine lacks, none of the kinds `without`.
///
/// # Errors
/// A recording that does not tell the terms apart, a machine that cannot be simulated.
pub fn search(
    bench: &HeldBench,
    without: &[&str],
    tell: &dyn Fn(&str),
) -> Result<HeldOutcome, Failed> {
    let judge = Judge { bench };
    let unfit = || {
        let message = format!(
            "cannot be told from {}: mass and friction are not told apart, or come out negative",
            bench.runs[0].recording.path
        );
        let help = "does it move, and is it the machine that the rig declares?";
        bench.rig.problem("mechanism", message, help)
    };
    let base = base(bench, without);
    let mut terms = base.clone();
    let mut left = judge.left(&terms).ok_or_else(unfit)?;
    let mut tried: Vec<HeldTried> = Vec::new();
    let mut added: Vec<(HeldTerm, String)> = Vec::new();
    for round in 1.. {
        tell(&format!("round {round}: looking for what is left"));
        let Some(taken) = best(&judge, &terms, &left, without, round, &mut tried) else { break };
        let fresh = taken.candidate.terms.iter().filter(|term| !terms.contains(term));
        added.extend(fresh.map(|term| (term.clone(), taken.evidence())));
        (terms, left) = (taken.candidate.terms, taken.left);
    }
    tell("simulating without each");
    let dropped = judge.drop_idle(&mut terms, &base)?;
    added.retain(|(term, _)| terms.contains(term));
    for tried in &mut tried {
        let went = |t: &HeldTerm| t.kind().name == tried.kind.name && *t.target() == tried.target;
        tried.kept &= !dropped.iter().any(went);
    }
    let declared: Vec<(HeldTerm, f64)> =
        bench.declared.iter().flat_map(|effect| of_declared(bench, effect)).collect();
    let is_declared = |term: &HeldTerm| declared.iter().any(|(own, _)| own == term);
    let kept = |term: &HeldTerm| is_declared(term) || added.iter().any(|(own, _)| own == term);
    tell("looking at what was found like at the recording");
    let (model, deviations) = certain(&judge, terms, &kept)?.ok_or_else(unfit)?;
    // Values that are not certainly better than the declared ones stay as declared.
    tell("simulating what was found and what is declared");
    let as_declared = judge.simulated(&bench.declared)?;
    let fitted = judge.simulated(&model.settings())?;
    if added.is_empty() && Ratio::of(&as_declared, &fitted).ci95[0] <= 1.0 {
        let effects = Vec::new();
        return Ok(HeldOutcome { effects, lacking: Vec::new(), tried });
    }
    let (effects, lacking) = reported(&model, &deviations, &added, &is_declared);
    Ok(HeldOutcome { effects, lacking, tried })
}

/// A model's effects with what they rest on, and the names of those that the rig does not declare, or not so.
fn reported(
    model: &HeldModel,
    deviations: &[f64],
    added: &[(HeldTerm, String)],
    is_declared: &dyn Fn(&HeldTerm) -> bool,
) -> (Vec<HeldEffect>, Vec<String>) {
    let mut found = Vec::new();
    let mut lacking = Vec::new();
    for (effect, params) in model.effects(deviations) {
        let of = |term: &HeldTerm| {
            term.kind().name == effect.kind.name && *term.target() == effect.target
        };
        let mut reasons: Vec<&str> = Vec::new();
        for (_, reason) in added.iter().filter(|(term, _)| of(term)) {
            if !reasons.contains(&reason.as_str()) {
                reasons.push(reason);
            }
        }
        let known = model.terms.iter().any(|(term, _)| of(term) && is_declared(term));
        let evidence = match (reasons.is_empty(), known) {
            (false, _) => reasons.join("; "),
            (true, true) => "is declared".to_owned(),
            (true, false) => "is certain by how differently stretches pull at it".to_owned(),
        };
        if !reasons.is_empty() || !known {
            lacking.push(effect.to_string());
        }
        // What was scanned has no interval of its own.
        let scanned = effect.values().filter(|(name, value)| {
            let fitted = params.iter().any(|(own, _)| own == name);
            !fitted && !name.starts_with("velocity") && *value != 0.0
        });
        let scanned = scanned.map(|(name, value)| (name, Fitted::new(value, f64::NAN)));
        let params = params.iter().copied().chain(scanned).collect();
        found.push(HeldEffect { effect: effect.clone(), params, evidence });
    }
    (found, lacking)
}

/// A candidate that is taken, what it leaves, and how much better that is.
struct TakenCandidate {
    candidate: Candidate,
    left: Vec<f64>,
    share: f64,
    ratio: Ratio,
}

impl TakenCandidate {
    fn evidence(&self) -> String {
        let Ratio { mean, ci95: [low, high] } = self.ratio;
        format!(
            "({}) removes {:.1} % of the variance of what was left on data that it was not fitted to; the error of a \
             stretch falls to {mean:.3} of itself (95 %: {low:.3} to {high:.3})",
            self.candidate.what,
            100.0 * self.share,
        )
    }
}

/// The best candidate beside some terms, or one with fewer terms that is as good: an offset rather than two frictions;
/// none where none is certainly better.
fn best(
    judge: &Judge,
    terms: &[HeldTerm],
    left: &[f64],
    without: &[&str],
    round: usize,
    listed: &mut Vec<HeldTried>,
) -> Option<TakenCandidate> {
    let mut tried: Vec<TakenCandidate> = Vec::new();
    for candidate in judge.by_form(judge.bench.candidates(terms, without)) {
        let Some(after) = judge.left(&candidate.terms) else { continue };
        let share = 1.0 - squares(&after) / squares(left);
        tried.push(TakenCandidate {
            ratio: Ratio::of(&after, left),
            candidate,
            left: after,
            share,
        });
    }
    tried.sort_by(|a, b| b.share.total_cmp(&a.share));
    let certain = |ratio: &Ratio| {
        let half = (ratio.ci95[1] / ratio.mean).ln();
        ratio.mean.ln() + BETTER * half < 0.0 && ratio.mean < 1.0 - WORTH
    };
    let first = tried.iter().position(|t| t.share > 0.0 && certain(&t.ratio));
    let as_good = |i: &usize| {
        let own = &tried[*i];
        let behind = first.map(|first| Ratio::of(&own.left, &tried[first].left));
        let near = behind.is_some_and(|b| b.ci95[0] <= 1.0 || b.mean < 1.0 + WORTH);
        own.share > 0.0 && certain(&own.ratio) && (near || first == Some(*i))
    };
    let taken = (0..tried.len()).filter(as_good).min_by_key(|i| tried[*i].candidate.terms.len());
    listed.extend(tried.iter().enumerate().map(|(i, own)| HeldTried {
        kind: own.candidate.kind,
        target: own.candidate.target.clone(),
        round,
        share: own.share.clamp(0.0, 1.0),
        gain: own.share / (1.0 - own.share) * own.left.len() as f64,
        kept: taken == Some(i),
    }));
    taken.map(|taken| tried.swap_remove(taken))
}

/// The model with these terms and the deviations of its values, without those that are neither `kept` nor certain: what
/// every machine has may be as it is declared. None where the recording does not tell.
fn certain(
    judge: &Judge,
    mut terms: Vec<HeldTerm>,
    kept: &dyn Fn(&HeldTerm) -> bool,
) -> Result<Option<(HeldModel, Vec<f64>)>, Broken> {
    let bench = judge.bench;
    loop {
        let Some(model) = judge.fitted(&terms) else { return Ok(None) };
        let deviations = model.deviations(bench, 0, &bench.stretches(0, STRETCH));
        let model = judge.corrected(model)?;
        let sizes = model.terms.iter().zip(&deviations).map(|((_, value), std)| value.abs() / std);
        let least = sizes
            .enumerate()
            .filter(|(i, size)| !kept(&terms[*i]) && *size < BETTER * NORMAL95)
            .min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((least, _)) = least else { return Ok(Some((model, deviations))) };
        terms.remove(least);
    }
}
