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
        let bins = draws[0].iter().map(Vec::len).max().unwrap_or(0);
        Self((0..bins).map(|k| CovariancesAt::from_draws(draws, swing, k)).collect())
    }

    /// The noise in which the swing is so many times as large.
    pub fn noise(&self, share: f64) -> Noise {
        let logarithm =
            |factor: &Cholesky<f64, Dyn>| 2.0 * factor.l_dirty().diagonal().map(f64::ln).sum();
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

impl CovariancesAt {
    fn from_draws(draws: &[Vec<Vec<f64>>], swing: &[Vec<f64>], k: usize) -> Self {
        let channels = draws[0].len();
        let active: Vec<usize> = (0..channels).filter(|&c| draws[0][c].len() > k).collect();
        let reach = NEIGHBOURS.max((SHARE * k as f64) as usize);
        let size = active.len();
        let [mut covariance, mut swinging] = [(); 2].map(|()| DMatrix::<f64>::zeros(size, size));
        let (mut count, mut places) = (0.0, 0.0);
        for j in k.saturating_sub(reach)..=k + reach {
            if active.iter().any(|&c| draws[0][c].len() <= j) {
                continue;
            }
            let at = |draw: &[Vec<f64>]| DVector::from_fn(size, |i, _| draw[active[i]][j]);
            for draw in draws {
                let vector = at(draw);
                covariance.ger(1.0, &vector, &vector, 1.0);
                count += 1.0;
            }
            // A swing is sharper than noise.
            if j.abs_diff(k) <= NEIGHBOURS {
                let vector = at(swing);
                swinging.ger(1.0, &vector, &vector, 1.0);
                places += 1.0;
            }
        }
        covariance /= count;
        // A hair of the diagonal keeps channels without noise from being singular.
        for i in 0..size {
            covariance[(i, i)] = covariance[(i, i)] * (1.0 + 1e-6) + 1e-30;
        }
        Self { active, noise: covariance, swing: swinging / f64::max(places, 1.0) }
    }
}

impl Noise {
    /// From coefficients of pure noise, several draws of it; and of a swing that comes on top, of which no
    /// more is known than its size.
    pub fn from_draws(draws: &[Vec<Vec<f64>>], swing: &[Vec<f64>]) -> Self {
        Covariances::from_draws(draws, swing).noise(1.0)
    }

    /// Coefficients in units of the noise: independent, of variance one, if they are noise.
    pub fn whiten(&self, coefficients: &[Vec<f64>]) -> DVector<f64> {
        let mut white = Vec::new();
        for (k, (factor, active)) in self.factors.iter().zip(&self.active).enumerate() {
            let vector =
                DVector::from_iterator(active.len(), active.iter().map(|&c| coefficients[c][k]));
            let solved = factor.l_dirty().solve_lower_triangular(&vector);
            white.extend(solved.iter().flat_map(|v| v.iter().copied()));
        }
        DVector::from_vec(white)
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
