//! A bearing ring that wears: the room that it leaves the journal's centre, grown by what is rubbed off.

use crate::contact::{RingShape, RingTable};
use std::f64::consts::TAU;

/// Rounds of Newton's method in which a depth is sought, on a function of as many straight pieces as directions: ten
/// are enough.
const ROUNDS: usize = 60;

/// Shares into which what is removed at once is divided, all directions taking turns: what one removes lies in the way
/// of the next. With 16, a ring that a turning load wears by a tenth of its clearance stays even to a fiftieth of that;
/// four times as many halve it.
const TURNS: usize = 16;

/// The places that a journal's centre can reach, as the support function w(φ): the farthest that it comes in the
/// direction φ of the ring's body, in m.
///
/// A journal of radius R inside a ring is a point inside the ring shrunk by R (Minkowski difference), and of that only
/// the convex hull counts: a disc cannot make a groove narrower than itself. So w, with w + w″ ≥ 0, is the worn ring's
/// surface less R to first order in clearance over radius, and rubbing that presses the centre a depth d farther in
/// the direction φ adds a point to the hull:
///
/// `w'(ψ) = max(w(ψ), (p(φ) + d n(φ))·n(ψ))`
///
/// with p(φ) the place where the centre was. What is removed is `∫ (w' − w) R dψ` per length of the bearing; under a
/// constant load on a ring at rest, `w = max(c, (c + d) cos ψ)`, the groove of a journal bearing that wears.
///
/// ```
/// use freeplay::contact::Play;
///
/// let mut room = Play::of(0.5e-3, None, 64);
/// assert!((room.mean() - 0.5e-3).abs() < 1e-9);
/// // 1e-9 m² rubbed off in one direction.
/// let mut areas = [0.0; 64];
/// areas[0] = 1e-9;
/// room.wear(&areas, 10e-3);
/// assert!(room.largest() > 0.5e-3 && room.shape(0.5e-3).is_some());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Play {
    support: Vec<f64>,
}

impl Play {
    /// The room in a ring with a radial clearance in m, of this shape if it is not a circle, in so many directions.
    pub fn of(radial: f64, shape: Option<&RingShape>, directions: usize) -> Self {
        let step = TAU / directions as f64;
        let Some(shape) = shape else { return Self { support: vec![radial; directions] } };
        let reach = |i: usize| radial + shape.widening(step * i as f64);
        let reaches: Vec<f64> = (0..directions).map(reach).collect();
        let farthest = |j: usize| {
            let along = |(i, reach): (usize, &f64)| reach * (step * (i as f64 - j as f64)).cos();
            reaches.iter().enumerate().map(along).fold(f64::NEG_INFINITY, f64::max)
        };
        Self { support: (0..directions).map(farthest).collect() }
    }

    /// w in m by direction.
    pub fn support(&self) -> &[f64] {
        &self.support
    }

    /// Mean of w in m: the clearance of the round ring that is as wide in all.
    pub fn mean(&self) -> f64 {
        self.support.iter().sum::<f64>() / self.support.len() as f64
    }

