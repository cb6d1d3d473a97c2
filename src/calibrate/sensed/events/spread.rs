//! How much the means of stretches scatter, where: a machine that moves fast misses more than one that creeps.

use super::series::{FreedomSeries, means, median, scatter};
use nalgebra::{DMatrix, DVector};

/// Passes in which large values are cut off at [`CUT`] deviations, and sweeps of each solution.
const PASSES: usize = 5;
const SWEEPS: usize = 60;
/// See [`PASSES`].
const CUT: f64 = 3.0;

/// Largest correlation of two freedoms that is believed: robust estimates are wrong by some per cent.
const CORRELATED: f64 = 0.97;

/// Share of the usual variance that there is at least anywhere: half the usual deviation. A choice, not a
/// measurement; it removed no false alarm by itself.
const LEAST: f64 = 0.25;

/// Deviations that the largest of a block is at least believed to reach: of two independent normal numbers it
/// exceeds 1 in half of all cases, of twenty 2.
const USUAL: f64 = 2.0;

/// What the variance of residuals may grow with: a constant, the squared rates and their square (centrifugal
/// terms), the squared accelerations, in units of `sizes`, the mean squares of rates and accelerations.
pub fn grounds(series: &FreedomSeries, sizes: &[[f64; 2]]) -> Vec<Vec<f64>> {
    let count = series.count();
    let mut grounds = vec![vec![1.0; count]];
    if sizes.is_empty() {
        return grounds;
    }
    let moving: Vec<_> = series.freedoms.iter().filter_map(|f| f.motion.as_ref()).collect();
    let squares = |k: usize| {
        let mut sum = vec![0.0; count];
        for (motion, size) in moving.iter().zip(sizes) {
            let share = 1.0 / (size[k - 1] * sizes.len() as f64);
            sum.iter_mut().zip(&motion[k]).for_each(|(sum, v)| *sum += share * v * v);
        }
        sum
    };
    let rates = squares(1);
    grounds.push(rates.iter().map(|v| v * v).collect());
    grounds.extend([rates, squares(2)]);
    grounds
}

/// Mean squares of the rates and accelerations of freedoms that are measured.
pub fn sizes(series: &FreedomSeries) -> Vec<[f64; 2]> {
    let moving = series.freedoms.iter().filter_map(|f| f.motion.as_ref());
    let mean = |values: &[f64]| {
        let squares: f64 = values.iter().map(|v| v * v).sum();
        (squares / values.len().max(1) as f64).max(f64::MIN_POSITIVE)
    };
    moving.map(|[_, rates, accelerations]| [mean(rates), mean(accelerations)]).collect()
}

/// By what means over stretches of one width are measured: how they scatter in a recording.
#[derive(Clone, Debug)]
pub struct Ruler {
    /// Instants in a stretch.
    pub width: usize,
    /// Freedom by freedom: what each ground adds to the variance, and the usual variance.
    shares: Vec<(Vec<f64>, f64)>,
    /// Inverse of the freedoms' correlation matrix.
    inverse: DMatrix<f64>,
    /// By freedom: scatter of what it shows by itself, and the largest that is usual in a block.
    apart: Vec<[f64; 2]>,
}

impl Ruler {
    /// Of a recording's cleared efforts; blocks are so many instants long.
    pub fn of(cleared: &[Vec<f64>], grounds: &[Vec<f64>], width: usize, block: usize) -> Self {
        let grounds = averaged(grounds, width);
        let n = cleared.len();
        let shares = cleared.iter().map(|own| shares(&means(own, width), &grounds)).collect();
        let (inverse, apart) = (DMatrix::identity(n, n), vec![[1.0, 1.0]; n]);
        let mut ruler = Self { width, shares, inverse, apart };
        let units = ruler.units(cleared, &grounds);
        for (share, own) in ruler.shares.iter_mut().zip(&units) {
            let scatter = scatter(own).max(f64::MIN_POSITIVE).powi(2);
            share.0.iter_mut().for_each(|share| *share *= scatter);
            share.1 *= scatter;
        }
        let units = ruler.units(cleared, &grounds);
        ruler.inverse = inverse_correlation(&units);
        let largest = |part: &[f64]| part.iter().fold(0.0f64, |max, v| max.max(v.abs()));
        for (f, own) in ruler.apart(&units).iter().enumerate() {
            let usual = scatter(own).max(f64::MIN_POSITIVE);
            let blocks = own.chunks_exact(block.max(width)).map(largest).collect();
            ruler.apart[f] = [usual, (median(blocks) / usual).max(USUAL)];
        }
        ruler
    }

