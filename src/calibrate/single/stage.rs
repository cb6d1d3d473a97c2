//! What a declared drive stage lacks: terms of its force, one after another, as long as data that they
//! were not fitted to say so.

use super::calibration::{Adjusted, Found, Ranked};
use crate::calibrate::report::{EffectReport, Fitted};
use crate::calibrate::result::CalibrateError;
use crate::effects::{Range as Tried, Setting, named};
use crate::identify::inverse::{Model, Term};
use crate::identify::paired::Ratio;
use crate::identify::stage::{
    Recording, Samples, cascade, effects, first_length, halves, lag, ripple, simulated_force, stage,
};
use crate::identify::{self, Missing, Recorded};
use crate::mechanism::Mechanism;
use crate::scenario::{self, Scenario};
use crate::simulate::started;
use std::ops::Range;
use std::sync::Arc;

/// Stretches in s over which errors are compared: longer than what is left remembers, a tenth of a
/// second at most, with some to spare.
const BLOCK: f64 = 1.0;

/// Half widths of a 95 % interval that a candidate has to be better by: three standard errors, since a
/// dozen are tried in each round.
const CERTAIN: f64 = 1.5;

/// Share by which a candidate has to be better besides: what is certain and less than this is not worth
/// a parameter.
const WORTH: f64 = 0.01;

/// Speeds in m/s that are tried for friction that builds up or falls: from a hundredth of working speeds
/// to a good share of them.
const SPEEDS: [f64; 9] = [2e-3, 4e-3, 6e-3, 8e-3, 1e-2, 1.4e-2, 2e-2, 3e-2, 5e-2];

/// What is lacking where the drive is later than declared.
const LAG: &str = "lag of the drive (drive.sampled.lag)";

/// What may be added to a model: the effect, its form in words, and the terms.
struct Candidate {
    kind: &'static str,
    what: String,
    terms: Vec<Term>,
}

/// What speaks against a rig beforehand.
pub(super) fn ready(rig: &Scenario) -> Vec<String> {
    let mut wrong = Vec::new();
    if cascade(rig).is_none() {
        let help =
            "write mode = \"sampled\": calibrate takes a drive stage by its sampled controller";
        wrong.push(rig.problem("drive.mode", "is not \"sampled\"", help).to_string());
    }
    for (i, effect) in rig.effects.iter().enumerate() {
        if terms_of(effect).is_none() {
            let help = "take it out, or use `freeplay predict`";
            let message =
                format!("\"{}\" is not what calibrate knows of a drive stage", effect.kind.name);
            wrong.push(rig.problem(&format!("effect.{i}.kind"), message, help).to_string());
        }
    }
    wrong
}

/// Terms of the force that a declared effect stands for.
fn terms_of(effect: &Setting) -> Option<Vec<Term>> {
    let given = |name: &str| effect.value(name).is_some_and(|value| value != 0.0);
    match effect.kind.name {
        "actuator-friction" => {
            let mut terms = Vec::new();
            let ways = ["coulomb_pos_N", "coulomb_neg_N", "viscous_pos_Ns_m", "viscous_neg_Ns_m"];
            if ways.into_iter().any(given) {
                terms.extend(WAYS);
            } else {
                terms.push(Term::Viscous);
                terms.extend(given("coulomb_N").then_some(Term::Coulomb));
                terms.extend(given("offset_N").then_some(Term::Offset));
            }
            Some(terms)
        }
        "film-friction" => Some(vec![Term::Film(effect.value("speed_m_s")?)]),
        "stribeck-friction" => Some(vec![Term::Stribeck(effect.value("stribeck_m_s")?)]),
        "air-drag" => Some(vec![Term::Drag]),
        "screw-ripple" if given("amplitude_N") => Some(
            [true, false]
                .map(|sine| Term::Ripple(effect.value("pitch_m").unwrap_or(0.0), sine))
                .into(),
        ),
        _ => None,
    }
}

/// Friction that differs with direction; an offset is the difference of its dry parts.
const WAYS: [Term; 4] = [
    Term::ViscousWay(true),
    Term::ViscousWay(false),
    Term::CoulombWay(true),
    Term::CoulombWay(false),
];

/// What the rig declares, as terms: mass and viscous friction at least. The lag always: a force that is
/// held from sample to sample comes half a sample late.
fn declared(rig: &Scenario) -> Vec<Term> {
    let mut terms = vec![Term::Mass, Term::Lag];
    for term in rig.effects.iter().filter_map(terms_of).flatten() {
        if !terms.contains(&term) {
            terms.push(term);
        }
    }
    if !terms.iter().any(|t| matches!(t, Term::Viscous | Term::ViscousWay(_))) {
        terms.push(Term::Viscous);
    }
    terms
}

