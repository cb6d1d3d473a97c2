//! What the force of a drive stage may be made of: the terms that a rig declares, and those that may be
//! added to them.

use crate::effects::{Range as Tried, Setting, named};
use crate::identify::inverse::Term;
use crate::scenario::Scenario;

/// Speeds in m/s that are tried for friction that builds up or falls: from a hundredth of working speeds
/// to a good share of them.
const SPEEDS: [f64; 9] = [2e-3, 4e-3, 6e-3, 8e-3, 1e-2, 1.4e-2, 2e-2, 3e-2, 5e-2];

/// What may be added to a model: the effect, its form in words, and the terms.
pub(super) struct Candidate {
    pub kind: &'static str,
    pub what: String,
    pub terms: Vec<Term>,
}

/// Terms of the force that a declared effect stands for.
pub(super) fn terms_of(effect: &Setting) -> Option<Vec<Term>> {
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
pub(super) fn declared(rig: &Scenario) -> Vec<Term> {
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
pub(super) fn candidates(terms: &[Term], without: &[&str]) -> Vec<Candidate> {
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

/// Kinds of effects by the terms that they add to what is declared.
pub(super) fn kind_of(term: &Term) -> Option<&'static str> {
    match term {
        Term::Coulomb | Term::Offset | Term::CoulombWay(_) => Some("actuator-friction"),
        Term::Film(_) => Some("film-friction"),
        Term::Stribeck(_) => Some("stribeck-friction"),
        Term::Drag => Some("air-drag"),
        Term::Ripple(..) => Some("screw-ripple"),
        Term::Mass | Term::Lag | Term::Viscous | Term::ViscousWay(_) => None,
    }
}
