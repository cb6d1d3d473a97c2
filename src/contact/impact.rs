//! One head-on hit of a free mass, simulated by itself.

use super::ForceLaw;

/// What a hit of a free mass came to.
///
/// [`impact`](impact()) has an example.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Speed at which the mass leaves in m/s.
    pub rebound: f64,
    /// Time in contact in s.
    pub duration: f64,
}

/// Steps within the longest one that resolves the hit: three digits of both results.
const REFINEMENT: f64 = 200.0;

/// Steps after which a hit without end (a damper that never lets go) is taken to be over.
const LONGEST: usize = 100_000;

/// A moment of a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Penetration in m.
    pub depth: f64,
    /// Its rate in m/s.
    pub rate: f64,
    /// Force of the law in N.
    pub force: f64,
}

/// A free `mass` (kg) hits the surface at `speed` m/s under a law: `m δ̈ = −F(δ, δ̇)` from δ = 0,
/// by Heun's method. `look` is shown every step in contact.
pub fn hit(law: &dyn ForceLaw, mass: f64, speed: f64, look: &mut dyn FnMut(Moment)) -> Impact {
    let dt = law.longest_step(mass, speed) / REFINEMENT;
    let force = |depth: f64, rate: f64| {
        if depth > 0.0 { law.normal_force_after(depth, rate, speed) } else { 0.0 }
    };
    let (mut depth, mut rate) = (0.0, speed);
    let mut hit = Impact { rebound: 0.0, duration: 0.0 };
    for _ in 0..LONGEST {
        let a = -force(depth, rate) / mass;
        let (depth1, rate1) = (depth + dt * rate, rate + dt * a);
        let a1 = -force(depth1, rate1) / mass;
        depth += 0.5 * dt * (rate + rate1);
        rate += 0.5 * dt * (a + a1);
        if depth <= 0.0 {
            break;
        }
        hit.duration += dt;
        look(Moment { depth, rate, force: force(depth, rate) });
    }
    hit.rebound = (-rate).max(0.0);
    hit
}

/// A [`hit`] that nobody looks at.
///
/// ```
/// use freeplay::contact::{HertzStep, impact};
///
/// let law = HertzStep { stiffness: 1.6e10, exponent: 1.5, c_max: 0.0, d_max: 1e-5, clip: true };
/// // 0.1 kg at 0.1 m/s: without damping all of the speed comes back, with it less.
/// assert!((impact(&law, 0.1, 0.1).rebound - 0.1).abs() < 1e-4);
/// assert!(impact(&HertzStep { c_max: 500.0, ..law }, 0.1, 0.1).rebound < 0.099);
/// ```
pub fn impact(law: &dyn ForceLaw, mass: f64, speed: f64) -> Impact {
    hit(law, mass, speed, &mut |_| {})
}

#[cfg(test)]
mod tests {
    use super::super::HertzStep;
    use super::*;

    #[test]
    fn hits_agree_with_the_independent_solver() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/reference/impact.csv");
        let mut reader = csv::Reader::from_path(path).expect("reference");
        for record in reader.records() {
            let row: Vec<f64> =
                record.expect("row").iter().map(|f| f.parse().expect("number")).collect();
            let [mass, speed, stiffness, exponent, c_max, d_max] = row[..6] else {
                panic!("{row:?}")
            };
            let law = HertzStep { stiffness, exponent, c_max, d_max, clip: true };
            let hit = impact(&law, mass, speed);
            for (ours, theirs) in [(hit.duration, row[8]), (hit.rebound / speed, row[9])] {
                assert!((ours / theirs - 1.0).abs() < 2e-3, "{row:?}: {hit:?}");
            }
        }
    }
}