/// Everything that can be added to a model.
fn candidates(terms: &[Term], without: &[&str]) -> Vec<Candidate> {
    let has = |wanted: fn(&Term) -> bool| terms.iter().any(wanted);
    let mut found = Vec::new();
    let mut add = |kind: &'static str, what: String, terms: Vec<Term>| {
        if !without.contains(&kind) {
            found.push(Candidate { kind, what, terms });
        }
    };
    let ways = has(|t| matches!(t, Term::ViscousWay(_)));
    let with = |more: &[Term]| [terms, more].concat();
    if !ways && !has(|t| *t == Term::Coulomb) {
        add("actuator-friction", "dry friction".to_owned(), with(&[Term::Coulomb]));
    }
    if !ways && !has(|t| *t == Term::Offset) {
        add("actuator-friction", "an offset of the force".to_owned(), with(&[Term::Offset]));
    }
    if !ways && has(|t| *t == Term::Coulomb) {
        let symmetric = |t: &&Term| !matches!(t, Term::Viscous | Term::Coulomb | Term::Offset);
        let others: Vec<Term> = terms.iter().filter(symmetric).copied().collect();
        let what = "friction that differs with direction".to_owned();
        add("actuator-friction", what, [&others[..], &WAYS].concat());
    }
    // Departures from dry friction near rest; by themselves they would stand for all of it.
    let dry = has(|t| matches!(t, Term::Coulomb | Term::CoulombWay(_)));
    for speed in SPEEDS.into_iter().filter(|_| dry) {
        let mm = 1e3 * speed;
        if !has(|t| matches!(t, Term::Film(_))) {
            let what = format!("friction that builds up over {mm} mm/s");
            add("film-friction", what, with(&[Term::Film(speed)]));
        }
        if !has(|t| matches!(t, Term::Stribeck(_))) {
            let what = format!("friction that falls over {mm} mm/s");
            add("stribeck-friction", what, with(&[Term::Stribeck(speed)]));
        }
    }
    if !has(|t| *t == Term::Drag) {
        add("air-drag", "drag with the square of the speed".to_owned(), with(&[Term::Drag]));
    }
    let scan = named("screw-ripple").and_then(|kind| kind.scan).map(|scan| scan.range);
    if let (false, Some(Tried::WaveNumbers([first, last, step]))) =
        (has(|t| matches!(t, Term::Ripple(..))), scan)
    {
        let count = ((last - first) / step).floor() as usize;
        for pitch in (0..=count).map(|k| 1.0 / (first + step * k as f64)) {
            let what = format!("ripple of a screw of {:.3} mm", 1e3 * pitch);
            let both = [true, false].map(|sine| Term::Ripple(pitch, sine));
            add("screw-ripple", what, with(&both));
        }
    }
    found
}

/// Whether a fitted model means anything: nothing gives back what it should take.
fn physical(model: &Model) -> bool {
    let free = |term: &Term| matches!(term, Term::Offset | Term::Ripple(..));
    model.terms.iter().all(|(term, factor)| free(term) || *factor >= 0.0)
}

/// Recordings ready for the regression, and what of them is for judging.
struct Judge {
    data: Recording,
    held: Vec<Recording>,
}

impl Judge {
    fn fit(&self, rows: Range<usize>, terms: &[Term]) -> Option<Model> {
        Model::fit(&self.data.motion, rows, terms, &[]).filter(physical)
    }

