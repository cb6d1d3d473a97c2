//! What can be said of a motion before anything is simulated: strokes and singularities.

use super::Geometry;
use crate::mechanism::motion::{Motion, looks};

/// A leg that a motion would drive out of its stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeBreach {
    /// Leg, 1…3.
    pub leg: usize,
    /// Time in s at which the leg is farthest out of its stroke.
    pub t: f64,
    /// Length asked for in m.
    pub length: f64,
}

/// Extremes of a motion over its duration.
#[derive(Clone, Debug, PartialEq)]
pub struct Reach {
    /// Shortest and longest length of each leg in m.
    pub lengths: [[f64; 2]; 3],
    /// The worst breach of the stroke, leg by leg.
    pub breaches: Vec<StrokeBreach>,
    /// Smallest distance from singularity in m (see [`Geometry::singularity_distance`]); zero when
    /// the motion passes through one.
    pub singularity_distance: f64,
    /// When it comes closest, in s.
    pub singularity_time: f64,
    /// Largest speed of a leg in m/s.
    pub fastest_leg: f64,
}

/// Looks at a motion over `duration` s as finely as it turns ([`looks`]), 2000 times at least; a change of sign
/// between two looks counts as a passage.
///
/// ```
/// use freeplay::mechanism::motion::Circle;
/// use freeplay::mechanism::three_rpr::{Geometry, reach};
/// use nalgebra::Vector2;
///
/// let paper = Geometry { base_side: 0.66, platform_side: 0.1 };
/// let circle = Circle { center: Vector2::zeros(), radius: 0.05, period: 2.0, phase: 0.0, phi: 0.5 };
/// let found = reach(&paper, &circle, 2.0, [0.2, 0.5]);
/// assert!(found.breaches.is_empty() && found.singularity_distance > 0.0);
/// assert!(!reach(&paper, &circle, 2.0, [0.2, found.lengths[0][1] - 1e-3]).breaches.is_empty(), "1 mm too short");
/// ```
pub fn reach(geometry: &Geometry, motion: &dyn Motion, duration: f64, stroke: [f64; 2]) -> Reach {
    const FEWEST: usize = 2000;
    let mut reach = Reach {
        lengths: [[f64::INFINITY, 0.0]; 3],
        breaches: Vec::new(),
        singularity_distance: f64::INFINITY,
        singularity_time: 0.0,
        fastest_leg: 0.0,
    };
    let mut worst: [Option<(f64, StrokeBreach)>; 3] = [None; 3];
    let mut before = None;
    for t in looks(motion, duration, FEWEST) {
        let point = motion.at(t);
        for (i, command) in geometry.inverse(&point).iter().enumerate() {
            let [low, high] = &mut reach.lengths[i];
            *low = low.min(command.position);
            *high = high.max(command.position);
            reach.fastest_leg = reach.fastest_leg.max(command.rate.abs());
            let excess = (stroke[0] - command.position).max(command.position - stroke[1]);
            if excess > 0.0 && worst[i].is_none_or(|(e, _)| excess > e) {
                let breach = StrokeBreach { leg: i + 1, t, length: command.position };
                worst[i] = Some((excess, breach));
            }
        }
        let signed = geometry.singularity_distance(point.pose);
        let passes = before.is_some_and(|b: f64| b * signed < 0.0);
        let distance = if passes { 0.0 } else { signed.abs() };
        if distance < reach.singularity_distance {
            reach.singularity_distance = distance;
            reach.singularity_time = t;
        }
        before = Some(signed);
    }
    reach.breaches = worst.into_iter().flatten().map(|(_, breach)| breach).collect();
    reach
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::motion::{Circle, Quintic};
    use std::f64::consts::PI;

    const PAPER: Geometry = Geometry { base_side: 0.66, platform_side: 0.1 };
    const STROKE: [f64; 2] = [0.2, 0.4];

    fn circle(radius: f64) -> Circle {
        Circle { center: [0.0, 0.0].into(), radius, period: 1.0, phase: 0.0, phi: PI / 6.0 }
    }

    #[test]
    fn default_circle_is_in_reach() {
        let reach = reach(&PAPER, &circle(0.05), 1.0, STROKE);
        assert!(reach.breaches.is_empty());
        assert!(reach.singularity_distance > 0.02);
    }

    #[test]
    fn a_wide_circle_leaves_the_stroke_of_every_leg() {
        let reach = reach(&PAPER, &circle(0.09), 1.0, STROKE);
        assert_eq!(reach.breaches.iter().map(|b| b.leg).collect::<Vec<_>>(), [1, 2, 3]);
        assert!(reach.breaches.iter().all(|b| b.length > 0.4));
    }

    /// 2000 samples over 40 s were one every whole period of 20 ms, always at the same point.
    #[test]
    fn a_fast_motion_is_seen_however_long_it_lasts() {
        let fast = Circle { period: 0.02, ..circle(0.07) };
        let [short, long] = [1.0, 40.0].map(|duration| reach(&PAPER, &fast, duration, STROKE));
        assert_eq!(short.breaches.len(), 3);
        assert_eq!(short.lengths, long.lengths);
    }

    #[test]
    fn passing_phi_zero_between_two_samples_is_seen() {
        let motion =
            Quintic { from: [0.0, 0.0, 0.3].into(), to: [0.0, 0.0, -0.311].into(), time: 1.0 };
        let reach = reach(&PAPER, &motion, 1.0, STROKE);
        assert_eq!(reach.singularity_distance, 0.0);
        assert!((reach.singularity_time - 0.5).abs() < 0.02);
    }
}
