//! What remains when no effect explains it: efforts or forces as a table of what they depend on.

use crate::calibrate::sensed::unnamed::{DescribedEfforts, MovedParts, spanned, tables};
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
    let rows = || {
        let of = |segment: &LegsSegment| {
            let run = &case.runs[segment.run];
            segment.rows.clone().map(move |row| (run, row))
        };
        on.iter().flat_map(of)
    };
    let part = |joints, ranges: Vec<[f64; 3]>| {
        let sizes = vec![1.0; ranges.len()];
        MovedParts { joints, ranges, sizes }
    };
    let (mut joints, mut lengths, mut pose) = (Vec::new(), Vec::new(), Vec::new());
    for channel in case.runs.iter().take(1).flat_map(|run| run.log.channels()) {
        match channel {
            Channel::Length(leg) => {
                joints.push(format!("P{}", leg + 1));
                lengths.push(spanned(rows().filter_map(|(run, row)| {
                    let q = run.log.get(channel)?;
                    Some([q[row], (q[row + 1] - q[row]) / run.log.interval])
                })));
            }
            Channel::Pose(k) => pose.push(spanned(rows().map(|(run, row)| {
                let [pose, rate] = run.lens.motion(row);
                [pose[k], rate[k]]
            }))),
            Channel::Command(_) | Channel::Force(_) => {}
        }
    }
    [part(joints, lengths), part(Vec::new(), pose)]
}
