//! The end of a long curve.

use std::collections::VecDeque;

/// The last so many points of a curve in the plane. A thinned curve that turns round and round would
/// show chords that nothing ever moved along; its end, whole, shows what it does.
#[derive(Debug)]
pub(super) struct Recent {
    points: VecDeque<[f64; 2]>,
    capacity: usize,
    /// Whether earlier points were let go.
    pub truncated: bool,
}

impl Recent {
    /// No points yet, and never more than `capacity`.
    pub fn new(capacity: usize) -> Self {
        Self { points: VecDeque::new(), capacity, truncated: false }
    }

    /// Takes the next point.
    pub fn push(&mut self, point: [f64; 2]) {
        if self.points.len() == self.capacity {
            self.points.pop_front();
            self.truncated = true;
        }
        self.points.push_back(point);
    }

    /// Every n-th of the points kept, the last one among them, so that there are at most `count`.
    pub fn points(&self, count: usize) -> Vec<[f64; 2]> {
        let stride = self.points.len().div_ceil(count).max(1);
        let mut points: Vec<_> = self.points.iter().rev().step_by(stride).copied().collect();
        points.reverse();
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_is_kept() {
        let mut recent = Recent::new(10);
        for i in 0..10 {
            recent.push([f64::from(i), 0.0]);
        }
        assert!(!recent.truncated && recent.points(10).len() == 10);
        for i in 10..13 {
            recent.push([f64::from(i), 0.0]);
        }
        let thinned: Vec<f64> = recent.points(4).iter().map(|p| p[0]).collect();
        assert!(recent.truncated);
        assert_eq!(thinned, [3.0, 6.0, 9.0, 12.0]);
    }
}
