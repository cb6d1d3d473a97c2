//! Effects that change nothing.

use super::finding::Finding;
use super::restraints;
use crate::effects::{Parameter, Setting};
use crate::mechanism::Mechanism;
use crate::model::assemble;
use crate::scenario::Scenario;

/// Effects without a size, whose defaults change nothing on the machine as declared: a payload of no mass, a
/// frequency without an amplitude. (Who writes a zero, or varies from one, means it: [`neutral`] is for who asks.)
pub(super) fn findings(scenario: &Scenario, declared: &Mechanism) -> Vec<Finding> {
    let effects = scenario.effects.iter().enumerate();
    let idle =
        effects.filter(|(_, setting)| forgotten(setting) && changes_nothing(setting, declared));
    idle.map(|(i, setting)| idle_effect(scenario, i, setting)).collect()
}

/// Effects and springs whose values, as written, leave the machine as it is declared: told to who asks what a
/// scenario says, not in runs, whose sweeps begin at such values.
pub fn neutral(scenario: &Scenario) -> Vec<Finding> {
    let mut found = restraints::idle(scenario);
    let effects = scenario.effects.iter().enumerate();
    let meant: Vec<(usize, &Setting)> =
        effects.filter(|(_, setting)| !forgotten(setting)).collect();
    if meant.is_empty() {
        return found;
    }
    let mut plain = scenario.clone();
    plain.effects.clear();
    if let Ok(declared) = assemble(&plain) {
        let idle =
            meant.iter().filter(|(_, setting)| changes_nothing(setting, &declared.mechanism));
        found.extend(idle.map(|(i, setting)| idle_effect(scenario, *i, setting)));
    }
    found
}

/// What is said of an effect that changes nothing.
fn idle_effect(scenario: &Scenario, place: usize, setting: &Setting) -> Finding {
    let message = if setting.values().next().is_none() {
        format!("{setting} has no values, and does nothing without")
    } else if !has_size(setting) {
        let without = sizes(setting).collect::<Vec<_>>().join(" and no ");
        format!("{setting} has no {without}, and does nothing without")
    } else {
        let given = setting.values().filter(|(name, _)| sizes(setting).any(|size| size == *name));
        let values: Vec<String> = given.map(|(name, value)| format!("{name} = {value}")).collect();
        format!("{setting} does nothing: with {} all is as declared", values.join(", "))
    };
    let help = if has_size(setting) {
        "give it another value, or leave it out".to_owned()
    } else {
        let names: Vec<&str> = setting.kind.parameters.iter().map(|p| p.name).collect();
        format!("give it {}, or leave it out", names.join(", "))
    };
    Finding::warning(scenario.problem(&format!("effect.{place}"), message, &help))
}

/// Whether an effect is given no size and has defaults for all; a kind without them takes what is declared.
fn forgotten(setting: &Setting) -> bool {
    !has_size(setting) && sizes(setting).all(|name| setting.value(name).is_some())
}

/// The parameters that say how large an effect is.
fn sizes(setting: &Setting) -> impl Iterator<Item = &'static str> {
    setting.kind.parameters.iter().filter(|p| !p.is_shape()).map(|p| p.name)
}

fn has_size(setting: &Setting) -> bool {
    setting.values().any(|(name, _)| sizes(setting).any(|size| size == name))
}

/// Whether every size of an effect is its kind's neutral one on this machine; what has no parameters, as an
/// effect without a name, is not known to.
fn changes_nothing(setting: &Setting, declared: &Mechanism) -> bool {
    let names: Vec<&'static str> =
        setting.kind.parameters.iter().map(|p: &Parameter| p.name).collect();
    let target = setting.target.clone();
    let Some(neutral) = Setting::neutral(setting.kind, target, &names, declared) else {
        return false;
    };
    // 1e-9 forgives rounding: a clearance is a difference of radii.
    let same = |name| match (setting.value(name), neutral.value(name)) {
        (Some(value), Some(neutral)) => (value - neutral).abs() <= 1e-9 * neutral.abs(),
        _ => true,
    };
    sizes(setting).next().is_some() && sizes(setting).all(same)
}
