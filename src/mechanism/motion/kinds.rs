//! Motions in closed form.

use super::{Motion, PathPoint};
use nalgebra::{Vector2, Vector3};
use std::f64::consts::TAU;

fn planar(v: Vector2<f64>, phi: f64) -> Vector3<f64> {
    Vector3::new(v.x, v.y, phi)
}

/// A circle at constant speed and constant orientation: centre + r [cos, sin](2πt/T + ψ).
///
/// [`Motion`](crate::mechanism::motion::Motion) has an example.
#[derive(Clone, Debug)]
pub struct Circle {
    /// Centre in m.
    pub center: Vector2<f64>,
    /// Radius r in m.
    pub radius: f64,
    /// Period T in s; negative runs clockwise.
    pub period: f64,
    /// Start phase ψ in rad.
    pub phase: f64,
    /// Orientation φ in rad.
    pub phi: f64,
}

impl Motion for Circle {
    fn at(&self, t: f64) -> PathPoint {
        let omega = TAU / self.period;
        let (sin, cos) = (omega * t + self.phase).sin_cos();
        let (out, along) = (Vector2::new(cos, sin), Vector2::new(-sin, cos));
        PathPoint {
            pose: planar(self.center + out * self.radius, self.phi),
            rate: planar(along * (self.radius * omega), 0.0),
            acceleration: planar(-out * (self.radius * omega * omega), 0.0),
        }
    }

    fn kept_angle(&self) -> Option<f64> {
        Some(self.phi)
    }

    fn shown_after(&self) -> f64 {
        self.period
    }

    fn fastest_turn(&self) -> f64 {
        self.period
    }
}

/// A straight line at constant velocity and orientation.
#[derive(Clone, Debug)]
pub struct Line {
    /// Position at t = 0 in m.
    pub start: Vector2<f64>,
    /// Velocity in m/s.
    pub velocity: Vector2<f64>,
    /// Orientation φ in rad.
    pub phi: f64,
}

impl Motion for Line {
    fn at(&self, t: f64) -> PathPoint {
        PathPoint {
            pose: planar(self.start + self.velocity * t, self.phi),
            rate: planar(self.velocity, 0.0),
            acceleration: Vector3::zeros(),
        }
    }

    fn kept_angle(&self) -> Option<f64> {
        Some(self.phi)
    }
}

/// Point to point from rest to rest ([`rest_to_rest`]: the lowest polynomial with no jump in
/// acceleration), and rest before and after.
///
/// [`Motion`](crate::mechanism::motion::Motion) has an example.
#[derive(Clone, Debug)]
pub struct Quintic {
    /// Pose at the start (m, m, rad).
    pub from: Vector3<f64>,
    /// Pose at the end (m, m, rad).
    pub to: Vector3<f64>,
    /// Duration T in s.
    pub time: f64,
}

/// The share of the way from rest to rest that is done at time `t` of `time` (s),
/// `s(τ) = 10τ³ − 15τ⁴ + 6τ⁵` with τ = t/time, and its first and second derivative in 1/s and 1/s².
///
/// ```
/// use freeplay::mechanism::motion::rest_to_rest;
///
/// let [place, rate, acceleration] = rest_to_rest(0.5, 1.0);
/// assert!((place - 0.5).abs() < 1e-12 && (rate - 1.875).abs() < 1e-12 && acceleration.abs() < 1e-12);
/// ```
pub fn rest_to_rest(t: f64, time: f64) -> [f64; 3] {
    let tau = (t / time).clamp(0.0, 1.0);
    let s = tau * tau * tau * (10.0 + tau * (6.0 * tau - 15.0));
    let ds = 30.0 * (tau * (1.0 - tau)).powi(2) / time;
    let dds = 60.0 * tau * (1.0 - tau) * (1.0 - 2.0 * tau) / (time * time);
    [s, ds, dds]
}

impl Motion for Quintic {
    fn at(&self, t: f64) -> PathPoint {
        let way = self.to - self.from;
        let [s, ds, dds] = rest_to_rest(t, self.time);
        PathPoint { pose: self.from + way * s, rate: way * ds, acceleration: way * dds }
    }