    /// The largest w in m.
    pub fn largest(&self) -> f64 {
        self.support.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    /// The largest difference in m from another room.
    pub fn apart(&self, other: &Self) -> f64 {
        let pairs = self.support.iter().zip(&other.support);
        pairs.fold(0.0, |most, (a, b)| most.max((a - b).abs()))
    }

    /// Removes `areas` of the ring, in m² of its cross section, in each direction; `radius` is the ring's in m.
    pub fn wear(&mut self, areas: &[f64], radius: f64) {
        let per_direction = radius * TAU / self.support.len() as f64;
        let step = TAU / self.support.len() as f64;
        let directions: Vec<[f64; 2]> = (0..self.support.len())
            .map(|k| {
                let (sin, cos) = (step * k as f64).sin_cos();
                [cos, sin]
            })
            .collect();
        let mut worn: Vec<usize> = (0..areas.len()).filter(|&i| areas[i] > 0.0).collect();
        for _ in 0..TURNS {
            for &i in &worn {
                self.press(i, areas[i] / TURNS as f64 / per_direction, &directions);
            }
            // There and back, so that no sense of turning is preferred.
            worn.reverse();
        }
    }

    /// Presses the centre farther in the direction `i` until the sum of what w grows by is `growth` m; `directions` are
    /// cosine and sine of each from the first.
    fn press(&mut self, i: usize, growth: f64, directions: &[[f64; 2]]) {
        let n = self.support.len();
        let [before, here, after] = [n - 1, 0, 1].map(|by| self.support[(i + by) % n]);
        let aside = (after - before) / (2.0 * directions[1][1]);
        // Alone it would have to go so deep. What w grows by is convex in the depth: Newton's method comes from above.
        let mut depth = growth;
        for _ in 0..ROUNDS {
            let (mut total, mut slope) = (0.0, 0.0);
            self.seen_from(i, [here + depth, aside], directions, |_, rise, cos| {
                total += rise;
                slope += cos;
            });
            let next = depth - (total - growth) / slope;
            if next >= depth {
                break;
            }
            depth = next;
        }
        let mut grown = Vec::new();
        self.seen_from(i, [here + depth, aside], directions, |j, rise, _| grown.push((j, rise)));
        for (j, rise) in grown {
            self.support[j] += rise;
        }
    }

    /// Each direction in which a point beyond the room is farther than that, by how much, and the cosine of the angle
    /// from the direction `i`: an arc round it. The point is given along and across that direction.
    fn seen_from(
        &self,
        i: usize,
        [along, across]: [f64; 2],
        directions: &[[f64; 2]],
        mut see: impl FnMut(usize, f64, f64),
    ) {
        let n = self.support.len();
        for side in [1.0, -1.0] {
            let first = usize::from(side < 0.0);
            for (k, [cos, sin]) in directions.iter().enumerate().take(n / 2).skip(first) {
                let j = if side > 0.0 { i + k } else { i + n - k } % n;
                let rise = along * cos + side * across * sin - self.support[j];
                if rise <= 0.0 {
                    break;
                }
                see(j, rise, *cos);
            }
        }
    }

    /// What the ring is wider by than its clearance `radial` (m), in each direction of the eccentricity: how far the centre
    /// comes, `min_φ w(φ)/cos(θ − φ)`, averaged over neighbours with the weights of a cubic B-spline, 1 : 4 : 1, so that the
    /// spline through it does not overshoot at corners.
    pub fn widening(&self, radial: f64) -> Vec<f64> {
        let n = self.support.len();
        let step = TAU / n as f64;
        let reach = |i: usize| {
            let met = |(j, w): (usize, &f64)| {
                let cos = (step * (i as f64 - j as f64)).cos();
                if cos > 0.0 { w / cos } else { f64::INFINITY }
            };
            self.support.iter().enumerate().map(met).fold(f64::INFINITY, f64::min) - radial
        };
        let reaches: Vec<f64> = (0..n).map(reach).collect();
        let near = |i: usize, by: usize| reaches[(i + by) % n];
        (0..n).map(|i| (near(i, n - 1) + 4.0 * near(i, 0) + near(i, 1)) / 6.0).collect()
    }

    /// The same as the shape of a ring with the clearance `radial` (m).
    pub fn shape(&self, radial: f64) -> Option<RingShape> {
        RingTable::new(&self.widening(radial)).map(RingShape::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::OutOfRound;

    const RADIUS: f64 = 0.01;
    const CLEARANCE: f64 = 1e-4;
    const DIRECTIONS: usize = 360;

    /// `2 R (e sin φ₀ − c φ₀)`, `cos φ₀ = c/e`: what a journal removes that a load in one direction has brought e from
    /// the centre of a round ring.
    fn groove(e: f64) -> f64 {
        let edge = (CLEARANCE / e).acos();
        2.0 * RADIUS * (e * edge.sin() - CLEARANCE * edge)
    }

    #[test]
    fn a_load_in_one_direction_wears_archards_groove() {
        for deep in [0.02, 0.1, 0.5] {
            let e = CLEARANCE * (1.0 + deep);
            let mut areas = vec![0.0; DIRECTIONS];
            areas[270] = groove(e);
            let mut play = Play::of(CLEARANCE, None, DIRECTIONS);
            play.wear(&areas, RADIUS);
            let found = play.largest() / CLEARANCE - 1.0;
            // A degree is a tenth of the groove's half width at a depth of 0.02.
            assert!((found / deep - 1.0).abs() < 2e-3, "{deep}: {found}");
            // In however many portions it comes.
            let mut portions = Play::of(CLEARANCE, None, DIRECTIONS);
            for _ in 0..5 {
                portions.wear(&areas.iter().map(|a| a / 5.0).collect::<Vec<_>>(), RADIUS);
            }
            assert!(portions.apart(&play) < 1e-9 * CLEARANCE);
        }
    }

    #[test]
    fn what_is_removed_is_what_was_rubbed_off() {
        let areas: Vec<f64> =
            (0..DIRECTIONS).map(|i| 1e-9 * (0.1 * i as f64).sin().max(0.0).powi(2)).collect();
        let mut play = Play::of(CLEARANCE, None, DIRECTIONS);
        play.wear(&areas, RADIUS);
        let removed = TAU * RADIUS * (play.mean() - CLEARANCE);
        let rubbed: f64 = areas.iter().sum();
        assert!((removed / rubbed - 1.0).abs() < 1e-9, "{removed} {rubbed}");
    }

    #[test]
    fn a_load_that_turns_leaves_the_ring_round() {
        let depth = 1e-5;
        let areas = vec![depth * RADIUS * TAU / DIRECTIONS as f64; DIRECTIONS];
        let mut play = Play::of(CLEARANCE, None, DIRECTIONS);
        play.wear(&areas, RADIUS);
        assert!((play.mean() / (CLEARANCE + depth) - 1.0).abs() < 1e-12);
        let round = Play::of(CLEARANCE + depth, None, DIRECTIONS);
        assert!(play.apart(&round) < 0.03 * depth, "{}", play.apart(&round) / depth);
    }

    #[test]
    fn a_shape_and_back_is_the_same_room() {
        let wave = RingShape::from(OutOfRound { amplitude: 5e-6, lobes: 2.0, direction: 0.4 });
        let play = Play::of(CLEARANCE, Some(&wave), DIRECTIONS);
        let again = Play::of(CLEARANCE, play.shape(CLEARANCE).as_ref(), DIRECTIONS);
        assert!(play.apart(&again) < 1e-3 * 5e-6, "{}", play.apart(&again));
        let wider = play.widening(CLEARANCE);
        assert!((wider[0] - 5e-6 * 0.8f64.cos()).abs() < 1e-2 * 5e-6, "{}", wider[0]);
    }
}
