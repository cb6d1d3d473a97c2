//! Residuals by frequency: what noise is expected there, and residuals measured in it.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rustdct::DctPlanner;
use std::cell::RefCell;

/// One channel of a residual over time, and the highest frequency (Hz) at which it means something.
#[derive(Clone, Debug)]
pub struct Signal {
    /// Samples.
    pub values: Vec<f64>,
    /// Highest frequency in Hz.
    pub band: f64,
}

thread_local! {
    static PLANNER: RefCell<DctPlanner<f64>> = RefCell::new(DctPlanner::new());
}

/// The largest number of samples up to `available` that transforms fast: a product of 2, 3 and 5.
pub fn fast_length(available: usize) -> usize {
    let smooth = |mut n: usize| {
        for factor in [2, 3, 5] {
            while n.is_multiple_of(factor) && n > 1 {
                n /= factor;
            }
        }
        n <= 1
    };
    (1..=available).rev().find(|&n| smooth(n)).unwrap_or(available)
}

/// Cosine transforms of several signals of equal length, each up to its band: `coefficients[c][k]`
/// belongs to the frequency `k/(2 N h)`. Orthonormal, so that white noise of variance σ² has the
/// variance σ² in each coefficient.
pub fn transform(signals: &[Signal], interval: f64) -> Vec<Vec<f64>> {
    signals
        .iter()
        .map(|signal| {
            let n = signal.values.len();
            let mut values = signal.values.clone();
            // Planning costs more than transforming; a thread's plans serve all of its residuals.
            PLANNER.with_borrow_mut(|planner| planner.plan_dct2(n)).process_dct2(&mut values);
            let kept = ((signal.band * 2.0 * n as f64 * interval) as usize + 1).min(n);
            values.truncate(kept);
            let scale = (2.0 / n as f64).sqrt();
            for value in &mut values {
                *value *= scale;
            }
            values[0] *= 0.5f64.sqrt();
            values
        })
        .collect()
}

/// What noise is expected at each frequency: the covariance of the channels that reach so far.
#[derive(Clone, Debug)]
pub struct Noise {
    factors: Vec<Cholesky<f64, Dyn>>,
    /// Channels that reach each frequency.
    active: Vec<Vec<usize>>,
    log_determinant: f64,
    swinging: f64,
}

/// The Cholesky factor of a covariance; of its diagonal alone, should rounding have made it indefinite.
fn factor(covariance: DMatrix<f64>) -> Cholesky<f64, Dyn> {
    let diagonal = DMatrix::from_diagonal(&covariance.diagonal());
    let factor = covariance.cholesky().or_else(|| diagonal.cholesky());
    // A positive diagonal always has a factor.
    factor.expect("positive diagonal")
}

/// Logarithm of the determinant of a factored covariance.
fn logarithm(factor: &Cholesky<f64, Dyn>) -> f64 {
    2.0 * factor.l_dirty().diagonal().map(f64::ln).sum()
}

/// Half the number of neighbouring frequencies over which a covariance is averaged, at least; as a
/// share of the frequency where that is more: noise is smooth on such a scale.
const NEIGHBOURS: usize = 8;
const SHARE: f64 = 0.12;

/// Covariances of noise and of a swing at each frequency, of as large a swing as it was given.
#[derive(Clone, Debug)]
pub struct Covariances(Vec<CovariancesAt>);

#[derive(Clone, Debug)]
struct CovariancesAt {
    /// Channels that reach this frequency.
    active: Vec<usize>,
    noise: DMatrix<f64>,
    swing: DMatrix<f64>,
}

impl Covariances {
    /// From coefficients of pure noise, several draws of it; and of a swing that comes on top, of which no
    /// more is known than its size.
    pub fn from_draws(draws: &[Vec<Vec<f64>>], swing: &[Vec<f64>]) -> Self {
        let lengths: Vec<usize> = draws[0].iter().map(Vec::len).collect();
        let bins = lengths.iter().copied().max().unwrap_or(0);
        // Neighbouring frequencies are averaged over some of the same ones.
        let noises = by_frequency(draws, bins);
        let swings = by_frequency(std::slice::from_ref(&swing), bins);
        let at = |k: usize| {
            let active: Vec<usize> = (0..lengths.len()).filter(|&c| lengths[c] > k).collect();
            let mean = |of: &[Vec<DVector<f64>>], reach: usize| {
                let (mut sum, mut count) = (DMatrix::zeros(lengths.len(), lengths.len()), 0.0);
                let reached = |&j: &usize| active.iter().all(|&c| lengths[c] > j);
                for j in (k.saturating_sub(reach)..=k + reach).filter(reached) {
                    for vector in &of[j] {
                        sum.ger(1.0, vector, vector, 1.0);
                        count += 1.0;
                    }
                }
                sum.select_rows(&active).select_columns(&active) / count
            };
            let reach = NEIGHBOURS.max((SHARE * k as f64) as usize);
            let mut noise = mean(&noises, reach);
            // A hair of the diagonal keeps channels without noise from being singular.
            for i in 0..active.len() {
                noise[(i, i)] = noise[(i, i)] * (1.0 + 1e-6) + 1e-30;
            }
            // A swing is sharper than noise.
            let swing = mean(&swings, NEIGHBOURS);
            CovariancesAt { active, noise, swing }
        };
        Self((0..bins).map(at).collect())
    }

