//! Cubic splines through samples.

/// A cubic spline with continuous first and second derivatives, natural at its ends (second
/// derivative zero), constant outside. Equations: de Boor, *A Practical Guide to Splines*, ch. IV,
/// with the second derivatives as unknowns.
#[derive(Clone, Debug)]
pub struct CubicSpline {
    t: Vec<f64>,
    value: Vec<f64>,
    curvature: Vec<f64>,
}

impl CubicSpline {
    /// The spline through (`t`, `value`), `t` strictly increasing, both of the same length ≥ 2.
    pub fn natural(t: &[f64], value: &[f64]) -> Self {
        let n = t.len();
        let mut curvature = vec![0.0; n];
        // Thomas' algorithm on h₋ y″₋ + 2(h₋ + h₊) y″ + h₊ y″₊ = 6 (slope₊ − slope₋).
        let mut upper = vec![0.0; n];
        for i in 1..n.saturating_sub(1) {
            let (before, after) = (t[i] - t[i - 1], t[i + 1] - t[i]);
            let slopes = (value[i + 1] - value[i]) / after - (value[i] - value[i - 1]) / before;
            let pivot = 2.0 * (before + after) - before * upper[i - 1];
            upper[i] = after / pivot;
            curvature[i] = (6.0 * slopes - before * curvature[i - 1]) / pivot;
        }
        for i in (1..n.saturating_sub(1)).rev() {
            curvature[i] -= upper[i] * curvature[i + 1];
        }
        Self { t: t.to_vec(), value: value.to_vec(), curvature }
    }

    /// The last sample's t.
    pub fn end(&self) -> f64 {
        self.t[self.t.len() - 1]
    }

    /// Value, first and second derivative at `t`; outside the samples the nearest end, at rest.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let last = self.t.len() - 1;
        if t < self.t[0] {
            return [self.value[0], 0.0, 0.0];
        }
        if t > self.t[last] {
            return [self.value[last], 0.0, 0.0];
        }
        // Samples mostly are equally far apart: a logarithmic search takes 3 % of a simulation.
        let share = (t - self.t[0]) / (self.t[last] - self.t[0]);
        let guess = ((share * last as f64) as usize + 1).min(last);
        let i = if (self.t[guess - 1]..self.t[guess]).contains(&t) {
            guess
        } else {
            self.t.partition_point(|&knot| knot <= t).clamp(1, last)
        };
        let h = self.t[i] - self.t[i - 1];
        let (a, b) = ((self.t[i] - t) / h, (t - self.t[i - 1]) / h);
        let (y0, y1) = (self.value[i - 1], self.value[i]);
        let (c0, c1) = (self.curvature[i - 1], self.curvature[i]);
        [
            a * y0 + b * y1 + ((a * a * a - a) * c0 + (b * b * b - b) * c1) * h * h / 6.0,
            (y1 - y0) / h + ((3.0 * b * b - 1.0) * c1 - (3.0 * a * a - 1.0) * c0) * h / 6.0,
            a * c0 + b * c1,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn follows_a_sine_to_fourth_order() {
        let error = |n: usize| {
            let t: Vec<f64> =
                (0..=n).map(|i| i as f64 / n as f64 * std::f64::consts::TAU).collect();
            let y: Vec<f64> = t.iter().map(|t| t.sin()).collect();
            let spline = CubicSpline::natural(&t, &y);
            (0..1000)
                .map(|i| i as f64 * 0.006)
                .map(|t| (spline.at(t)[0] - t.sin()).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(20) / error(40)).log2();
        assert!(order > 3.8, "order {order}");
    }

    #[test]
    fn rests_outside_and_passes_through_its_samples() {
        let spline = CubicSpline::natural(&[0.0, 1.0, 3.0, 4.0], &[1.0, 2.0, 0.0, 5.0]);
        assert_eq!(spline.at(-1.0), [1.0, 0.0, 0.0]);
        assert_eq!(spline.at(9.0), [5.0, 0.0, 0.0]);
        for (t, y) in [(0.0, 1.0), (1.0, 2.0), (3.0, 0.0), (4.0, 5.0)] {
            assert!((spline.at(t)[0] - y).abs() < 1e-15);
        }
    }
}
