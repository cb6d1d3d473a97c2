//! Elastic forces over the penetration: what the laws of this room have beside their damping.

use crate::contact::power_force;
use std::f64::consts::PI;
use std::fmt::Debug;

/// Abscissae and weights of Gauss' rule with five points on [−1, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Halvings until a bracket is as narrow as numbers are.
const HALVINGS: usize = 60;

/// Points of the midpoint rule over a hit; its time is a smooth periodic integral, known to 1e-4.
const HIT_POINTS: usize = 32;

/// An elastic force that depends on the penetration alone and rises with it from zero.
pub trait ElasticForce: Debug + Clone + Send + Sync + 'static {
    /// Force in N at a penetration δ > 0 in m.
    fn force(&self, penetration: f64) -> f64;

    /// Stiffness K in N/mⁿ of a power law.
    fn stiffness(&self) -> Option<f64> {
        None
    }

    /// Deepest penetration in m up to which the formula holds, where it has such an end.
    fn valid_depth(&self) -> Option<f64> {
        None
    }

    /// Largest ratio of clearance to ring radius for which the formula is meant, where it has such an end.
    fn valid_clearance(&self) -> Option<f64> {
        None
    }

    /// Work in J that it takes to get `penetration` m deep: `∫ F dδ`, by Gauss' rule over √δ, in which forces
    /// after Hertz are polynomials.
    fn energy(&self, penetration: f64) -> f64 {
        let half = 0.5 * penetration.sqrt();
        let at = |x: f64| {
            let root = half * (1.0 + x);
            2.0 * root * self.force(root * root)
        };
        half * GAUSS.iter().map(|&(x, weight)| weight * at(x)).sum::<f64>()
    }

    /// Penetration in m at which the force is `force` N.
    fn penetration(&self, force: f64) -> f64 {
        rising(|depth| self.force(depth), force)
    }

    /// Deepest penetration in m of a lossless hit of `mass` kg at `speed` m/s: `½ m v² = ∫ F dδ`.
    fn deepest(&self, mass: f64, speed: f64) -> f64 {
        rising(|depth| self.energy(depth), 0.5 * mass * speed * speed)
    }

    /// Duration in s of that hit, `2 ∫ dδ/√(v² − 2 E/m)`; δ = δ_max sin θ takes the root's zero away.
    fn contact_time(&self, mass: f64, speed: f64) -> f64 {
        let deepest = self.deepest(mass, speed);
        let total = self.energy(deepest);
        let step = 0.5 * PI / HIT_POINTS as f64;
        let points = (0..HIT_POINTS).map(|k| {
            let (sin, cos) = (step * (k as f64 + 0.5)).sin_cos();
            cos / (1.0 - self.energy(deepest * sin) / total).sqrt()
        });
        2.0 * deepest / speed * step * points.sum::<f64>()
    }
}

/// Where a function that rises from 0 has a value; 0 for none above 0.
fn rising(function: impl Fn(f64) -> f64, value: f64) -> f64 {
    // 1 nm: below what any contact of a machine gives, so that doubling finds the bracket's end.
    let (mut low, mut high) = (0.0, 1e-9);
    if value <= 0.0 {
        return 0.0;
    }
    while function(high) < value && high < 1e3 {
        low = high;
        high *= 2.0;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if function(middle) < value { low = middle } else { high = middle }
    }
    high
}

/// `F = K δⁿ`: Hertz for n = 1.5, a linear spring for n = 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerSpring {
    /// Stiffness K in N/mⁿ.
    pub stiffness: f64,
    /// Exponent n.
    pub exponent: f64,
}

impl ElasticForce for PowerSpring {
    fn force(&self, penetration: f64) -> f64 {
        power_force(self.stiffness, self.exponent, penetration)
    }

    fn stiffness(&self) -> Option<f64> {
        Some(self.stiffness)
    }

    fn energy(&self, penetration: f64) -> f64 {
        self.force(penetration) * penetration / (self.exponent + 1.0)
    }

    fn penetration(&self, force: f64) -> f64 {
        (force / self.stiffness).powf(1.0 / self.exponent)
    }
}

