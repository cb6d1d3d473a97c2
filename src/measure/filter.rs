//! Zero-phase low-pass filters.

use std::f64::consts::PI;

/// A Butterworth low-pass as sections of second order, run forward and backward: no phase, the square
/// of the filter's gain. Bilinear transform with the corner prewarped (Oppenheim and Schafer,
/// *Discrete-Time Signal Processing*, §7.1).
///
/// ```
/// use freeplay::measure::filter::{ZeroPhase, derivative};
///
/// // 2 Hz and 200 Hz at 1 kHz; the filter ends at 20 Hz.
/// let [slow, fast] = [2.0, 200.0]
///     .map(|f| (0..1000).map(|i| (std::f64::consts::TAU * f * f64::from(i) / 1e3).sin()).collect::<Vec<f64>>());
/// let low_pass = ZeroPhase::butterworth(4, 20.0, 1e-3);
/// assert!((low_pass.apply(&slow)[500] - slow[500]).abs() < 1e-3);
/// assert!(low_pass.apply(&fast)[500].abs() < 1e-3);
/// assert!((derivative(&slow, 1e-3)[500] - 2.0 * std::f64::consts::TAU).abs() < 1e-2);
/// ```
#[derive(Clone, Debug)]
pub struct ZeroPhase {
    /// b0 b1 b2 a1 a2 of each section.
    sections: Vec<[f64; 5]>,
    /// Samples by which a signal is continued at each end.
    padding: usize,
}

impl ZeroPhase {
    /// Of an even `order`, with its corner at `corner` Hz, for samples every `interval` s. The corner
    /// has to lie below half the sampling rate.
    pub fn butterworth(order: usize, corner: f64, interval: f64) -> Self {
        let warped = (PI * corner * interval).tan();
        let sections = (0..order / 2).map(|k| {
            let damping = 2.0 * (PI * (2 * k + 1) as f64 / (2 * order) as f64).sin();
            let norm = 1.0 + damping * warped + warped * warped;
            let b = warped * warped / norm;
            let a1 = 2.0 * (warped * warped - 1.0) / norm;
            let a2 = (1.0 - damping * warped + warped * warped) / norm;
            [b, 2.0 * b, b, a1, a2]
        });
        // Six periods of the corner: by then a millionth is left of the filter's answer to its start.
        let padding = (6.0 / (corner * interval)).ceil() as usize;
        Self { sections: sections.collect(), padding }
    }

    /// The filtered signal. At both ends the signal is continued by its point reflection.
    pub fn apply(&self, signal: &[f64]) -> Vec<f64> {
        let n = signal.len();
        if n < 2 {
            return signal.to_vec();
        }
        let padding = self.padding.min(n - 1);
        let (first, last) = (signal[0], signal[n - 1]);
        let mut padded = Vec::with_capacity(n + 2 * padding);
        padded.extend((1..=padding).rev().map(|i| 2.0 * first - signal[i]));
        padded.extend_from_slice(signal);
        padded.extend((1..=padding).map(|i| 2.0 * last - signal[n - 1 - i]));
        for _ in 0..2 {
            self.run(&mut padded);
            padded.reverse();
        }
        padded[padding..padding + n].to_vec()
    }

    /// What of a signal is faster than it lets through: the signal less what it lets through, in the signal's unit.
    pub fn faster(&self, signal: &[f64]) -> Vec<f64> {
        signal.iter().zip(self.apply(signal)).map(|(whole, slow)| whole - slow).collect()
    }

    /// Once forward, in the steady state of the first sample.
    fn run(&self, signal: &mut [f64]) {
        for [b0, b1, b2, a1, a2] in &self.sections {
            let start = signal[0];
            // Steady state of the transposed direct form for a constant input of gain one.
            let (mut z1, mut z2) = (start * (1.0 - b0), start * (b2 - a2));
            for x in signal.iter_mut() {
                let y = b0 * *x + z1;
                z1 = b1 * *x - a1 * y + z2;
                z2 = b2 * *x - a2 * y;
                *x = y;
            }
        }
    }
}

/// Derivative of evenly spaced samples by central differences, one-sided at the ends.
pub fn derivative(signal: &[f64], interval: f64) -> Vec<f64> {
    let n = signal.len();
    (0..n)
        .map(|i| {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(n - 1));
            (signal[after] - signal[before]) / ((after - before).max(1) as f64 * interval)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Forward and backward the gain is `1/(1 + (tan πfT/tan πf_cT)^{2N})`, and there is no phase.
    #[test]
    fn gain_is_that_of_the_square_of_a_butterworth() {
        for (order, corner) in [(2, 400.0), (4, 25.0), (4, 50.0)] {
            let h = 1e-4;
            let filter = ZeroPhase::butterworth(order, corner, h);
            for f in [0.3 * corner, corner, 2.0 * corner] {
                let n = (40.0 / (f * h)) as usize;
                let signal: Vec<f64> = (0..n).map(|i| (TAU * f * h * i as f64).sin()).collect();
                let filtered = filter.apply(&signal);
                let ratio = ((PI * f * h).tan() / (PI * corner * h).tan()).powi(2 * order as i32);
                let gain = 1.0 / (1.0 + ratio);
                for i in n / 3..2 * n / 3 {
                    assert!((filtered[i] - gain * signal[i]).abs() < 2e-3, "{order} {f}");
                }
            }
        }
    }

    #[test]
    fn leaves_lines_alone() {
        let line: Vec<f64> = (0..500).map(|i| 3.0 - 0.01 * f64::from(i)).collect();
        for (a, b) in ZeroPhase::butterworth(4, 25.0, 1e-3).apply(&line).iter().zip(&line) {
            assert!((a - b).abs() < 1e-6, "{a} {b}");
        }
    }
}