    /// What a model with these terms leaves on stretches that it was not fitted to, N; `None` where it
    /// means nothing.
    fn left(&self, terms: &[Term]) -> Option<Vec<f64>> {
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

/// Kinds of effects by the terms that they add to what is declared.
fn kind_of(term: &Term) -> Option<&'static str> {
    match term {
        Term::Coulomb | Term::Offset | Term::CoulombWay(_) => Some("actuator-friction"),
        Term::Film(_) => Some("film-friction"),
        Term::Stribeck(_) => Some("stribeck-friction"),
        Term::Drag => Some("air-drag"),
        Term::Ripple(..) => Some("screw-ripple"),
        Term::Mass | Term::Lag | Term::Viscous | Term::ViscousWay(_) => None,
    }
}

impl Judge {
    /// What closed loops miss of the force in N, stretch by stretch, on runs that were not fitted to (on
    /// the data where there are no others).
    fn simulated(
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
    /// certainly worse stretch by stretch nor worse as a whole: the regression knows the sign of the speed, the simulation what the machine
    /// does around it. Those of the declared terms stay. Returns the kinds that went.
    fn drop_idle(
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

fn squares(left: &[f64]) -> f64 {
    left.iter().map(|x| x * x).sum()
}

/// Of candidates of one form that differ in a number only (a speed, a pitch), the one that fits the data
/// best: numbers are fitted there, and only forms compete elsewhere.
fn by_form(judge: &Judge, candidates: Vec<Candidate>) -> Vec<Candidate> {
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

/// Searches for what the declared stage lacks.
///
/// # Errors
/// A recording that does not tell the terms apart.
pub(super) fn search(
    rig: &Scenario,
    runs: &[Recorded],
    without: &[&str],
    tell: &dyn Fn(&str),
) -> Result<Found, CalibrateError> {
    let unfit = || {
        let name = runs.first().map_or("", |run| run.path.as_str());
        let message = "mass and viscous friction cannot be told apart, or come out negative";
        let help = "does the stage move, and is it the one that the rig declares?";
        CalibrateError::Input(vec![format!("{name}: {message}; {help}")])
    };
    let cascade = cascade(rig).ok_or_else(unfit)?;
    let mut all = runs.iter().map(|run| Recording::of(run.log.clone(), cascade));
    let judge = Judge { data: all.next().ok_or_else(unfit)?, held: all.collect() };
    let mut terms = declared(rig);
    let mut left = judge.left(&terms).ok_or_else(unfit)?;
    let (mut ranking, mut added): (Vec<Ranked>, Vec<(&str, String)>) = (Vec::new(), Vec::new());
    for round in 1.. {
        tell(&format!("round {round}: looking for what is left"));
        let mut tried: Vec<(f64, Ratio, Candidate, Vec<f64>)> = Vec::new();
        for candidate in by_form(&judge, candidates(&terms, without)) {
            let Some(after) = judge.left(&candidate.terms) else { continue };
            let score = 1.0 - squares(&after) / squares(&left);
            tried.push((score, Ratio::of(&after, &left), candidate, after));
        }
        tried.sort_by(|a, b| b.0.total_cmp(&a.0));
        let certain = |ratio: &Ratio| {
            let half = (ratio.ci95[1] / ratio.mean).ln();
            ratio.mean.ln() + CERTAIN * half < 0.0 && ratio.mean < 1.0 - WORTH
        };
        // The best, or one with fewer terms that is as good: an offset rather than two frictions.
        let best = tried.iter().position(|(score, ratio, ..)| *score > 0.0 && certain(ratio));
        let as_good = |i: &usize| {
            let (score, ratio, _, after) = &tried[*i];
            let behind = best.map(|best| Ratio::of(after, &tried[best].3));
            let near = behind.is_some_and(|b| b.ci95[0] <= 1.0 || b.mean < 1.0 + WORTH);
            *score > 0.0 && certain(ratio) && (near || best == Some(*i))
        };
        let taken = (0..tried.len()).filter(as_good).min_by_key(|i| tried[*i].2.terms.len());
        ranking.extend(tried.iter().enumerate().map(|(i, (score, ratio, candidate, _))| Ranked {
            kind: candidate.kind,
            joint: (candidate.kind != "air-drag").then_some("P1"),
            what: candidate.what.clone(),
            validation_score: score.clamp(0.0, 1.0),
            kept: taken == Some(i),
            round,
            ratio: ratio.mean,
            ratio_ci95: ratio.ci95,
        }));
        let Some(taken) = taken else { break };
        let (score, ratio, candidate, after) = tried.swap_remove(taken);
        let evidence = format!(
            "({}) removes {:.1} % of the variance of what was left on data that it was not fitted to; the \
             error of a stretch falls to {:.3} of itself (95 %: {:.3} to {:.3})",
            candidate.what,
            100.0 * score,
            ratio.mean,
            ratio.ci95[0],
            ratio.ci95[1]
        );
        added.push((candidate.kind, evidence));
        (terms, left) = (candidate.terms, after);
    }
    tell("simulating the closed loop without each");
    let dropped = judge.drop_idle(&mut terms, &declared(rig))?;
    added.retain(|(kind, _)| !dropped.contains(kind));
    for ranked in &mut ranking {
        ranked.kept &= !dropped.contains(&ranked.kind);
    }
    let model = judge.fit(judge.data.motion.rows(), &terms).ok_or_else(unfit)?;
    let mut found = found(rig, &judge, &model, ranking, added);
    // Numbers that are not certainly better than the declared ones stay as declared.
    let fitted = judge.simulated(|run| stage(&model, run))?;
    let as_declared = judge.simulated(|run| {
        let start = [first_length(&run.log), 0.0];
        started(rig, start, Arc::new(Samples::of(&run.log)))
            .map_err(|problem| Missing::Wrong(problem.to_string()))
    })?;
    let effects = found.added.iter().any(|name| name != LAG);
    if !effects && Ratio::of(&as_declared, &fitted).ci95[0] <= 1.0 {
        found.scenario = rig.clone();
        found.added.clear();
    }
    Ok(found)
}

fn found(
    rig: &Scenario,
    judge: &Judge,
    model: &Model,
    ranking: Vec<Ranked>,
    added: Vec<(&'static str, String)>,
) -> Found {
    let motion = &judge.data.motion;
    let stds = model.deviations(motion, &motion.blocks(BLOCK));
    let std = |wanted: Term| {
        let place = model.terms.iter().position(|(term, _)| *term == wanted);
        place.map_or(f64::NAN, |i| stds[i])
    };
    let reported = effects(model).into_iter().map(|setting| {
        let evidence: Vec<&str> = added
            .iter()
            .filter(|(kind, _)| *kind == setting.kind.name)
            .map(|(_, evidence)| evidence.as_str())
            .collect();
        let evidence =
            if evidence.is_empty() { "is declared".to_owned() } else { evidence.join("; ") };
        let params = setting.values().filter(|(name, _)| *name != "velocity_m_s");
        let params =
            params.map(|(name, value)| (name, Fitted::new(value, std_of(name, model, &std))));
        EffectReport {
            kind: setting.kind.name,
            joint: setting.joint.clone(),
            depends_on: None,
            params: params.collect(),
            evidence,
            equation: setting.kind.equation,
        }
    });
    let effects = reported.collect();
    let mass = match &rig.mechanism {
        scenario::Mechanism::DriveStage(stage) => stage.mass,
        scenario::Mechanism::ThreeRpr(_) | scenario::Mechanism::Pendulum(_) => f64::NAN,
    };
    let whole = model.factor(Term::Mass);
    let mut parameters =
        vec![Adjusted::new("mechanism.mass", "kg", mass, Fitted::new(whole, std(Term::Mass)))];
    let mut names: Vec<String> = Vec::new();
    for (kind, _) in added {
        if !names.iter().any(|name| name == kind) {
            names.push(kind.to_owned());
        }
    }
    let cascade = judge.data.cascade;
    let slow = lag(model, &cascade);
    let late = Adjusted::new(
        "drive.sampled.lag",
        "s",
        cascade.lag,
        Fitted::new(slow, std(Term::Lag) / whole),
    );
    if (slow - cascade.lag).abs() > CERTAIN * 1.96 * late.std {
        names.push(LAG.to_owned());
    }
    parameters.push(late);
    Found {
        scenario: identify::stage::scenario(rig, model),
        effects,
        parameters,
        ranking,
        added: names,
    }
}

/// Standard deviation of a parameter of an effect, from those of the terms' factors.
fn std_of(name: &str, model: &Model, std: &dyn Fn(Term) -> f64) -> f64 {
    let found = |wanted: fn(&Term) -> bool| {
        model.terms.iter().find(|(t, _)| wanted(t)).map_or(f64::NAN, |(t, _)| std(*t))
    };
    match name {
        "coulomb_N" => std(Term::Coulomb),
        "viscous_Ns_m" => std(Term::Viscous),
        "coulomb_pos_N" => std(Term::CoulombWay(true)),
        "coulomb_neg_N" => std(Term::CoulombWay(false)),
        "viscous_pos_Ns_m" => std(Term::ViscousWay(true)),
        "viscous_neg_Ns_m" => std(Term::ViscousWay(false)),
        "offset_N" => std(Term::Offset),
        "force_Ns2_m2" => std(Term::Drag),
        "force_N" => found(|t| matches!(t, Term::Film(_))),
        "static_N" => found(|t| matches!(t, Term::Stribeck(_))),
        // Of a sum of sine and cosine: the size of the mean of both, over the amplitude for the phase.
        "amplitude_N" | "phase_rad" => ripple(model).map_or(f64::NAN, |(pitch, amplitude, _)| {
            let both = [true, false].map(|sine| std(Term::Ripple(pitch, sine)));
            let mean = both[0].hypot(both[1]) / 2f64.sqrt();
            if name == "amplitude_N" { mean } else { mean / amplitude }
        }),
        // What was scanned has no interval of its own.
        _ => f64::NAN,
    }
}
