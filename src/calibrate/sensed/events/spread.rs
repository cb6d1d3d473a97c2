//! How much the means of stretches scatter, where: a machine that moves fast misses more than one that creeps.

use super::series::{Series, means, scatter};
use nalgebra::{DMatrix, DVector};

/// Passes in which large values are cut off at [`CUT`] deviations, and sweeps of each solution.
const PASSES: usize = 5;
const SWEEPS: usize = 60;
/// See [`PASSES`].
const CUT: f64 = 3.0;

/// Largest correlation of two freedoms that is believed: robust estimates are wrong by some per cent.
const CORRELATED: f64 = 0.97;

/// What the variance of residuals may grow with: a constant, the squared rates and their square (centrifugal
/// terms), the squared accelerations, in units of their means.
pub fn grounds(series: &Series) -> Vec<Vec<f64>> {
    let count = series.count();
    let mut grounds = vec![vec![1.0; count]];
    let moving: Vec<_> = series.freedoms.iter().filter_map(|f| f.motion.as_ref()).collect();
    if moving.is_empty() {
        return grounds;
    }
    let squares = |k: usize| {
        let mut sum = vec![0.0; count];
        for motion in &moving {
            let mean = motion[k].iter().map(|v| v * v).sum::<f64>() / count as f64;
            let share = 1.0 / (mean.max(f64::MIN_POSITIVE) * moving.len() as f64);
            sum.iter_mut().zip(&motion[k]).for_each(|(sum, v)| *sum += share * v * v);
        }
        sum
    };
    let rates = squares(1);
    grounds.push(rates.iter().map(|v| v * v).collect());
    grounds.extend([rates, squares(2)]);
    grounds
}

/// Means over stretches of `width` instants in units of their deviation there, of one freedom.
pub fn scaled(cleared: &[f64], grounds: &[Vec<f64>], width: usize) -> Vec<f64> {
    let mean = means(cleared, width);
    let grounds: Vec<Vec<f64>> = grounds.iter().map(|ground| means(ground, width)).collect();
    let square: Vec<f64> = mean.iter().map(|m| m * m).collect();
    let usual = scatter(&mean).powi(2).max(f64::MIN_POSITIVE);
    let mut variance = vec![usual; mean.len()];
    for _ in 0..PASSES {
        let weights: Vec<f64> = variance.iter().map(|v| 1.0 / (v + usual).powi(2)).collect();
        let cut = |(s, v): (&f64, &f64)| s.min(CUT * CUT * v);
        let values: Vec<f64> = square.iter().zip(&variance).map(cut).collect();
        let shares = positive(&grounds, &values, &weights);
        for (row, variance) in variance.iter_mut().enumerate() {
            let sum: f64 = grounds.iter().zip(&shares).map(|(g, share)| g[row] * share).sum();
            // Nothing is known better than a hundredth of the usual.
            *variance = sum.max(1e-4 * usual);
        }
    }
    let units: Vec<f64> = mean.iter().zip(&variance).map(|(m, v)| m / v.sqrt()).collect();
    in_units(units)
}

fn in_units(mut values: Vec<f64>) -> Vec<f64> {
    let usual = scatter(&values).max(f64::MIN_POSITIVE);
    values.iter_mut().for_each(|value| *value /= usual);
    values
}

/// Weighted least squares in shares that are not negative, one coordinate after another.
fn positive(grounds: &[Vec<f64>], values: &[f64], weights: &[f64]) -> Vec<f64> {
    let dot = |a: &[f64], b: &[f64]| {
        a.iter().zip(b).zip(weights).map(|((a, b), w)| a * b * w).sum::<f64>()
    };
    let n = grounds.len();
    let normal = DMatrix::from_fn(n, n, |i, k| dot(&grounds[i], &grounds[k]));
    let rhs = DVector::from_fn(n, |i, _| dot(&grounds[i], values));
    let mut shares = DVector::zeros(n);
    for _ in 0..SWEEPS {
        for i in 0..n {
            let others = normal.row(i).dot(&shares.transpose()) - normal[(i, i)] * shares[i];
            let own = (rhs[i] - others) / normal[(i, i)].max(f64::MIN_POSITIVE);
            shares[i] = own.max(0.0);
        }
    }
    shares.as_slice().to_vec()
}

/// What each freedom shows by itself: of u with correlation matrix R, `(R⁻¹ u)ᵢ / √(R⁻¹)ᵢᵢ`, the best statistic
/// (least squares) of an effort in that joint alone.
pub fn apart(units: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = units.len();
    let correlation = |i: usize, k: usize| {
        if i == k {
            return 1.0;
        }
        let of = |sign: f64| {
            let sums = units[i].iter().zip(&units[k]).map(|(a, b)| a + sign * b);
            scatter(&sums.collect::<Vec<f64>>()).powi(2)
        };
        let [sum, difference] = [of(1.0), of(-1.0)];
        let total = (sum + difference).max(f64::MIN_POSITIVE);
        ((sum - difference) / total).clamp(-CORRELATED, CORRELATED)
    };
    let matrix = DMatrix::from_fn(n, n, correlation);
    // Pairs that are estimated one by one need not fit together.
    let Some(inverse) = matrix.cholesky().map(|factors| factors.inverse()) else {
        return units.to_vec();
    };
    let own = |i: usize| {
        let at = |row: usize| {
            let sum: f64 = (0..n).map(|k| inverse[(i, k)] * units[k][row]).sum();
            sum / inverse[(i, i)].sqrt()
        };
        in_units((0..units[i].len()).map(at).collect())
    };
    (0..n).map(own).collect()
}
