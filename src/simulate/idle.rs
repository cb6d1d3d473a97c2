//! Effects that change nothing.

use super::checks::Finding;
use crate::effects::{Parameter, Setting};
use crate::mechanism::Mechanism;
use crate::model::assemble;
use crate::scenario::Scenario;

/// Beginnings of the names of parameters that only say where, when or how fast what the others are the size of.
const SHAPES: [&str; 14] = [
    "phase",
    "frequency",
    "at_s",
    "per_turn",
    "pitch",
    "direction",
    "com_",
    "anchor_",
    "rest_length",
    "velocity",
    "speed",
    "presliding",
    "lobes",
    "stribeck",
];

/// Effects without a size, whose defaults change nothing on the machine as declared: a payload of no mass, a
/// frequency without an amplitude. (Who writes a zero, or varies from one, means it: [`neutral`] is for who asks.)
pub(super) fn findings(scenario: &Scenario, declared: &Mechanism) -> Vec<Finding> {
    let effects = scenario.effects.iter().enumerate();
    let idle =
        effects.filter(|(_, setting)| !has_size(setting) && changes_nothing(setting, declared));
    let found = idle.map(|(i, setting)| {
        let without = if setting.values().next().is_none() {
            "values".to_owned()
        } else {
            sizes(setting).collect::<Vec<_>>().join(" and no ")
        };
        let message = format!("{setting} has no {without}, and does nothing without");
        let names: Vec<&str> = setting.kind.parameters.iter().map(|p| p.name).collect();
        let help = format!("give it {}, or leave it out", names.join(", "));
        Finding::warning(scenario.problem(&format!("effect.{i}"), message, &help))
    });
    found.collect()
}

/// Effects whose values, as written, leave the machine as it is declared: told to who asks what a scenario says,
/// not in runs, whose sweeps begin at such values.
pub fn neutral(scenario: &Scenario) -> Vec<Finding> {
    let sized = scenario.effects.iter().enumerate().filter(|(_, setting)| has_size(setting));
    let sized: Vec<(usize, &Setting)> = sized.collect();
    if sized.is_empty() {
        return Vec::new();
    }
    let mut plain = scenario.clone();
    plain.effects.clear();
    let Ok(declared) = assemble(&plain) else { return Vec::new() };
    let idle = sized.iter().filter(|(_, setting)| changes_nothing(setting, &declared.mechanism));
    let found = idle.map(|(i, setting)| {
        let values: Vec<String> = setting
            .values()
            .filter(|(name, _)| sizes(setting).any(|size| size == *name))
            .map(|(name, value)| format!("{name} = {value}"))
            .collect();
        let message =
            format!("{setting} does nothing: with {} all is as declared", values.join(", "));
        Finding::warning(scenario.problem(
            &format!("effect.{i}"),
            message,
            "give it another value, or leave it out",
        ))
    });
    found.collect()
}

/// The parameters that say how large an effect is.
fn sizes(setting: &Setting) -> impl Iterator<Item = &'static str> {
    setting
        .kind
        .parameters
        .iter()
        .map(|p| p.name)
        .filter(|name| !SHAPES.iter().any(|shape| name.starts_with(shape)))
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
