//! What remains when no effect explains it: forces as a map of what they depend on.

use super::fit::Target;
use super::model::SearchError;
use super::model::{Case, Segment};
use super::settle::{Question, Settled, settle};
use crate::effects::{DependsOn, Map, Motion, Setting};
use crate::mechanism::{Command, Commands};
use nalgebra::{DMatrix, DVector};

/// A map that describes what remains.
#[derive(Clone, Debug)]
pub struct Described {
    /// The map, as an effect.
    pub effect: Setting,
    /// Share of what was above noise on the held-out segments that it removes, 0…1.
    pub share: f64,
    /// The same of every class, the best first.
    pub others: Vec<(DependsOn, f64)>,
}

/// Ridges that are tried, as shares of the mean square of a column.
const RIDGES: [f64; 5] = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// The map that removes most of a model's residual on data that it was not fitted on.
pub fn describe(
    case: &Case,
    question: &Question,
    model: &Settled,
) -> Result<Option<Described>, SearchError> {
    let baseline = &model.baseline;
    let target = Target { case, baseline, on: question.on, fixed: &[], blind: None };
    let effects = &model.fit.effects;
    let held = Target { on: question.hold, ..target }.look(effects);
    let (Some(fitted), Some(held)) = (target.look(effects), held) else { return Ok(None) };
    let noise = held.white.len() as f64;
    let excess = (held.chi2 - noise).max(1.0);
    let mut found: Vec<(f64, Map)> = Vec::new();
    for depends_on in DependsOn::ALL {
        let empty = empty(case, question.on, depends_on);
        let [columns, held_columns] =
            [question.on, question.hold].map(|on| columns(case, &model.baseline, on, &empty));
        let normal = columns.transpose() * &columns;
        let rhs = -(columns.transpose() * &fitted.white);
        let size = normal.diagonal().mean();
        let best = RIDGES
            .into_iter()
            .filter_map(|ridge| {
                let diagonal = DMatrix::identity(normal.nrows(), normal.ncols()) * (ridge * size);
                let weights: DVector<f64> = (&normal + diagonal).cholesky()?.solve(&rhs);
                let left = (&held.white + &held_columns * &weights).norm_squared();
                Some(((held.chi2 - left) / excess, weights))
            })
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((share, weights)) = best {
            let features = weights.len() / 3;
            let coefficients = weights.as_slice().chunks(features).map(<[f64]>::to_vec).collect();
            found.push((share, Map { coefficients, ..empty }));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let others = found.iter().map(|(share, map)| (map.depends_on, *share)).collect();
    let Some((share, map)) = found.into_iter().next() else { return Ok(None) };
    Ok(Some(Described { effect: Setting::unnamed(map), share: share.clamp(0.0, 1.0), others }))
}

/// The model with a map, its map fitted twice: the lens's fault depends on it.
///
/// # Errors
/// A machine that cannot be simulated.
pub fn settle_described(
    case: &Case,
    question: &Question,
    model: &Settled,
    described: &Described,
) -> Result<Settled, SearchError> {
    let effects = [model.fit.effects.as_slice(), std::slice::from_ref(&described.effect)].concat();
    settle(case, question, &effects, 1)
}

/// A map without coefficients over the range of the measured motion.
fn empty(case: &Case, on: &[Segment], depends_on: DependsOn) -> Map {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for segment in on {
        for row in segment.rows.clone() {
            let [pose, _] = case.runs[segment.run].lens.motion(row);
            for k in 0..3 {
                low[k] = low[k].min(pose[k]);
                high[k] = high[k].max(pose[k]);
            }
        }
    }
    let middle = [0, 1, 2].map(|k| 0.5 * (low[k] + high[k]));
    // A pose that does not vary has no scale of its own: a millimetre, a milliradian.
    let reach = [0, 1, 2].map(|k| (0.5 * (high[k] - low[k])).max(1e-3));
    Map { depends_on, middle, reach, coefficients: Vec::new() }
}

/// Change of the residual in units of noise by each coefficient, leg by leg: a force on a rod is force
/// that the drive need not give.
fn columns(
    case: &Case,
    baseline: &super::model::Baseline,
    on: &[Segment],
    map: &Map,
) -> DMatrix<f64> {
    // Features of each leg at each row of each run.
    let table: Vec<[Vec<Vec<f64>>; 3]> = case
        .runs
        .iter()
        .map(|run| {
            let mut commands = [Command::default(); 3];
            let mut legs = [const { Vec::new() }; 3];
            for row in 0..run.log.samples {
                run.commands.at(row as f64 * run.log.interval, &mut commands);
                let [pose, rate] = run.lens.motion(row);
                for (leg, rows) in legs.iter_mut().enumerate() {
                    let speed = run.lens.speed(row, leg);
                    rows.push(map.features(Motion { pose, rate }, &commands, speed));
                }
            }
            legs
        })
        .collect();
    let features = table[0][0][0].len();
    let columns: Vec<DVector<f64>> = (0..3)
        .flat_map(|leg| (0..features).map(move |k| (leg, k)))
        .map(|(leg, k)| {
            case.white_forces(baseline, on, &|run, of, row| {
                if of == leg { table[run][leg][row][k] } else { 0.0 }
            })
        })
        .collect();
    DMatrix::from_columns(&columns)
}
