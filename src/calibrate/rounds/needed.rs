//! What a model can do without.

use super::way::{name, names};
use crate::calibrate::values::model::{LegsCase, SearchError};
use crate::calibrate::values::settle::{
    FitData, GAIN_PER_VALUE, HOPEFUL, Settled, compared, refined,
};
use crate::effects::{CONTAINS, Setting};

/// The model without those effects that the others have made needless, and with effects that another
/// contains in place of that other where they do as well. What a model loses has to raise the misfit by
/// `threshold` to be kept.
///
/// # Errors
/// A machine that cannot be simulated.
pub fn needed(
    case: &LegsCase,
    question: &FitData,
    model: Settled,
    threshold: f64,
    tell: &(dyn Fn(&str) + Sync),
) -> Result<Settled, SearchError> {
    let mut best = model;
    let mut i = 0;
    while i < best.fit.effects.len() {
        let mut found = None;
        for less in lesser(&best.fit.effects, i) {
            tell(&format!("doing without {}: {}", name(&best.fit.effects[i]), names(&less)));
            let hopeful =
                best.held + HOPEFUL * best.baseline.places(case, question.hold).len() as f64;
            let hopeful = |less: &Settled| less.held < hopeful;
            let like = Some(&best.baseline);
            let model = compared(case, question, &less, like, hopeful)?;
            let model = refined(case, question, model)?;
            let values = count(&best.fit.effects) as f64 - count(&less) as f64;
            if model.misfit - best.misfit - GAIN_PER_VALUE * values < threshold {
                found = Some(model);
                break;
            }
        }
        match found {
            Some(model) => best = model,
            None => i += 1,
        }
    }
    Ok(best)
}

fn count(effects: &[Setting]) -> usize {
    effects.iter().map(|effect| effect.values().count()).sum()
}

/// The effects without one of them, unless it is the only one; and with what it contains in its place.
fn lesser(effects: &[Setting], which: usize) -> Vec<Vec<Setting>> {
    let effect = &effects[which];
    let mut lesser = Vec::new();
    if effects.len() > 1 {
        let others = effects.iter().enumerate().filter(|(i, _)| *i != which);
        lesser.push(others.map(|(_, effect)| effect.clone()).collect());
    }
    let inner = CONTAINS.iter().filter(|(outer, _)| outer.name == effect.kind.name);
    for (_, inner) in inner {
        let Some(names) = inner.variants.first() else { continue };
        let values: Vec<(&'static str, f64)> =
            names.iter().map(|name| (*name, effect.value(name).unwrap_or(0.0))).collect();
        let mut with = effects.to_vec();
        with[which] = Setting::on(inner, effect.target.clone(), &values);
        lesser.push(with);
    }
    lesser
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::named;

    #[test]
    fn a_model_can_lack_an_effect_or_be_what_it_contains() {
        let of = |kind: &str, joint, values: &[(&'static str, f64)]| {
            Setting::new(named(kind).unwrap(), joint, values)
        };
        let payload = of("payload", None, &[("mass_kg", 0.1)]);
        let values = [("coulomb_N", 3.0), ("static_N", 3.5), ("stribeck_m_s", 0.1)];
        let stribeck = of("stribeck-friction", Some("P3"), &values);
        let friction =
            of("actuator-friction", Some("P3"), &[("coulomb_N", 3.0), ("viscous_Ns_m", 0.0)]);
        assert!(stribeck.contains(&friction) && !friction.contains(&stribeck));
        assert!(!stribeck.contains(&payload));
        let both = [payload.clone(), stribeck.clone()];
        assert_eq!(lesser(&both, 0), [vec![stribeck.clone()]]);
        assert_eq!(lesser(&both, 1), [vec![payload.clone()], vec![payload, friction.clone()]]);
        assert_eq!(lesser(&[stribeck], 0), [vec![friction.clone()]]);
        assert!(lesser(&[friction], 0).is_empty());
    }
}
