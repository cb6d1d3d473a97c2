//! One linear step of values to what they explain, and what chance makes of it.

use super::by_chance::up_to;
use crate::calibrate::values::least_squares::Free;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Derivatives of the residual in units of noise on the data that values are fitted on and on those that they are judged
/// on, by the values of a model (the first `known`) and by those of a candidate.
pub(in crate::calibrate::sensed) struct Derivatives {
    /// On data for the fit.
    pub on: DMatrix<f64>,
    /// On data to judge on.
    pub hold: DMatrix<f64>,
    /// Columns of the model.
    pub known: usize,
}

/// A linear step: which columns move, by how much.
pub(in crate::calibrate::sensed) struct LinearStep {
    moving: Vec<usize>,
    /// Change of each value.
    pub change: DVector<f64>,
}

/// A hair of the diagonal, in units of columns of length one: what two columns do alike is shared by them.
const RIDGE: f64 = 1e-9;

/// Least squares with some of the columns of a matrix.
struct Normal {
    unit: DMatrix<f64>,
    scales: Vec<f64>,
    factor: Cholesky<f64, Dyn>,
}

impl Normal {
    fn of(matrix: &DMatrix<f64>, moving: &[usize]) -> Option<Self> {
        let part = matrix.select_columns(moving);
        let scales: Vec<f64> =
            part.column_iter().map(|c| c.norm().max(f64::MIN_POSITIVE)).collect();
        let unit = DMatrix::from_fn(part.nrows(), part.ncols(), |r, c| part[(r, c)] / scales[c]);
        let mut normal = unit.transpose() * &unit;
        for k in 0..normal.nrows() {
            normal[(k, k)] += RIDGE;
        }
        Some(Self { factor: normal.cholesky()?, unit, scales })
    }

    /// Changes of the values, in the order of the columns, that leave the least of a residual.
    fn solve(&self, residual: &DVector<f64>) -> DVector<f64> {
        let solved = self.factor.solve(&-(self.unit.tr_mul(residual)));
        DVector::from_fn(solved.len(), |k, _| solved[k] / self.scales[k])
    }
}

/// The step that leaves the least of a residual, by its derivatives, the first `known` of which are by values of a model,
/// from these `own` values of the candidate on: values that a bound holds stay there, and the others are solved for again.
pub(in crate::calibrate::sensed) fn step(
    derivatives: &DMatrix<f64>,
    known: usize,
    residual: &DVector<f64>,
    own: &[f64],
    free: &[Free],
) -> Option<LinearStep> {
    let count = derivatives.ncols();
    let mut moving: Vec<usize> = (0..count).collect();
    let mut change = DVector::zeros(count);
    for _ in 0..=own.len() {
        let solved = Normal::of(derivatives, &moving)?.solve(residual);
        change.fill(0.0);
        for (&c, solved) in moving.iter().zip(solved.iter()) {
            change[c] = *solved;
        }
        let leaving = moving.iter().position(|&c| {
            c >= known && {
                let [low, high] = free[c - known].bounds;
                !(low..=high).contains(&(own[c - known] + change[c]))
            }
        });
        let Some(leaving) = leaving else { break };
        moving.remove(leaving);
    }
    Some(LinearStep { moving, change })
}

/// The sum of squares that is left after one step along these columns, the first `known` of which are not bounded, and the
/// step.
pub(in crate::calibrate::sensed) fn stepped_along(
    columns: &[DVector<f64>],
    known: usize,
    left: &DVector<f64>,
    own: &[f64],
    free: &[Free],
) -> Option<(f64, DVector<f64>)> {
    if columns.is_empty() {
        return Some((left.norm_squared(), DVector::zeros(0)));
    }
    let columns = DMatrix::from_columns(columns);
    let change = step(&columns, known, left, own, free)?.change;
    Some(((left + &columns * &change).norm_squared(), change))
}

/// The sum of squares of what is `left` after one step of the coordinates from which a machine that nothing holds was let go, by
/// which `starts` are the derivatives.
pub(in crate::calibrate::sensed) fn remains(
    starts: &[DVector<f64>],
    left: &DVector<f64>,
) -> Option<f64> {
    Some(stepped_along(starts, starts.len(), left, &[], &[])?.0)
}

