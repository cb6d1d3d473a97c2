//! What remains when no effect explains it: efforts or forces as a table of what they depend on.

use crate::calibrate::sensed::unnamed::{DescribedEfforts, MovedParts, tables};
use crate::calibrate::values::fit::LegsFitTarget;
use crate::calibrate::values::model::SearchError;
use crate::calibrate::values::model::{LegsCase, LegsSegment};
use crate::calibrate::values::settle::{FitData, Settled, settle};
use crate::effects::{Efforts, Over, Setting};
use crate::measure::log::Channel;

/// How often a table is fitted anew, its model simulated in between: the lens's fault depends on it.
const PASSES: usize = 2;

/// The table that removes most of a model's residual on data that it was not fitted on, if it removes more
/// than `worth` of what stands above noise; and the model with it.
///
/// # Errors
/// A machine that cannot be simulated.
pub fn describe(
    case: &LegsCase,
    question: &FitData,
    model: &Settled,
    worth: f64,
) -> Result<Option<(DescribedEfforts, Settled)>, SearchError> {
    let mut last = None;
    let mut simulated = model.clone();
    let mut others: Vec<(Over, f64)> = Vec::new();
    for _ in 0..PASSES {
        let classes = others.first().map_or(Over::ALL.to_vec(), |(best, _)| vec![*best]);
        let found = best_tables(case, question, model, &simulated, &classes);
        if others.is_empty() {
            others = found.iter().map(|(share, table)| (table.depends_on, *share)).collect();
        }
        let Some((share, table)) = found.into_iter().next().filter(|(share, _)| *share > worth)
        else {
            break;
        };
        let effect = Setting::unnamed_efforts(table);
        let effects = [model.fit.effects.as_slice(), std::slice::from_ref(&effect)].concat();
        simulated = settle(case, question, &effects, 1, Some(&model.baseline))?;
        let share = share.clamp(0.0, 1.0);
        last =
            Some((DescribedEfforts { effect, share, others: others.clone() }, simulated.clone()));
    }
    Ok(last)
}

/// The best table of each class. Bias and noise are those of `simulated`, the effects those of `model`.
fn best_tables(
    case: &LegsCase,
    question: &FitData,
    model: &Settled,
    simulated: &Settled,
    classes: &[Over],
) -> Vec<(f64, Efforts)> {
    let baseline = &simulated.baseline;
    let targets = [question.on, question.hold].map(|on| LegsFitTarget {
        case,
        baseline,
        on,
        fixed: &[],
        blind: None,
    });
    tables(targets, &model.fit.effects, moved(case, question.on).map(Some), classes)
}

/// How far the actuators and the platform moved; efforts are in N, torques on the platform in N·m.
fn moved(case: &LegsCase, on: &[LegsSegment]) -> [MovedParts; 2] {
    let mut ends = [[f64::INFINITY, f64::NEG_INFINITY, 0.0]; 6];
    let mut widen = |k: usize, value: f64, rate: f64| {
        let [low, high, fastest] = ends[k];
        ends[k] = [low.min(value), high.max(value), fastest.max(rate.abs())];
    };
    for segment in on {
        let run = &case.runs[segment.run];
        for row in segment.rows.clone() {
            let [pose, rate] = run.lens.motion(row);
            (0..3).for_each(|k| widen(3 + k, pose[k], rate[k]));
            for leg in 0..3 {
                let Some(q) = run.log.get(Channel::Length(leg)) else { continue };
                widen(leg, q[row], (q[row + 1] - q[row]) / run.log.interval);
            }
        }
    }
    let ranges = ends.map(|[low, high, rate]| [0.5 * (low + high), 0.5 * (high - low), rate]);
    let (legs, pose) = ranges.split_at(3);
    let joints = (1..=3).map(|leg| format!("P{leg}")).collect();
    let part = |joints, ranges: &[[f64; 3]]| MovedParts {
        joints,
        ranges: ranges.to_vec(),
        sizes: vec![1.0; 3],
    };
    [part(joints, legs), part(Vec::new(), pose)]
}
