//! What a search on a drive stage comes to: effects and numbers of the rig with their intervals.

use super::judge::{BLOCK, CERTAIN, Judge};
use crate::calibrate::report::{ActsOn, EffectReport, Fitted};
use crate::calibrate::single::calibration::{Adjusted, Found, Ranked};
use crate::identify;
use crate::identify::inverse::{Model, Term};
use crate::identify::stage::{effects, lag, ripple};
use crate::scenario::{self, Scenario};

/// What is lacking where the drive is later than declared.
pub(super) const LAG: &str = "lag of the drive (drive.sampled.lag)";

/// What a model comes to beside a rig: the rig with it, and every number with its interval. `added` are
/// the kinds of effects that were found, each with what it rests on.
pub(super) fn found(
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
            on: ActsOn::of(&setting),
            depends_on: None,
            params: params.collect(),
            evidence,
            as_good: Vec::new(),
            equation: setting.kind.equation,
        }
    });
    let effects = reported.collect();
    let mass = match &rig.mechanism {
        scenario::Mechanism::DriveStage(stage) => stage.mass,
        _ => f64::NAN,
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