    /// The noise in which the swing is so many times as large.
    pub fn noise(&self, share: f64) -> Noise {
        let (mut log_determinant, mut with_swing) = (0.0, 0.0);
        let mut factors = Vec::with_capacity(self.0.len());
        for CovariancesAt { noise, swing, .. } in &self.0 {
            log_determinant += logarithm(&factor(noise.clone()));
            let whole = factor(noise + swing * share.powi(2));
            with_swing += logarithm(&whole);
            factors.push(whole);
        }
        let active = self.0.iter().map(|at| at.active.clone()).collect();
        Noise { factors, active, log_determinant, swinging: with_swing - log_determinant }
    }
}

/// Each draw's channels at each frequency, zero of those that do not reach it.
fn by_frequency<D: AsRef<[Vec<f64>]>>(draws: &[D], bins: usize) -> Vec<Vec<DVector<f64>>> {
    let at = |draw: &D, k: usize| {
        let channels = draw.as_ref().iter();
        let numbers: Vec<f64> = channels.map(|c| c.get(k).copied().unwrap_or(0.0)).collect();
        DVector::from_vec(numbers)
    };
    (0..bins).map(|k| draws.iter().map(|draw| at(draw, k)).collect()).collect()
}

impl Noise {
    /// From coefficients of pure noise, several draws of it; and of a swing that comes on top, of which no
    /// more is known than its size.
    pub fn from_draws(draws: &[Vec<Vec<f64>>], swing: &[Vec<f64>]) -> Self {
        Covariances::from_draws(draws, swing).noise(1.0)
    }

    /// The noise halfway between two: the mean of their covariances, without a swing. None where they are of other channels.
    pub fn mean(two: [&Self; 2]) -> Option<Self> {
        let [a, b] = two;
        if a.active != b.active {
            return None;
        }
        let covariance = |factor: &Cholesky<f64, Dyn>| factor.l() * factor.l().transpose();
        let pairs = a.factors.iter().zip(&b.factors);
        let factors: Vec<_> =
            pairs.map(|(a, b)| factor((covariance(a) + covariance(b)) * 0.5)).collect();
        let log_determinant = factors.iter().map(logarithm).sum();
        let active = a.active.clone();
        Some(Self { factors, active, log_determinant, swinging: 0.0 })
    }

    /// Coefficients in units of the noise: independent, of variance one, if they are noise.
    pub fn whiten(&self, coefficients: &[Vec<f64>]) -> DVector<f64> {
        let mut white = DVector::zeros(self.active.iter().map(Vec::len).sum());
        let mut begun = 0;
        for (k, (factor, active)) in self.factors.iter().zip(&self.active).enumerate() {
            let mut own = white.rows_mut(begun, active.len());
            for (number, &channel) in own.iter_mut().zip(active) {
                *number = coefficients[channel][k];
            }
            // A factor of a covariance has no zero on its diagonal.
            factor.l_dirty().solve_lower_triangular_mut(&mut own);
            begun += active.len();
        }
        white
    }

    /// Logarithm of the determinant of the covariance, of the swing aside: what a model pays for being
    /// noisy, where likelihoods are compared. The swing is known by one draw: its determinant is chance.
    pub fn log_determinant(&self) -> f64 {
        self.log_determinant
    }

    /// What the swing adds to the logarithm of the determinant.
    pub fn swinging(&self) -> f64 {
        self.swinging
    }

    /// Channel and frequency bin of each number that [`whiten`](Self::whiten) returns.
    pub fn places(&self) -> Vec<(usize, usize)> {
        let bins = self.active.iter().enumerate();
        bins.flat_map(|(k, active)| active.iter().map(move |&c| (c, k))).collect()
    }
}
