//! What remains when no effect explains it: forces as a map of what they depend on.

use crate::calibrate::values::fit::LegsFitTarget;
use crate::calibrate::values::model::SearchError;
use crate::calibrate::values::model::{LegsCase, LegsSegment};
use crate::calibrate::values::ridge::{Regressed, ridged};
use crate::calibrate::values::settle::{FitData, Settled, settle};
use crate::effects::{DependsOn, Map, MapMotion, Setting};
use crate::measure::log::Channel;
use crate::mechanism::Command;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// A map that describes what remains.
#[derive(Clone, Debug)]
pub struct DescribedMap {
    /// The map, as an effect.
    pub effect: Setting,
    /// Share of what was above noise on the held-out segments that it removes, 0…1.
    pub share: f64,
    /// The same of every class, the best first.
    pub others: Vec<(DependsOn, f64)>,
}

/// How often a map is fitted anew, its model simulated in between: the lens's fault depends on it.
const PASSES: usize = 2;

/// The map that removes most of a model's residual on data that it was not fitted on, if it removes more
/// than `worth` of what stands above noise; and the model with it.
///
/// # Errors
/// A machine that cannot be simulated.
pub fn describe(
    case: &LegsCase,
    question: &FitData,
    model: &Settled,
    worth: f64,
) -> Result<Option<(DescribedMap, Settled)>, SearchError> {
    let mut last = None;
    let mut simulated = model.clone();
    let mut others = Vec::new();
    for pass in 0..PASSES {
        let maps = best_maps(case, question, model, &simulated, &others);
        if pass == 0 {
            others = maps.iter().map(|(share, map)| (map.depends_on, *share)).collect();
        }
        let Some((share, map)) = maps.into_iter().next().filter(|(share, _)| *share > worth) else {
            break;
        };
        let effect = Setting::unnamed(map);
        let effects = [model.fit.effects.as_slice(), std::slice::from_ref(&effect)].concat();
        simulated = settle(case, question, &effects, 1, Some(&model.baseline))?;
        let share = share.clamp(0.0, 1.0);
        last = Some((DescribedMap { effect, share, others: others.clone() }, simulated.clone()));
    }
    Ok(last)
}

/// The best map of each class, or of the first of `classes`, with the share that it removes; the best
/// class first. Bias and noise are those of `simulated`, the effects those of `model`.
fn best_maps(
    case: &LegsCase,
    question: &FitData,
    model: &Settled,
    simulated: &Settled,
    classes: &[(DependsOn, f64)],
) -> Vec<(f64, Map)> {
    let baseline = &simulated.baseline;
    let effects = &model.fit.effects;
    let on = LegsFitTarget { case, baseline, on: question.on, fixed: effects, blind: None };
    let hold = LegsFitTarget { on: question.hold, ..on };
    let (Some(fitted), Some(held)) = (on.look(&[]), hold.look(&[])) else { return Vec::new() };
    let classes: Vec<DependsOn> = match classes.first() {
        Some((class, _)) => vec![*class],
        None => DependsOn::ALL.to_vec(),
    };
    let mut found: Vec<(f64, Map)> = Vec::new();
    for depends_on in classes {
        let empty = empty(case, question.on, depends_on);
        let (Some(columns), Some(held_columns)) =
            (columns(&on, &fitted.white, &empty), columns(&hold, &held.white, &empty))
        else {
            continue;
        };
        let components = empty.components(3);
        let features = columns.ncols() / components;
        let fits = Regressed { columns: &columns, white: &fitted.white };
        let holds = Regressed { columns: &held_columns, white: &held.white };
        // Forces and torques have sizes of their own.
        if let Some((share, weights)) = ridged(fits, holds, components) {
            let coefficients = weights.as_slice().chunks(features).map(<[f64]>::to_vec).collect();
            found.push((share, Map { coefficients, ..empty }));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found
}

/// A map without coefficients over the range of the measured motion.
fn empty(case: &LegsCase, on: &[LegsSegment], depends_on: DependsOn) -> Map {
    let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 4];
    let mut widen = |k: usize, value: f64| {
        ranges[k] = [ranges[k][0].min(value), ranges[k][1].max(value)];
    };
    for segment in on {
        let run = &case.runs[segment.run];
        for row in segment.rows.clone() {
            let [pose, _] = run.lens.motion(row);
            (0..3).for_each(|k| widen(k, pose[k]));
            for leg in 0..3 {
                run.log.get(Channel::Length(leg)).into_iter().for_each(|q| widen(3, q[row]));
            }
        }
    }
    let middle = ranges.map(|[low, high]| 0.5 * (low + high));
    // A pose that does not vary has no scale of its own: a millimetre, a milliradian.
    let reach = ranges.map(|[low, high]| (0.5 * (high - low)).max(1e-3));
    Map {
        depends_on,
        middle: [0, 1, 2].map(|k| middle[k]),
        reach: [0, 1, 2].map(|k| reach[k]),
        lengths: [middle[3], reach[3]],
        coefficients: Vec::new(),
    }
}

/// Change of a target's residual by each coefficient of a map, component by component: it is linear in
/// them.
fn columns(target: &LegsFitTarget, white: &DVector<f64>, map: &Map) -> Option<DMatrix<f64>> {
    let origin = MapMotion::default();
    let features = map.features(origin, &[Command::default(); 3]).len();
    let components = map.components(3);
    let columns = (0..components * features).into_par_iter().map(|i| {
        let mut coefficients = vec![vec![0.0; features]; components];
        coefficients[i / features][i % features] = 1.0;
        let unit = Setting::unnamed(Map { coefficients, ..map.clone() });
        Some(target.look(&[unit])?.white - white)
    });
    Some(DMatrix::from_columns(&columns.collect::<Option<Vec<_>>>()?))
}
