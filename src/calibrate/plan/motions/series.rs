//! Motions of one drive: finite Fourier series that begin and end at rest.
//!
//! J. Swevers, C. Ganseman, D. B. Tükel, J. De Schutter, H. Van Brussel, "Optimal robot excitation and
//! identification", *IEEE Trans. Robotics and Automation* 13 (1997) 730–740, parametrise each joint by
//!
//! `q(t) = q₀ + Σ_l (a_l/(ω l)) sin(ω l t) − (b_l/(ω l)) cos(ω l t)`, `ω = 2π/T`.
//!
//! A machine that is calibrated starts at rest, so that here `Σ a_l = 0` (no rate at t = 0 and T) and `Σ l b_l = 0` (no
//! acceleration there). A drive may end elsewhere than it began, as a crank that turns does: a cycloid is added,
//! `D (t/T − sin(ω t)/2π)`, whose rate and acceleration vanish at both ends, too.

use std::f64::consts::{PI, TAU};

/// Instants of a period at which extremes are looked for.
const GRID: usize = 512;

/// Motion of a drive over `[0, period]`.
///
/// ```
/// use freeplay::calibrate::plan::series::FourierSeries;
///
/// let motion = FourierSeries::new(2.0, 0.0, vec![[0.1, 0.0], [0.0, 0.05]]);
/// let [begin, end] = [0.0, 2.0].map(|t| motion.at(t));
/// assert!(begin[1].abs() < 1e-9 && end[1].abs() < 1e-9, "from rest to rest");
/// assert!(motion.scaled(2.0, 0.0).extremes().speed > motion.extremes().speed);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FourierSeries {
    /// Time in s from rest to rest.
    pub period: f64,
    /// Coordinate (m, rad) at the start.
    pub start: f64,
    /// By how much farther it ends (m, rad).
    pub drift: f64,
    /// `[a_l, b_l]` in m/s or rad/s, l = 1, 2, ….
    waves: Vec<[f64; 2]>,
}

/// Bounds that a motion does not leave at any instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Lowest and highest coordinate, m or rad.
    pub reach: [f64; 2],
    /// Largest rate, m/s or rad/s.
    pub speed: f64,
    /// Largest acceleration, m/s² or rad/s².
    pub acceleration: f64,
}

impl FourierSeries {
    /// A motion from 0 on; waves are changed as little as it takes to begin and end at rest.
    pub fn new(period: f64, drift: f64, mut waves: Vec<[f64; 2]>) -> Self {
        let order = |l: usize| (l + 1) as f64;
        let mean = waves.iter().map(|[a, _]| a).sum::<f64>() / waves.len().max(1) as f64;
        let along: f64 = waves.iter().enumerate().map(|(l, [_, b])| order(l) * b).sum();
        let square: f64 = (0..waves.len()).map(|l| order(l).powi(2)).sum();
        for (l, [a, b]) in waves.iter_mut().enumerate() {
            *a -= mean;
            *b -= order(l) * along / square;
        }
        Self { period, start: 0.0, drift, waves }
    }

    /// The same motion, so many times as large, from another coordinate on.
    pub fn scaled(&self, factor: f64, start: f64) -> Self {
        let waves = self.waves.iter().map(|wave| wave.map(|x| factor * x)).collect();
        Self { start, drift: factor * self.drift, waves, ..*self }
    }

    /// Coordinate, rate and acceleration at time `t` (s); at rest before and after.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let t = t.clamp(0.0, self.period);
        let omega = TAU / self.period;
        let (sin, cos) = (omega * t).sin_cos();
        let share = self.drift / self.period;
        let mut sum =
            [self.start + share * (t - sin / omega), share * (1.0 - cos), share * omega * sin];
        for (l, [a, b]) in self.waves.iter().enumerate() {
            let rate = omega * (l + 1) as f64;
            let (sin, cos) = (rate * t).sin_cos();
            // Less its value at t = 0, so that `start` is where it begins.
            sum[0] += (a * sin + b * (1.0 - cos)) / rate;
            sum[1] += a * cos + b * sin;
            sum[2] += rate * (b * cos - a * sin);
        }
        sum
    }

    /// Bounds of the motion. Rate and acceleration are trigonometric polynomials of degree n: between N samples of a
    /// period they are at most `1/cos(π n/N)` times as large as at these (H. Ehlich, K. Zeller, *Math. Z.* 86
    /// (1964) 41–44). The coordinate leaves the chord between two samples by at most `h²/8` times the acceleration.
    pub fn extremes(&self) -> Extremes {
        let between = 1.0 / (PI * self.waves.len().max(1) as f64 / GRID as f64).cos();
        let h = self.period / GRID as f64;
        let mut found =
            Extremes { reach: [f64::INFINITY, f64::NEG_INFINITY], speed: 0.0, acceleration: 0.0 };
        for k in 0..=GRID {
            let [position, rate, acceleration] = self.at(h * k as f64);
            found.reach = [found.reach[0].min(position), found.reach[1].max(position)];
            found.speed = found.speed.max(rate.abs());
            found.acceleration = found.acceleration.max(acceleration.abs());
        }
        found.speed *= between;
        found.acceleration *= between;
        let sag = h * h / 8.0 * found.acceleration;
        found.reach = [found.reach[0] - sag, found.reach[1] + sag];
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some() -> FourierSeries {
        FourierSeries::new(3.0, 2.0, vec![[0.3, -0.2], [1.0, 0.4], [-0.5, 0.9], [0.1, -0.6]])
            .scaled(1.5, 0.7)
    }

    #[test]
    fn it_begins_and_ends_at_rest() {
        let series = some();
        for (t, place) in [(0.0, 0.7), (3.0, 3.7), (-1.0, 0.7), (9.0, 3.7)] {
            let [position, rate, acceleration] = series.at(t);
            assert!((position - place).abs() < 1e-12, "{t}: {position}");
            assert!(rate.abs() < 1e-12 && acceleration.abs() < 1e-11, "{t}: {rate} {acceleration}");
        }
    }

    #[test]
    fn derivatives_belong_to_the_coordinate() {
        let (series, h) = (some(), 1e-5);
        for t in [0.1, 0.77, 1.5, 2.9] {
            let [before, now, after] = [t - h, t, t + h].map(|t| series.at(t));
            assert!(((after[0] - before[0]) / (2.0 * h) - now[1]).abs() < 1e-7);
            assert!(((after[1] - before[1]) / (2.0 * h) - now[2]).abs() < 1e-6);
        }
    }

    /// On a grid a hundred times as fine nothing lies outside, and the bounds are no more than a hundredth too wide.
    #[test]
    fn extremes_hold_between_the_samples() {
        let (series, extremes) = (some(), some().extremes());
        let mut fine = [0.0f64; 2];
        for k in 0..=51_200 {
            let [position, rate, acceleration] = series.at(3.0 * f64::from(k) / 51_200.0);
            assert!((extremes.reach[0]..=extremes.reach[1]).contains(&position));
            fine = [fine[0].max(rate.abs()), fine[1].max(acceleration.abs())];
        }
        assert!(fine[0] <= extremes.speed && extremes.speed < 1.01 * fine[0]);
        assert!(fine[1] <= extremes.acceleration && extremes.acceleration < 1.01 * fine[1]);
    }
}
