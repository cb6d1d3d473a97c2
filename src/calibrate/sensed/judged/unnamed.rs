//! What remains when no effect explains it: efforts in the measured joints, or forces on the output, as a table of what they
//! depend on.

use crate::calibrate::sensed::recorded::view::position_sensor;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Segment, Split, Stopped};
use crate::calibrate::sensed::residuals::residual::{Name, ResidualKind};
use crate::calibrate::sensed::rounds::search::Search;
use crate::calibrate::sensed::thresholds::{TABLE, TABLE_PASSES};
use crate::calibrate::sensed::values::fit::FitTarget;
use crate::calibrate::sensed::values::model::Model;
use crate::calibrate::values::instrument::Replicated;
use crate::calibrate::values::normal::{Regressed, ridged};
use crate::effects::{Efforts, Over, Setting};
use crate::mechanism::JointIndex;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Coordinates of a body: its place and angle.
const PLANAR: usize = 3;

/// A table that stands in for what has no name.
#[derive(Clone, Debug)]
pub struct DescribedEfforts {
    /// The table, as an effect.
    pub effect: Setting,
    /// Share of what was above noise on data that it was not fitted to that it removes, 0…1.
    pub share: f64,
    /// The same of every class, the best first.
    pub others: Vec<(Over, f64)>,
}

impl DescribedEfforts {
    /// What it depends on, in words.
    pub fn words(&self) -> &'static str {
        self.effect.efforts().map_or("something unknown", |table| table.depends_on.words())
    }

    /// Whether it acts on the output, rather than on each joint.
    pub fn acts_on_output(&self) -> bool {
        self.effect.efforts().is_some_and(|table| table.depends_on.acts_on_output())
    }

    /// What speaks for it.
    pub fn evidence(&self) -> String {
        let others = self.others.iter().skip(1).map(|(over, share)| {
            format!("{} {:.0} %", over.words(), 100.0 * share.clamp(0.0, 1.0))
        });
        let others: Vec<String> = others.collect();
        format!(
            "{} that vary with {} remove {:.0} % of what stands above noise on data that they were not \
             fitted to ({})",
            if self.acts_on_output() { "forces" } else { "efforts" },
            self.words(),
            100.0 * self.share,
            others.join(", ")
        )
    }
}

/// The table that removes most of a model's residuals on data that it was not fitted to, and the model with it;
/// none where none removes more than [`TABLE`] of what stands above noise.
///
/// # Errors
/// A machine that cannot be simulated.
pub fn describe(
    search: &Search,
    model: &Model,
) -> Result<Option<(DescribedEfforts, Model)>, Stopped> {
    let mut last: Option<(DescribedEfforts, Model)> = None;
    let mut others: Vec<(Over, f64)> = Vec::new();
    let mut left = 1.0;
    for _ in 0..TABLE_PASSES {
        let before = last.as_ref().map_or(model, |(_, tabled)| tabled);
        let classes = others.first().map_or(Over::ALL.to_vec(), |(best, _)| vec![*best]);
        let tables = best_tables(search, before, &classes);
        if others.is_empty() {
            others = tables.iter().map(|(share, table)| (table.depends_on, *share)).collect();
        }
        let least = if last.is_none() { TABLE } else { 0.0 };
        let Some((share, mut table)) =
            tables.into_iter().next().filter(|(share, _)| *share > least)
        else {
            break;
        };
        if let Some(known) = last.as_ref().and_then(|(described, _)| described.effect.efforts()) {
            let pairs =
                table.coefficients.iter_mut().flatten().zip(known.coefficients.iter().flatten());
            pairs.for_each(|(own, known)| *own += known);
        }
        let effect = Setting::unnamed_efforts(table);
        let effects = [model.fit.effects.as_slice(), std::slice::from_ref(&effect)].concat();
        let Some(settled) = search.settle(&effects, 1)? else { break };
        // What a table adds to that only fits one run's rattle is no better on others.
        if last.as_ref().is_some_and(|(_, tabled)| tabled.misfit <= settled.misfit) {
            break;
        }
        left *= (1.0 - share).clamp(0.0, 1.0);
        last =
            Some((DescribedEfforts { effect, share: 1.0 - left, others: others.clone() }, settled));
    }
    Ok(last)
}

/// The best table of each class beside a model with the share that it removes, the best first.
fn best_tables(search: &Search, model: &Model, classes: &[Over]) -> Vec<(f64, Efforts)> {
    let (problem, split) = (search.problem, search.split);
    let targets =
        [&split.on, &split.hold].map(|on| FitTarget { problem, baseline: &model.baseline, on });
    let Some(joints) = joints_moved(problem, split, &search.names) else { return Vec::new() };
    let output = output_moved(problem, split, &joints);
    tables(targets, &model.fit.effects, [Some(joints), output], classes)
}

