//! Cubic splines through samples.

/// A cubic spline with continuous first and second derivatives, constant outside. Equations: de Boor,
/// *A Practical Guide to Splines*, ch. IV, with the second derivatives as unknowns.
///
/// ```
/// use freeplay::measure::spline::CubicSpline;
///
/// let t: Vec<f64> = (0..5).map(f64::from).collect();
/// let cubes: Vec<f64> = t.iter().map(|t| t.powi(3)).collect();
/// // Exact for a cubic: value, slope and second derivative.
/// let [value, slope, curvature] = CubicSpline::not_a_knot(&t, &cubes).at(1.5);
/// assert!((value - 3.375).abs() < 1e-12 && (slope - 6.75).abs() < 1e-12 && (curvature - 9.0).abs() < 1e-12);
/// ```
#[derive(Clone, Debug)]
pub struct CubicSpline {
    t: Vec<f64>,
    value: Vec<f64>,
    curvature: Vec<f64>,
}

impl CubicSpline {
    /// The spline through (`t`, `value`), `t` strictly increasing, both of the same length ≥ 4, whose third
    /// derivative is continuous at the second and the last but one sample ("not a knot"): accurate to the
    /// fourth order up to its ends, whatever the second derivative is there.
    pub fn not_a_knot(t: &[f64], value: &[f64]) -> Self {
        let n = t.len();
        if n < 4 {
            return Self::natural(t, value);
        }
        let h = |i: usize| t[i + 1] - t[i];
        let mut curvature = vec![0.0; n];
        let mut upper = vec![0.0; n];
        for i in 1..n - 1 {
            let (before, after) = (h(i - 1), h(i));
            let slopes = (value[i + 1] - value[i]) / after - (value[i] - value[i - 1]) / before;
            // The end's second derivative in terms of the next two: y₀″ = (1 + r) y₁″ − r y₂″.
            let (mut lower, mut middle, mut above) = (before, 2.0 * (before + after), after);
            if i == 1 {
                let ratio = before / after;
                (lower, middle, above) =
                    (0.0, middle + before * (1.0 + ratio), above - before * ratio);
            }
            if i == n - 2 {
                let ratio = after / before;
                (lower, middle, above) =
                    (lower - after * ratio, middle + after * (1.0 + ratio), 0.0);
            }
            let pivot = middle - lower * upper[i - 1];
            upper[i] = above / pivot;
            curvature[i] = (6.0 * slopes - lower * curvature[i - 1]) / pivot;
        }
        for i in (1..n - 2).rev() {
            curvature[i] -= upper[i] * curvature[i + 1];
        }
        let end = |h0: f64, h1: f64, c1: f64, c2: f64| c1 + (c1 - c2) * (h0 / h1);
        curvature[0] = end(h(0), h(1), curvature[1], curvature[2]);
        curvature[n - 1] = end(h(n - 2), h(n - 3), curvature[n - 2], curvature[n - 3]);
        Self { t: t.to_vec(), value: value.to_vec(), curvature }
    }

    /// The spline through (`t`, `value`), `t` strictly increasing, both of the same length ≥ 2, whose second
    /// derivative is zero at both ends.
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

    /// The shortest way in t from one sample to the next.
    pub fn shortest_interval(&self) -> f64 {
        self.t.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min)
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
    fn a_cubic_is_reproduced_up_to_its_ends() {
        let t = [0.0, 0.1, 0.25, 0.4, 0.7, 1.0];
        let cubic = |t: f64| 1.0 + 2.0 * t - 3.0 * t * t + 4.0 * t * t * t;
        let spline = CubicSpline::not_a_knot(&t, &t.map(cubic));
        for at in [0.0, 0.03, 0.5, 0.99, 1.0] {
            let [value, rate, second] = spline.at(at);
            assert!((value - cubic(at)).abs() < 1e-14);
            assert!((rate - (2.0 - 6.0 * at + 12.0 * at * at)).abs() < 1e-12);
            assert!((second - (-6.0 + 24.0 * at)).abs() < 1e-10);
        }
    }

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