/// Cylinders in line contact: `δ = A F ln(D/F)`, the one shape of the conformal laws of Johnson, Radzimovsky,
/// Goldsmith, Dubowsky and Freudenstein, and ESDU 78035.
///
/// With u = ln(D/F) that is `δ/(A D) = u e^(−u)`, which has a force for `δ ≤ A D/e` only, where the slope is
/// infinite: half spaces know nothing of the ring around the journal. The formula is used up to u = 2, `δ =
/// 2 A D/e²`, where the contact is half as compliant as at first touch, and continued along its tangent there,
/// `dF/dδ = 1/A`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Logarithmic {
    /// A in m/N.
    pub compliance: f64,
    /// D in N.
    pub scale: f64,
}

/// u = ln(D/F) where the formula ends.
const END: f64 = 2.0;

/// Ratio of clearance to ring radius beyond which surfaces no longer conform: radii that differ by a tenth. Plain bearings
/// have a thousandth, the paper's worn ones a twentieth.
const CONFORMING: f64 = 0.1;

/// Most steps of Newton's method for u; four are enough.
const NEWTON: usize = 12;

impl ElasticForce for Logarithmic {
    fn force(&self, penetration: f64) -> f64 {
        let y = penetration / (self.compliance * self.scale);
        let end = (-END).exp();
        if y >= END * end {
            return self.scale * (y - (END - 1.0) * end);
        }
        // u − ln u = −ln y, convex in u: Newton's method from above comes down without overshooting.
        let q = -y.ln();
        let mut u = (q + 2.0 * q.max(1.0).ln()).max(END);
        for _ in 0..NEWTON {
            let next = u * (q + u.ln() - 1.0) / (u - 1.0);
            let settled = (next - u).abs() <= 1e-15 * u;
            u = next;
            if settled {
                break;
            }
        }
        penetration / (self.compliance * u)
    }

    fn valid_clearance(&self) -> Option<f64> {
        Some(CONFORMING)
    }

    fn valid_depth(&self) -> Option<f64> {
        Some(END * (-END).exp() * self.compliance * self.scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_is_the_integral_of_the_force() {
        let power = PowerSpring { stiffness: 3.7e9, exponent: 1.5 };
        #[derive(Clone, Debug)]
        struct Plain(PowerSpring);
        impl ElasticForce for Plain {
            fn force(&self, penetration: f64) -> f64 {
                self.0.force(penetration)
            }
        }
        let plain = Plain(power);
        assert!((plain.energy(7e-6) / power.energy(7e-6) - 1.0).abs() < 1e-14);
        assert!((plain.penetration(40.0) / power.penetration(40.0) - 1.0).abs() < 1e-13);
        // Johnson 1985, §11.4: T = 2.94 δ/v.
        let time = power.contact_time(0.1, 0.1);
        assert!((time / (2.9432 * power.deepest(0.1, 0.1) / 0.1) - 1.0).abs() < 1e-3, "{time}");
    }

    #[test]
    fn logarithmic_force_solves_its_equation() {
        let law = Logarithmic { compliance: 4e-10, scale: 2e5 };
        for k in 0..60 {
            let depth = law.valid_depth().unwrap() * 0.6f64.powi(k);
            let force = law.force(depth);
            let back = law.compliance * force * (law.scale / force).ln();
            assert!((back / depth - 1.0).abs() < 1e-12, "{depth}: {force}");
        }
    }

    #[test]
    fn logarithmic_force_goes_on_smoothly_beyond_its_end() {
        let law = Logarithmic { compliance: 4e-10, scale: 2e5 };
        let end = law.valid_depth().unwrap();
        let slope = |depth: f64| (law.force(depth * 1.0001) - law.force(depth)) / (1e-4 * depth);
        assert!(
            (law.force(end * (1.0 + 1e-12)) / law.force(end * (1.0 - 1e-12)) - 1.0).abs() < 1e-11
        );
        assert!((slope(0.999 * end) / slope(1.001 * end) - 1.0).abs() < 5e-3);
    }
}