/// The best table of each class over what moved, joints or the output, with the share that it removes of what stands above
/// noise in the second target when fitted to the first, the best first.
fn tables(
    [on, hold]: [impl Replicated; 2],
    effects: &[Setting],
    moved: [Option<MovedParts>; 2],
    classes: &[Over],
) -> Vec<(f64, Efforts)> {
    let (Some(fitted), Some(held)) = (on.white(effects), hold.white(effects)) else {
        return Vec::new();
    };
    let mut found: Vec<(f64, Efforts)> = Vec::new();
    for depends_on in classes {
        let Some(moved) = &moved[usize::from(depends_on.acts_on_output())] else { continue };
        let MovedParts { joints, ranges, sizes } = moved;
        let empty = Efforts::empty(*depends_on, joints.clone(), ranges);
        let [Some(columns), Some(held_columns)] = [
            columns(&on, effects, &fitted, &empty, sizes),
            columns(&hold, effects, &held, &empty, sizes),
        ] else {
            continue;
        };
        let features = columns.ncols() / sizes.len();
        let fits = Regressed { columns: &columns, white: &fitted };
        let holds = Regressed { columns: &held_columns, white: &held };
        if let Some((share, weights)) = ridged(fits, holds, sizes.len()) {
            let part = |(weights, size): (&[f64], &f64)| weights.iter().map(|w| w * size).collect();
            let coefficients = weights.as_slice().chunks(features).zip(sizes).map(part).collect();
            found.push((share, Efforts { coefficients, ..empty }));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found
}

/// What moved in the data that is fitted to.
struct MovedParts {
    /// Joints whose coordinates these are; none of the output's.
    pub joints: Vec<String>,
    /// Middle, half range and largest rate of each coordinate.
    pub ranges: Vec<[f64; 3]>,
    /// Size of what is left along each, as an effort.
    pub sizes: Vec<f64>,
}

/// Joints whose efforts are looked at.
fn joints_moved(problem: &RigProblem, split: &Split, names: &[Name]) -> Option<MovedParts> {
    let dynamics: Vec<usize> =
        (0..names.len()).filter(|&i| names[i].kind == ResidualKind::Dynamics).collect();
    let joints: Vec<String> = dynamics.iter().map(|&i| names[i].of.clone()).collect();
    let named = |name: &str| problem.declared.joints().find(|(known, _)| *known == name);
    let mut ranges = Vec::new();
    let mut sizes = Vec::new();
    for (name, residual) in joints.iter().zip(&dynamics) {
        let (_, joint) = named(name)?;
        ranges.push(range(problem, &split.on, joint)?);
        let first = split.on.first()?;
        let view = &problem.runs[first.run].view;
        let left = problem.residuals(view, &problem.declared, first)?;
        let values = &left.signals.get(*residual)?.values;
        let squares: f64 = values.iter().map(|value| value * value).sum();
        sizes.push((squares / values.len().max(1) as f64).sqrt().max(f64::MIN_POSITIVE));
    }
    (!joints.is_empty()).then_some(MovedParts { joints, ranges, sizes })
}

/// The output of a machine of more than two freedoms: with one or two its place follows from their coordinates, over all of
/// which there is a table.
fn output_moved(problem: &RigProblem, split: &Split, joints: &MovedParts) -> Option<MovedParts> {
    if joints.joints.len() < 3 {
        return None;
    }
    let machine = &problem.declared;
    let mut places = Vec::new();
    for segment in &split.on {
        let run = &problem.runs[segment.run].view;
        for pose in problem.poses(run, machine, segment)?.iter() {
            let output = machine.output_state(&pose.states(machine));
            places.push((output.position.push(pose.angles()[machine.output]), output.twist));
        }
    }
    let along = |k: usize| spanned(places.iter().map(|(place, rate)| [place[k], rate[k]]));
    let ranges = (0..PLANAR).map(along).collect();
    // A joint that turns takes a torque, for which a force acts at the distance of the machine's size.
    let length = machine.size();
    let as_force = |(name, size): (&String, &f64)| {
        let turns = |(known, joint): (&str, JointIndex)| {
            known == name && matches!(joint, JointIndex::Revolute(_))
        };
        if machine.joints().any(turns) { size / length } else { *size }
    };
    let force = joints.joints.iter().zip(&joints.sizes).map(as_force).fold(0.0, f64::max);
    let sizes = vec![force, force, force * length];
    Some(MovedParts { joints: Vec::new(), ranges, sizes })
}

/// Middle, half range and largest rate of a joint's coordinate as its own sensor shows it.
fn range(problem: &RigProblem, on: &[Segment], joint: JointIndex) -> Option<[f64; 3]> {
    let sensor = position_sensor(&problem.declared, joint)?;
    let mut motion = Vec::new();
    for segment in on {
        let view = &problem.runs[segment.run].view;
        let values = view.smooth(sensor)?.get(segment.rows.clone())?;
        motion.extend(values.windows(2).map(|pair| [pair[0], (pair[1] - pair[0]) / view.interval]));
    }
    let spanned = spanned(motion.into_iter());
    (spanned[1] > 0.0).then_some(spanned)
}

/// Middle, half range and largest rate of a coordinate with its rates.
fn spanned(motion: impl Iterator<Item = [f64; 2]>) -> [f64; 3] {
    let (mut low, mut high, mut fastest) = (f64::INFINITY, f64::NEG_INFINITY, 0.0f64);
    for [value, rate] in motion {
        (low, high) = (low.min(value), high.max(value));
        fastest = fastest.max(rate.abs());
    }
    [0.5 * (low + high), 0.5 * (high - low), fastest]
}

/// Change of a target's residual by each coefficient of a table in units of `sizes`, joint by joint: it is
/// linear in them.
fn columns(
    target: &impl Replicated,
    effects: &[Setting],
    white: &DVector<f64>,
    table: &Efforts,
    sizes: &[f64],
) -> Option<DMatrix<f64>> {
    let coordinates = table.coordinates();
    let still = vec![0.0; coordinates];
    let features = table.features(0, &table.middle, &still).len();
    let columns = (0..coordinates * features).into_par_iter().map(|i| {
        let mut coefficients = vec![vec![0.0; features]; coordinates];
        coefficients[i / features][i % features] = sizes[i / features];
        let unit = Setting::unnamed_efforts(Efforts { coefficients, ..table.clone() });
        Some(target.white(&[effects, &[unit]].concat())? - white)
    });
    Some(DMatrix::from_columns(&columns.collect::<Option<Vec<_>>>()?))
}
