//! Laws of contact other than the declared one: effects without a value at which they change nothing, so that no derivative
//! says which way they are. Whole simulations at a list of values do.

use crate::calibrate::sensed::thresholds::NEAR;
use crate::calibrate::sensed::values::linear::remains;
use crate::calibrate::sensed::values::whole::Whole;
use crate::effects::{ALL, Setting};
use crate::mechanism::Mechanism;
use nalgebra::DVector;
use rayon::prelude::*;

/// Forms of the law that are fitted to whole simulations: a wrong one may do as well at one value as the right one beside its
/// own.
const FITTED: usize = 3;

/// How often the distance between two starts of a form is halved to come nearer: down to a thousandth of it, from where what
/// is left is smooth enough for derivatives.
const HALVED: usize = 10;

/// The best value of each form that explains more than `least`, those that explain most: beside `own` effects, of which this
/// is `left`, less what other coordinates to let the machine go from make up for, by which `starts` are the derivatives.
pub(super) fn other_laws(
    whole: &Whole,
    mechanism: &Mechanism,
    own: &[Setting],
    (starts, left): (&[DVector<f64>], &DVector<f64>),
    least: f64,
) -> Vec<Setting> {
    let Some(before) = remains(starts, left) else { return Vec::new() };
    let gain = |start: &Setting| {
        let with = whole.look(&[own, std::slice::from_ref(start)].concat())?;
        Some((before - remains(starts, &with)?, start.clone()))
    };
    let fresh = |form: &&Vec<Setting>| !own.iter().any(|effect| effect.is(&form[0]));
    let more = |a: &(f64, Setting), b: &(f64, Setting)| b.0.total_cmp(&a.0);
    let best = |form: &Vec<Setting>| {
        let mut tried: Vec<(f64, Setting)> = form.par_iter().filter_map(gain).collect();
        tried.sort_by(more);
        let first = tried.first()?.clone();
        (first.0 > least).then(|| nearer(first, form, &gain))
    };
    let mut found: Vec<(f64, Setting)> =
        without_neutral(mechanism).iter().filter(fresh).filter_map(best).collect();
    found.sort_by(more);
    let most = found.first().map_or(0.0, |(gain, _)| *gain);
    found.retain(|(gain, _)| *gain >= NEAR * most);
    found.into_iter().take(FITTED).map(|(_, start)| start).collect()
}

/// The best of these starts, of which the first value is moved to where it explains more, by ever smaller steps from half the
/// distance to the next start on.
fn nearer(
    (mut most, mut best): (f64, Setting),
    form: &[Setting],
    gain: &(dyn Fn(&Setting) -> Option<(f64, Setting)> + Sync),
) -> (f64, Setting) {
    let first = |start: &Setting| start.values().next().map_or(0.0, |(_, value)| value);
    let distances = form.iter().map(|other| (first(other) - first(&best)).abs());
    let mut step = 0.5 * distances.filter(|far| *far > 0.0).fold(f64::INFINITY, f64::min);
    for _ in 0..HALVED {
        let aside = [-step, step].map(|step| best.with(&[first(&best) + step]));
        let tried: Vec<_> = aside.par_iter().filter_map(gain).collect();
        for (gain, there) in tried {
            if gain > most {
                (most, best) = (gain, there);
            }
        }
        step *= 0.5;
    }
    (most, best)
}

/// Effects without a neutral value, on everything that they can act on at once, form by form at each of their starts: laws of
/// contact.
fn without_neutral(mechanism: &Mechanism) -> Vec<Vec<Setting>> {
    let mut all = Vec::new();
    for kind in ALL.iter().filter(|kind| kind.lasts() && kind.scan.is_none()) {
        let Some(target) = kind.targets_of(mechanism).pop() else { continue };
        for variant in kind.variants_of(mechanism, &target) {
            if Setting::neutral(kind, target.clone(), variant, mechanism).is_some() {
                continue;
            }
            let values: Vec<_> = variant.iter().map(|name| (*name, 0.0)).collect();
            let setting = Setting::on(kind, target.clone(), &values);
            let starts = setting.starts(mechanism);
            let form: Vec<Setting> = starts.iter().map(|start| setting.with(start)).collect();
            all.extend((!form.is_empty()).then_some(form));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Target, named};

    #[test]
    fn a_value_between_two_starts_is_come_near() {
        let kind = named("contact-law").unwrap();
        let with = |e: f64| Setting::on(kind, Target::Machine, &[("restitution", e)]);
        let form: Vec<Setting> = (1..20).map(|i| with(f64::from(i) / 20.0)).collect();
        let value = |start: &Setting| start.values().next().unwrap().1;
        let gain = |start: &Setting| Some((-(value(start) - 0.4371).abs(), start.clone()));
        let (most, best) = nearer(gain(&form[8]).unwrap(), &form, &gain);
        assert!((value(&best) - 0.4371).abs() < 1e-4 && most > -1e-4, "{best} {most}");
    }
}