    fn shown_after(&self) -> f64 {
        self.time
    }

    fn fastest_turn(&self) -> f64 {
        self.time
    }
}

/// One term of a [`MultiSine`].
#[derive(Clone, Debug)]
pub struct SineTerm {
    /// Amplitude (m, m, rad).
    pub amplitude: Vector3<f64>,
    /// Frequency f in Hz.
    pub frequency: f64,
    /// Phase in rad.
    pub phase: f64,
}

/// A sum of sines about a centre: centre + Σ amplitude sin(2πft + phase). It excites many
/// frequencies at once, which tells effects apart.
#[derive(Clone, Debug)]
pub struct MultiSine {
    /// Mean pose (m, m, rad).
    pub center: Vector3<f64>,
    /// The terms of the sum.
    pub terms: Vec<SineTerm>,
}

/// `sin(2πft + phase)`, f in Hz, phase in rad, and its first and second derivative in 1/s and 1/s².
pub fn sine(t: f64, frequency: f64, phase: f64) -> [f64; 3] {
    let omega = TAU * frequency;
    let (sin, cos) = (omega * t + phase).sin_cos();
    [sin, omega * cos, -(omega * omega * sin)]
}

impl Motion for MultiSine {
    fn at(&self, t: f64) -> PathPoint {
        let mut point = PathPoint { pose: self.center, ..PathPoint::default() };
        for term in &self.terms {
            let [sin, rate, acceleration] = sine(t, term.frequency, term.phase);
            point.pose += term.amplitude * sin;
            point.rate += term.amplitude * rate;
            point.acceleration += term.amplitude * acceleration;
        }
        point
    }

    fn fastest_turn(&self) -> f64 {
        self.terms.iter().map(|term| 1.0 / term.frequency).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every motion's rate and acceleration against central differences of its pose and rate.
    #[test]
    fn derivatives_belong_to_the_pose() {
        let term =
            |a: [f64; 3], frequency, phase| SineTerm { amplitude: a.into(), frequency, phase };
        let motions: [Box<dyn Motion>; 4] = [
            Box::new(Circle {
                center: [0.01, 0.02].into(),
                radius: 0.05,
                period: 0.7,
                phase: 0.3,
                phi: 0.5,
            }),
            Box::new(Line { start: [0.0, 0.1].into(), velocity: [0.2, -0.1].into(), phi: 0.4 }),
            Box::new(Quintic {
                from: [0.0, 0.0, 0.4].into(),
                to: [0.03, -0.02, 0.6].into(),
                time: 0.8,
            }),
            Box::new(MultiSine {
                center: [0.0, 0.0, 0.5].into(),
                terms: vec![term([0.01, 0.0, 0.1], 1.0, 0.2), term([0.0, 0.02, 0.05], 2.3, 1.0)],
            }),
        ];
        let h = 1e-5;
        for motion in &motions {
            for t in [0.1, 0.25, 0.5, 0.77] {
                let (before, now, after) = (motion.at(t - h), motion.at(t), motion.at(t + h));
                let rate = (after.pose - before.pose) / (2.0 * h);
                let acceleration = (after.rate - before.rate) / (2.0 * h);
                assert!((rate - now.rate).norm() < 1e-8, "{motion:?} at {t}");
                assert!((acceleration - now.acceleration).norm() < 1e-7, "{motion:?} at {t}");
            }
        }
    }

    #[test]
    fn quintic_rests_at_both_ends() {
        let motion = Quintic { from: [0.0; 3].into(), to: [1.0, 2.0, 3.0].into(), time: 2.0 };
        for (t, pose) in
            [(-1.0, [0.0; 3]), (0.0, [0.0; 3]), (2.0, [1.0, 2.0, 3.0]), (9.0, [1.0, 2.0, 3.0])]
        {
            let point = motion.at(t);
            assert_eq!(point.pose, Vector3::from(pose));
            assert_eq!((point.rate.norm(), point.acceleration.norm()), (0.0, 0.0));
        }
    }
}
