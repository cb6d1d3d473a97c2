//! What holds for every effect: neutral values change nothing, and what is said of it fits together.

use super::common::{LIVELY, assembled, history};
use freeplay::effects::{ALL, Setting};
use freeplay::mechanism::Mechanism;

/// Every effect, each of its variants, on each sort of joint that it can be given.
fn settings(mechanism: &Mechanism) -> Vec<Setting> {
    let mut settings = Vec::new();
    for &kind in ALL {
        let targets = kind.targets_of(mechanism);
        for target in [targets.first(), targets.last()].into_iter().flatten() {
            for variant in kind.variants_of(mechanism, target) {
                settings.extend(Setting::neutral(kind, target.clone(), variant, mechanism));
            }
        }
    }
    settings
}

#[test]
fn at_its_neutral_values_an_effect_changes_nothing() {
    for sets in [["drive.mode=servo"], ["drive.mode=prescribed"]] {
        let mut machine = assembled(LIVELY, &sets);
        machine.mechanism.close(0.0).unwrap();
        let plain = history(&machine.mechanism, machine.control, 0.01);
        for setting in settings(&machine.mechanism) {
            let mut mechanism = machine.mechanism.clone();
            setting.apply(&mut mechanism).unwrap_or_else(|e| panic!("{setting:?}: {e:?}"));
            mechanism.close(0.0).unwrap();
            let changed = history(&mechanism, machine.control, 0.01);
            let off = plain.iter().zip(&changed).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
            assert!(
                off < 1e-8,
                "{} {:?}: {off:e}",
                setting.kind.name,
                setting.values().collect::<Vec<_>>()
            );
        }
    }
}

#[test]
fn what_is_said_of_an_effect_fits_together() {
    let mechanism = assembled(LIVELY, &[]).mechanism;
    for kind in ALL {
        assert_eq!(ALL.iter().filter(|other| other.name == kind.name).count(), 1);
        let inside = |name: &str, value: f64| {
            let p = kind.parameter(name).unwrap_or_else(|| panic!("{}: {name}", kind.name));
            (p.bounds[0]..=p.bounds[1]).contains(&value)
        };
        for parameter in kind.parameters {
            assert!(
                parameter.default.is_none_or(|d| inside(parameter.name, d)),
                "{}",
                parameter.name
            );
            assert!(parameter.step > 0.0 && parameter.bounds[0] < parameter.bounds[1]);
        }
        for target in kind.targets_of(&mechanism) {
            for variant in kind.variants_of(&mechanism, &target) {
                let zeros: Vec<_> = variant.iter().map(|name| (*name, 0.0)).collect();
                let starts = Setting::on(kind, target.clone(), &zeros).starts(&mechanism);
                for start in starts {
                    assert_eq!(start.len(), variant.len(), "{}", kind.name);
                    let fits = variant.iter().zip(&start).all(|(name, value)| inside(name, *value));
                    assert!(fits, "{}: {start:?}", kind.name);
                }
            }
        }
    }
    for setting in settings(&mechanism) {
        for (name, value) in setting.values() {
            let [low, high] = setting.kind.parameter(name).unwrap().bounds;
            assert!((low..=high).contains(&value), "{} {name} = {value}", setting.kind.name);
        }
    }
}