    /// Of a recording, freedom by freedom: what belongs to it alone in deviations, by how far such goes now and then,
    /// and means in deviations.
    pub fn measure(&self, cleared: &[Vec<f64>], grounds: &[Vec<f64>]) -> Vec<MeasuredFreedom> {
        let units = self.units(cleared, &averaged(grounds, self.width));
        let apart = self.apart(&units);
        let own = |((mut own, units), [scatter, usual]): ((Vec<f64>, Vec<f64>), &[f64; 2])| {
            own.iter_mut().for_each(|value| *value /= scatter);
            MeasuredFreedom { deviations: own, usual: *usual, units }
        };
        apart.into_iter().zip(units).zip(&self.apart).map(own).collect()
    }

    fn units(&self, cleared: &[Vec<f64>], averaged: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let unit = |(own, (shares, usual)): (&Vec<f64>, &(Vec<f64>, f64))| {
            let variance = variance(averaged, shares, *usual);
            means(own, self.width).iter().zip(variance).map(|(m, v)| m / v.sqrt()).collect()
        };
        cleared.iter().zip(&self.shares).map(unit).collect()
    }

    /// What each freedom shows by itself: of u with correlation matrix R, `(R⁻¹ u)ᵢ / √(R⁻¹)ᵢᵢ`, the best statistic
    /// (least squares) of an effort in that joint alone.
    fn apart(&self, units: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let n = units.len();
        let own = |i: usize| {
            let root = self.inverse[(i, i)].sqrt();
            let at = |row: usize| {
                (0..n).map(|k| self.inverse[(i, k)] * units[k][row]).sum::<f64>() / root
            };
            (0..units[i].len()).map(at).collect()
        };
        (0..n).map(own).collect()
    }
}

/// One freedom under a ruler.
#[derive(Clone, Debug)]
pub struct MeasuredFreedom {
    /// What belongs to it alone, in deviations.
    pub deviations: Vec<f64>,
    /// How many deviations the largest of a block usually is.
    pub usual: f64,
    /// Plain means in deviations.
    pub units: Vec<f64>,
}

fn averaged(grounds: &[Vec<f64>], width: usize) -> Vec<Vec<f64>> {
    grounds.iter().map(|ground| means(ground, width)).collect()
}

/// Variances from shares of grounds; nothing is known better than [`LEAST`] of the usual one: where a joint hardly
/// moves its friction takes any value.
fn variance(averaged: &[Vec<f64>], shares: &[f64], usual: f64) -> Vec<f64> {
    let count = averaged.first().map_or(0, Vec::len);
    let at = |row: usize| averaged.iter().zip(shares).map(|(g, share)| g[row] * share).sum::<f64>();
    (0..count).map(|row| at(row).max(LEAST * usual)).collect()
}

/// What each ground adds to the variance of means, and the usual variance.
fn shares(mean: &[f64], averaged: &[Vec<f64>]) -> (Vec<f64>, f64) {
    let square: Vec<f64> = mean.iter().map(|m| m * m).collect();
    let usual = scatter(mean).powi(2).max(f64::MIN_POSITIVE);
    let mut shares = vec![0.0; averaged.len()];
    let mut now = vec![usual; mean.len()];
    for _ in 0..PASSES {
        let weights: Vec<f64> = now.iter().map(|v| 1.0 / (v + usual).powi(2)).collect();
        let cut = |(s, v): (&f64, &f64)| s.min(CUT * CUT * v);
        let values: Vec<f64> = square.iter().zip(&now).map(cut).collect();
        shares = positive(averaged, &values, &weights);
        now = variance(averaged, &shares, usual);
    }
    (shares, usual)
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

/// Inverse of the correlation matrix of freedoms, by robust scatters of their sums and differences.
fn inverse_correlation(units: &[Vec<f64>]) -> DMatrix<f64> {
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
    // Pairs that are estimated one by one need not fit together.
    let factors = DMatrix::from_fn(n, n, correlation).cholesky();
    factors.map_or_else(|| DMatrix::identity(n, n), |factors| factors.inverse())
}
