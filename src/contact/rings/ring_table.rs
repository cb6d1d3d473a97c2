//! A ring of any shape, as a table round it.

use std::f64::consts::TAU;
use std::sync::Arc;

/// Fewest samples of a shape: a spline of degree three has four at each place.
pub const FEWEST_SAMPLES: usize = 4;

/// Terms of the sum over the samples before the first: the pole √3 − 2 to the power of so many is below rounding.
const TERMS: usize = 32;

/// What a ring is wider by, sampled at equal angles from the x axis of its body on, and between them the periodic
/// cubic spline through the samples: twice continuously differentiable, so that steps of high order stay so.
///
/// Kept as B-spline coefficients, `g(θ) = Σ c_i β³(n θ/2π − i)`, found by the recursive filter of M. Unser, A. Aldroubi
/// and M. Eden, IEEE Trans. Signal Processing 41 (1993) 821–833.
///
/// [`RingShape`](crate::contact::RingShape) has an example.
#[derive(Clone, Debug, PartialEq)]
pub struct RingTable {
    coefficients: Arc<[f64]>,
    narrowing: f64,
}

impl RingTable {
    /// The shape through samples `wider` in m, or none of fewer than [`FEWEST_SAMPLES`].
    pub fn new(wider: &[f64]) -> Option<Self> {
        let n = wider.len();
        if n < FEWEST_SAMPLES {
            return None;
        }
        let pole = 3f64.sqrt() - 2.0;
        let mut c: Vec<f64> = wider.iter().map(|g| 6.0 * g).collect();
        // Round once before, so that start and end fit.
        let first = (0..TERMS).fold(0.0, |sum, k| sum + c[(n - k % n) % n] * pole.powi(k as i32));
        c[0] = first;
        for i in 1..n {
            c[i] += pole * c[i - 1];
        }
        let last = (0..TERMS).fold(0.0, |sum, k| sum + c[(n - 1 + k) % n] * pole.powi(k as i32));
        c[n - 1] = -pole * last;
        for i in (0..n - 1).rev() {
            c[i] = pole * (c[i + 1] - c[i]);
        }
        let narrowing = wider.iter().fold(0.0f64, |most, g| most.max(-g));
        Some(Self { coefficients: c.into(), narrowing })
    }

    /// By how much in m a sample is narrower than the mean clearance at most.
    pub fn narrowing(&self) -> f64 {
        self.narrowing
    }

    /// g in m at `theta` (rad), and its first two derivatives.
    pub(in crate::contact) fn at(&self, theta: f64) -> [f64; 3] {
        let n = self.coefficients.len();
        let per_radian = n as f64 / TAU;
        let place = (theta * per_radian).rem_euclid(n as f64);
        let i = (place as usize).min(n - 1);
        let u = place - i as f64;
        let [a, b, c, d] = [n - 1, 0, 1, 2].map(|by| self.coefficients[(i + by) % n]);
        let v = 1.0 - u;
        let value = v * v * v * a
            + (4.0 + 3.0 * u * u * (u - 2.0)) * b
            + (4.0 + 3.0 * v * v * (v - 2.0)) * c
            + u * u * u * d;
        let slope = -v * v * a + u * (3.0 * u - 4.0) * b - v * (3.0 * v - 4.0) * c + u * u * d;
        let bend = v * a + (3.0 * u - 2.0) * b + (3.0 * v - 2.0) * c + u * d;
        [value / 6.0, slope / 2.0 * per_radian, bend * per_radian * per_radian]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goes_through_its_samples_and_closes_smoothly() {
        let samples: Vec<f64> = (0..7).map(|i| f64::from(i * i % 5) * 1e-6).collect();
        let table = RingTable::new(&samples).unwrap();
        for (i, sample) in samples.iter().enumerate() {
            let at = table.at(TAU * i as f64 / 7.0)[0];
            assert!((at - sample).abs() < 1e-18, "{at} {sample}");
        }
        for theta in [0.0, 1.0, TAU, -2.0] {
            let [before, after] = [-1e-9, 1e-9].map(|by| table.at(theta + by));
            let across = [0, 1, 2].map(|k| (after[k] - before[k]).abs());
            assert!(across[0] < 1e-13 && across[1] < 1e-13 && across[2] < 1e-12, "{across:?}");
            let h = 1e-5;
            let [low, mid, high] = [-h, 0.0, h].map(|by| table.at(theta + by));
            assert!(((high[0] - low[0]) / (2.0 * h) - mid[1]).abs() < 1e-14);
            assert!(((high[1] - low[1]) / (2.0 * h) - mid[2]).abs() < 1e-9);
        }
        assert!(RingTable::new(&samples[..3]).is_none());
    }

    #[test]
    fn a_wave_is_followed_to_the_fourth_order() {
        let error = |n: usize| {
            let wave = |theta: f64| 1e-5 * (2.0 * theta - 0.3).cos();
            let samples: Vec<f64> = (0..n).map(|i| wave(TAU * i as f64 / n as f64)).collect();
            let table = RingTable::new(&samples).unwrap();
            (0..1000).fold(0.0f64, |worst, k| {
                let theta = 0.01 * f64::from(k);
                worst.max((table.at(theta)[0] - wave(theta)).abs())
            })
        };
        let [coarse, fine] = [36, 72].map(error);
        assert!((12.0..20.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
        // h⁴ g⁗/384.
        assert!(error(360) < 1e-13);
    }
}
