//! What remains when no effect explains it: efforts in the measured joints, or forces on the output, as a table of what they
//! depend on.

use super::central;
use super::table_fits::TableFits;
use crate::calibrate::sensed::recorded::view::position_sensor;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Segment, Split, Stopped};
use crate::calibrate::sensed::residuals::residual::{Name, ResidualKind};
use crate::calibrate::sensed::rounds::search::Search;
use crate::calibrate::sensed::thresholds::{TABLE, TABLE_PASSES};
use crate::calibrate::sensed::values::fit::FitTarget;
use crate::calibrate::sensed::values::model::Model;
use crate::calibrate::values::instrument::Replicated;
use crate::effects::{Efforts, Over, Setting};
use crate::mechanism::JointIndex;
use crate::report::number;

/// Coordinates of a body: its place and angle.
const PLANAR: usize = 3;

/// A table that stands in for what has no name.
#[derive(Clone, Debug)]
pub struct DescribedEfforts {
    /// The table, as an effect.
    pub effect: Setting,
    /// Share of what was above noise on data that it was not fitted to that it removes, 0…1.
    pub share: f64,
    /// The same of every class, in words, the best first.
    pub others: Vec<(&'static str, f64)>,
}

/// What an effect that is a table depends on, in words.
fn words(effect: &Setting) -> &'static str {
    let central = effect.central().map(|_| "the distance from a fixed place");
    let efforts = effect.efforts().map(|table| table.depends_on.words());
    central.or(efforts).unwrap_or("something unknown")
}

impl DescribedEfforts {
    /// What it depends on, in words.
    pub fn words(&self) -> &'static str {
        words(&self.effect)
    }

    /// What acts, in words.
    fn acts(&self) -> String {
        if let Some(central) = self.effect.central() {
            let point = central.point.as_deref().unwrap_or("the output");
            let [x, y] = central.place.map(number);
            return format!("forces on {point} along the line to ({x}, {y}) m");
        }
        let on_output = |table: &Efforts| table.depends_on.acts_on_output();
        if self.effect.efforts().is_some_and(on_output) { "forces" } else { "efforts" }.to_owned()
    }

    /// What speaks for it.
    pub fn evidence(&self) -> String {
        let others = self
            .others
            .iter()
            .skip(1)
            .map(|(words, share)| format!("{words} {:.0} %", 100.0 * share.clamp(0.0, 1.0)));
        let others: Vec<String> = others.collect();
        format!(
            "{} that vary with {} remove {:.0} % of what stands above noise on data that they were not \
             fitted to ({})",
            self.acts(),
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
    let mut others: Vec<(&'static str, f64)> = Vec::new();
    for _ in 0..TABLE_PASSES {
        let before = last.as_ref().map_or(model, |(_, tabled)| tabled);
        let known = last.as_ref().map(|(described, _)| &described.effect);
        let tables = best_tables(search, &model.fit.effects, before, known);
        if others.is_empty() {
            others = tables.iter().map(|(share, table)| (words(table), *share)).collect();
        }
        let least = if last.is_none() { TABLE } else { 0.0 };
        let best = tables.into_iter().next();
        let Some((share, effect)) = best.filter(|(share, _)| *share > least) else { break };
        let effects = [model.fit.effects.as_slice(), std::slice::from_ref(&effect)].concat();
        let Some(settled) = search.settle(&effects, 1)? else { break };
        // A table that only fits one run's rattle better is no better on others.
        if last.as_ref().is_some_and(|(_, tabled)| tabled.misfit <= settled.misfit) {
            break;
        }
        // What chance adds to all of it is not more than all.
        let share = share.clamp(0.0, 1.0);
        last = Some((DescribedEfforts { effect, share, others: others.clone() }, settled));
    }
    Ok(last)
}

/// The best table of each class beside effects, or of that of a known one, with the share that it removes, the best first; what
/// a look is wrong by as a model shows it.
fn best_tables(
    search: &Search,
    effects: &[Setting],
    model: &Model,
    known: Option<&Setting>,
) -> Vec<(f64, Setting)> {
    let (problem, split) = (search.problem, search.split);
    let Some(joints) = joints_moved(problem, split, &search.names) else { return Vec::new() };
    let output = output_moved(problem, split, &joints);
    let one_freedom = joints.joints.len() < 2;
    let targets =
        [&split.on, &split.hold].map(|on| FitTarget { problem, baseline: &model.baseline, on });
    let Some(fits) = TableFits::of(targets, effects) else { return Vec::new() };
    let classes = match known.map(|known| known.efforts()) {
        Some(table) => table.map_or(Vec::new(), |table| vec![table.depends_on]),
        None => Over::ALL.to_vec(),
    };
    let mut found = tables(&fits, [Some(joints), output], &classes);
    // Of one freedom every place is passed again at the same distance: a table over its coordinate says as much.
    let central = known.and_then(|known| known.central());
    if (known.is_none() || central.is_some()) && !one_freedom {
        found.extend(central::pull(&fits, problem, split, central));
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found
}

/// The best table of each class over what moved, joints or the output, with the share that it removes of what stands above
/// noise in the data that is held back.
fn tables(
    fits: &TableFits<impl Replicated>,
    moved: [Option<MovedParts>; 2],
    classes: &[Over],
) -> Vec<(f64, Setting)> {
    let mut found = Vec::new();
    for depends_on in classes {
        let Some(moved) = &moved[usize::from(depends_on.acts_on_output())] else { continue };
        let MovedParts { joints, ranges, sizes } = moved;
        let empty = Efforts::empty(*depends_on, joints.clone(), ranges);
        let units = units(&empty, sizes);
        let features = units.len() / sizes.len();
        if let Some((share, weights)) = fits.regressed(&units, sizes.len()) {
            let part = |(weights, size): (&[f64], &f64)| weights.iter().map(|w| w * size).collect();
            let coefficients = weights.as_slice().chunks(features).zip(sizes).map(part).collect();
            found.push((share, Setting::unnamed_efforts(Efforts { coefficients, ..empty })));
        }
    }
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

/// A table with each coefficient alone, in units of `sizes`, joint by joint.
fn units(table: &Efforts, sizes: &[f64]) -> Vec<Setting> {
    let coordinates = table.coordinates();
    let still = vec![0.0; coordinates];
    let features = table.features(0, &table.middle, &still).len();
    let unit = |i: usize| {
        let mut coefficients = vec![vec![0.0; features]; coordinates];
        coefficients[i / features][i % features] = sizes[i / features];
        Setting::unnamed_efforts(Efforts { coefficients, ..table.clone() })
    };
    (0..coordinates * features).map(unit).collect()
}