impl Derivatives {
    /// The largest drop of the sum of squares, on data to judge on, that such a step of the candidate's values brings in
    /// draws of noise (on both kinds of data): where joints rattle noise has more of some shapes than a covariance frequency
    /// by frequency knows, and a candidate of that shape fits it.
    pub fn chance(
        &self,
        step: &LinearStep,
        draws: &[[DVector<f64>; 2]],
        replicas: usize,
    ) -> Option<f64> {
        let model: Vec<usize> = (0..self.known).collect();
        let parts = [&model, &step.moving];
        let solvers = parts.map(|moving| Normal::of(&self.on, moving));
        let [Some(alone), Some(beside)] = solvers else { return None };
        let holds = parts.map(|moving| self.hold.select_columns(moving));
        let gain = |[on, hold]: &[DVector<f64>; 2]| {
            let [without, with] = [(&alone, &holds[0]), (&beside, &holds[1])]
                .map(|(solver, matrix)| (hold + matrix * solver.solve(on)).norm_squared());
            without - with
        };
        Some(up_to(&draws.iter().map(gain).collect::<Vec<f64>>(), replicas))
    }

    /// The largest drop of the sum of squares, on data to judge on, that values fitted to those bring in draws of noise
    /// beside values fitted to the others.
    pub fn refitted(&self, draws: &[[DVector<f64>; 2]], replicas: usize) -> Option<f64> {
        let all: Vec<usize> = (0..self.on.ncols()).collect();
        let [on, hold] = [&self.on, &self.hold].map(|matrix| Normal::of(matrix, &all));
        let (on, hold) = (on?, hold?);
        let drop = |[first, other]: &[DVector<f64>; 2]| {
            let [before, after] = [on.solve(first), hold.solve(other)]
                .map(|change| (other + &self.hold * change).norm_squared());
            before - after
        };
        Some(up_to(&draws.iter().map(drop).collect::<Vec<f64>>(), replicas))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// Of white noise a candidate gains next to nothing; of draws that all hold some of its shape, with any sign, as much as
    /// that shape has in them.
    #[test]
    fn chance_knows_shapes_that_draws_have_in_common() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut white = || {
            DVector::from_fn(200, |_, _| Distribution::<f64>::sample(&StandardNormal, &mut random))
        };
        let shape = DMatrix::from_fn(200, 1, |r, _| (r as f64 * 0.1).sin() / 10.0);
        let columns = Derivatives { on: shape.clone(), hold: shape.clone(), known: 0 };
        let plain: Vec<[DVector<f64>; 2]> = (0..16).map(|_| [white(), white()]).collect();
        let shaped: Vec<[DVector<f64>; 2]> = (0..16)
            .map(|draw| {
                let size = if draw % 2 == 0 { 20.0 } else { -20.0 };
                [white(), white()].map(|noise| noise + shape.column(0) * size)
            })
            .collect();
        let free = [Free { step: 1.0, bounds: [-1e3, 1e3] }];
        let step = step(&shape, 0, &white(), &[0.0], &free).unwrap();
        let [plain, shaped] =
            [plain, shaped].map(|draws| columns.chance(&step, &draws, 1).unwrap());
        assert!((0.0..15.0).contains(&plain), "{plain}");
        assert!((350.0..800.0).contains(&shaped), "{shaped}");
    }

    /// A value at its bound stays there, and the others make the best of it.
    #[test]
    fn a_step_keeps_within_bounds() {
        let on = DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
        let free =
            [Free { step: 1.0, bounds: [0.0, 9.0] }, Free { step: 1.0, bounds: [-9.0, 9.0] }];
        let left = DVector::from_vec(vec![2.0, 1.0, 0.0]);
        let change = step(&on, 0, &left, &[0.0, 0.0], &free).unwrap().change;
        assert!(change[0] == 0.0 && (change[1] + 0.5).abs() < 1e-6, "{change}");
    }
}
