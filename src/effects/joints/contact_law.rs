//! Hits that lose speed by another law than declared.

use crate::contact::ForceLaw;
use crate::contact::laws::{Loss, dissipation};
use crate::effects::{JointKinds, Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::{Bearing, Mechanism};
use std::sync::Arc;

/// The forms of a law's damping, one for each set of values.
const RESTITUTION: &str = "restitution";
const HYSTERESIS: &str = "hysteresis_s_m";
const VISCOUS: &str = "viscous_Ns_m";
const FADING: &str = "c_max_Ns_m";

/// The key beside the last.
const D_MAX_KEY: &str = "d_max_m";

/// Penetration in m over which a damping that fades in is complete where nothing is written: the default of `[contact]`.
const D_MAX: f64 = 1e-5;

/// How many values of each form a search starts from: hits that lose a twentieth more or less soon come at other instants.
const STARTS: usize = 19;

/// Shares of the speed that hits return in these, from hard to soft.
fn returned(i: usize) -> f64 {
    1.0 - (i + 1) as f64 / (STARTS + 1) as f64
}

/// Speed in m/s and time in s of a hit, and mass in kg, from which other forms get the same shares: a journal of the built-in
/// machine.
const HIT: (f64, f64, f64) = (0.1, 3e-4, 0.1);

const fn number(
    name: &'static str,
    unit: &'static str,
    about: &'static str,
    bounds: [f64; 2],
    step: f64,
) -> Parameter {
    Parameter { name, unit, about, bounds, step, default: None }
}

pub(in crate::effects) const KIND: Kind = Kind {
    name: "contact-law",
    summary: "hits of journals that lose speed by another law than declared, on the declared spring",
    equation: "force S(d) + c(d) rate, S the declared law's elastic force; one of: c = h S/impact_speed with h = 8 (1 - e)/(5 e) \
               (flores; the other laws by restitution are the same force at another e), c = 3/2 alpha S \
               (hunt-crossley), c constant, or c = c_max STEP(d) (hertz-step)",
    source: "P. Flores et al., Multibody Syst. Dyn. 25 (2011) 357-375; K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42 \
             (1975) 440-445; `freeplay laws`",
    trace: "how a machine goes on after hits of different speeds; nothing where a joint's load keeps it shut",
    targets: Targets::JointOrAll(JointKinds::Bearing),
    parameters: &[
        number(RESTITUTION, "", "e, the share of the speed that a hit returns", [0.01, 1.0], 1e-3),
        number(
            HYSTERESIS,
            "s/m",
            "alpha, the share of the speed that a hit loses, per m/s",
            [0.0, 100.0],
            1e-2,
        ),
        number(VISCOUS, "N s/m", "c, from the first touch on", [0.0, 1e6], 1.0),
        number(FADING, "N s/m", "c_max, reached at d_max_m", [0.0, 1e6], 1.0),
        Parameter {
            name: D_MAX_KEY,
            unit: "m",
            about: "penetration at which c_max is reached; where not given, 1e-5",
            bounds: [1e-9, 1e-2],
            step: 1e-8,
            default: None,
        },
    ],
    variants: &[&[RESTITUTION], &[HYSTERESIS], &[VISCOUS], &[FADING]],
    neutral: |_, _| Vec::new(),
    starts,
    scan: None,
    apply,
};

fn starts(_: &Mechanism, setting: &Setting) -> Vec<Vec<f64>> {
    let (speed, time, mass) = HIT;
    let variant: Vec<&str> = setting.values().map(|(name, _)| name).collect();
    let value = |e: f64| match variant[..] {
        [RESTITUTION] => Some(e),
        // e = 1 - alpha v.
        [HYSTERESIS] => Some((1.0 - e) / speed),
        // A spring and a damper in parallel: e = exp(-c T/(2 m)).
        [VISCOUS | FADING] => Some(-2.0 * mass / time * e.ln()),
        _ => None,
    };
    (0..STARTS).filter_map(|i| Some(vec![value(returned(i))?])).collect()
}

/// The loss that is written.
fn loss(setting: &Setting) -> Result<Loss, Wrong> {
    let forms = [
        setting.value(RESTITUTION).map(|e| Loss::Restitution(dissipation(e))),
        setting.value(HYSTERESIS).map(|alpha| Loss::Hysteresis(1.5 * alpha)),
        setting.value(VISCOUS).map(Loss::Viscous),
        setting.value(FADING).map(|c_max| {
            let d_max = setting.value(D_MAX_KEY).unwrap_or(D_MAX);
            Loss::Step { c_max, d_max }
        }),
    ];
    let given = |key: &str| setting.values().any(|(name, _)| name == key);
    let stray = given(D_MAX_KEY) && !given(FADING);
    match forms.into_iter().flatten().collect::<Vec<_>>().as_slice() {
        [_] if stray => Err(Wrong {
            key: D_MAX_KEY.to_owned(),
            message: format!("means nothing without {FADING}"),
            help: format!("take it out, or write {FADING}"),
        }),
        [loss] => Ok(*loss),
        given => Err(Wrong {
            key: "kind".to_owned(),
            message: format!("needs one law, and has {}", given.len()),
            help: format!("write one of {RESTITUTION}, {HYSTERESIS}, {VISCOUS} and {FADING}"),
        }),
    }
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let loss = loss(setting)?;
    let help = "take one of the laws that `freeplay laws` lists";
    change(setting, mechanism, help, |law| law.losing(loss))
}

/// Changes the laws of the joints with clearance that an effect is given; `help` is for a law that cannot be changed so.
pub(super) fn change(
    setting: &Setting,
    mechanism: &mut Mechanism,
    help: &str,
    changed: impl Fn(&dyn ForceLaw) -> Option<Arc<dyn ForceLaw>>,
) -> Result<(), Wrong> {
    let wrong = |message: &str, help: &str| Wrong {
        key: "kind".to_owned(),
        message: message.to_owned(),
        help: help.to_owned(),
    };
    for index in setting.revolutes(mechanism)? {
        match &mut mechanism.revolutes[index].bearing {
            Bearing::Ideal => {}
            Bearing::Native { .. } => {
                return Err(wrong(
                    "is not possible under contact.law = \"native\"",
                    "the physics engine's own contacts have native.damping_ratio",
                ));
            }
            Bearing::Clearance(clearance) => {
                clearance.law = changed(clearance.law.as_ref())
                    .ok_or_else(|| wrong("is not possible under this contact.law", help))?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::Target;

    fn of(values: &[(&'static str, f64)]) -> Result<Loss, Wrong> {
        loss(&Setting::new(&KIND, None, values))
    }

    #[test]
    fn one_law_is_written_and_nothing_that_belongs_to_another() {
        assert_eq!(of(&[(RESTITUTION, 0.5)]).unwrap(), Loss::Restitution(1.6));
        assert_eq!(of(&[(FADING, 250.0)]).unwrap(), Loss::Step { c_max: 250.0, d_max: D_MAX });
        let two = of(&[(RESTITUTION, 0.5), (VISCOUS, 10.0)]).unwrap_err();
        assert!(two.message.contains("has 2") && two.help.contains(HYSTERESIS), "{two:?}");
        assert!(of(&[]).unwrap_err().message.contains("has 0"));
        assert_eq!(of(&[(RESTITUTION, 0.5), (D_MAX_KEY, 1e-5)]).unwrap_err().key, D_MAX_KEY);
    }

    #[test]
    fn each_form_has_its_list() {
        let listed = |form| {
            let setting = Setting::on(&KIND, Target::Machine, &[(form, 0.0)]);
            starts(&Mechanism::free(Vec::new()), &setting)
        };
        for form in [RESTITUTION, HYSTERESIS, VISCOUS, FADING] {
            let listed = listed(form);
            assert_eq!(listed.len(), STARTS, "{form}");
            assert!(listed.iter().flatten().all(|value| *value > 0.0), "{form}");
        }
        assert_eq!(listed(D_MAX_KEY), Vec::<Vec<f64>>::new());
    }
}
