//! Thinning of long signals in constant memory, one sample at a time.
//!
//! An impact lasts a few steps out of millions. Keeping every n-th sample would lose it, so a signal
//! over time is kept as the lowest and highest sample of each stretch ([`Envelope`]). A curve in the
//! plane has no "highest" point; there every n-th point is enough ([`Trace`]).

/// A sample of a signal: (time, value), in whatever units the caller uses.
type TimedValue = (f64, f64);

/// The two extreme samples of a stretch of the signal, the one that occurred first in front.
/// A stretch of a single sample holds it twice.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bucket(TimedValue, TimedValue);

impl Bucket {
    /// The stretch that covers `self` and then `next`.
    ///
    /// Of equal samples the first lowest and the last highest are taken, so that a constant signal
    /// keeps its full time span.
    fn followed_by(self, next: Bucket) -> Bucket {
        let samples = [self.0, self.1, next.0, next.1];
        let (mut lowest, mut highest) = (0, 0);
        for (i, sample) in samples.iter().enumerate() {
            if sample.1 < samples[lowest].1 {
                lowest = i;
            }
            if sample.1 >= samples[highest].1 {
                highest = i;
            }
        }
        Bucket(samples[lowest.min(highest)], samples[lowest.max(highest)])
    }
}

/// A signal over time, thinned to its envelope: no peak is lost, memory does not grow.
///
/// Up to its capacity it holds every sample. Each time it is full, neighbouring buckets are merged in
/// pairs and every later bucket takes twice as many samples.
///
/// ```
/// use freeplay::measure::envelope::Envelope;
///
/// let mut signal = Envelope::new(10);
/// for i in 0..10_000 {
///     signal.push(f64::from(i), if i == 777 { 5.0 } else { 0.0 });
/// }
/// assert!(signal.points().len() <= 20);
/// assert_eq!(signal.extent(), Some((0.0, 5.0)), "no peak is lost");
/// ```
#[derive(Debug, Clone)]
pub struct Envelope {
    buckets: Vec<Bucket>,
    capacity: usize,
    /// How many samples a full bucket holds: 1, 2, 4, …
    samples_per_bucket: usize,
    /// How many samples the last bucket holds so far.
    filled: usize,
}

impl Envelope {
    /// An empty envelope of at most `capacity` buckets (rounded up to an even number, at least 2).
    pub fn new(capacity: usize) -> Self {
        Envelope {
            buckets: Vec::new(),
            // Even, so that merging in pairs never leaves a half-filled bucket behind.
            capacity: capacity.max(2).next_multiple_of(2),
            samples_per_bucket: 1,
            filled: 0,
        }
    }

    /// Takes the next sample. A sample that is not a finite number has no place between a minimum and
    /// a maximum: it is skipped.
    pub fn push(&mut self, t: f64, value: f64) {
        if !t.is_finite() || !value.is_finite() {
            return;
        }
        let sample = Bucket((t, value), (t, value));
        if self.filled < self.samples_per_bucket
            && let Some(last) = self.buckets.last_mut()
        {
            *last = last.followed_by(sample);
            self.filled += 1;
            return;
        }
        if self.buckets.len() == self.capacity {
            self.merge_pairs();
        }
        self.buckets.push(sample);
        self.filled = 1;
    }

    fn merge_pairs(&mut self) {
        let half = self.buckets.len() / 2;
        for i in 0..half {
            self.buckets[i] = self.buckets[2 * i].followed_by(self.buckets[2 * i + 1]);
        }
        self.buckets.truncate(half);
        self.samples_per_bucket *= 2;
    }

    /// The signal as a polyline of (time, value): the lowest and the highest sample of each bucket, in
    /// the order in which they occurred. At most two points per bucket.
    pub fn points(&self) -> Vec<(f64, f64)> {
        let mut points = Vec::with_capacity(2 * self.buckets.len());
        for Bucket(first, second) in &self.buckets {
            points.push(*first);
            if second != first {
                points.push(*second);
            }
        }
        points
    }

    /// The lowest and the highest value of all samples taken; `None` before the first.
    pub fn extent(&self) -> Option<(f64, f64)> {
        let values = || self.buckets.iter().flat_map(|b| [b.0.1, b.1.1]);
        Some((values().reduce(f64::min)?, values().reduce(f64::max)?))
    }
}

/// A curve in the plane, thinned evenly: every point until it is full, then every 2nd, every 4th, …
///
/// ```
/// use freeplay::measure::envelope::Trace;
///
/// let mut path = Trace::new(100);
/// for i in 0..1000 {
///     path.push([f64::from(i), 0.0]);
/// }
/// assert!(path.points().len() <= 100);
/// assert_eq!(path.points()[0], [0.0, 0.0]);
/// ```
#[derive(Debug, Clone)]
pub struct Trace {
    points: Vec<[f64; 2]>,
    capacity: usize,
    /// One point in so many is kept.
    stride: usize,
    seen: usize,
}

impl Trace {
    /// An empty trace of at most `capacity` points (at least 2).
    pub fn new(capacity: usize) -> Self {
        Trace { points: Vec::new(), capacity: capacity.max(2), stride: 1, seen: 0 }
    }

    /// Takes the next point of the curve.
    pub fn push(&mut self, point: [f64; 2]) {
        if self.seen.is_multiple_of(self.stride) && self.points.len() == self.capacity {
            let mut keep = false;
            self.points.retain(|_| {
                keep = !keep;
                keep
            });
            self.stride *= 2;
        }
        if self.seen.is_multiple_of(self.stride) {
            self.points.push(point);
        }
        self.seen += 1;
    }

    /// The points kept, in the order in which they were taken.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_envelope_has_nothing_to_show() {
        let envelope = Envelope::new(8);
        assert!(envelope.points().is_empty());
        assert_eq!(envelope.extent(), None);
        assert!(Trace::new(8).points().is_empty());
    }

    #[test]
    fn up_to_its_capacity_an_envelope_keeps_every_sample() {
        let mut envelope = Envelope::new(8);
        let samples: Vec<_> = (0..8).map(|i| (f64::from(i), f64::from(i * i % 5))).collect();
        for &(t, v) in &samples {
            envelope.push(t, v);
        }
        assert_eq!(envelope.points(), samples);
    }

    #[test]
    fn peaks_survive_many_merges_at_their_own_time() {
        let mut envelope = Envelope::new(16);
        for i in 0..100_000 {
            let value = match i {
                12_345 => 40.0,
                12_346 => -30.0,
                _ => (f64::from(i) * 0.01).sin(),
            };
            envelope.push(f64::from(i), value);
        }
        assert_eq!(envelope.extent(), Some((-30.0, 40.0)));
        let points = envelope.points();
        let up = points.iter().position(|p| *p == (12_345.0, 40.0));
        let down = points.iter().position(|p| *p == (12_346.0, -30.0));
        assert_eq!(up.map(|i| i + 1), down, "in the order of occurrence");
        assert!(points.is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn memory_stays_within_the_capacity() {
        let mut envelope = Envelope::new(7);
        let mut trace = Trace::new(7);
        for i in 0..10_000 {
            let x = f64::from(i);
            envelope.push(x, x.sin());
            trace.push([x, x]);
            assert!(envelope.buckets.len() <= 8);
            assert!(envelope.points().len() <= 16);
            assert!(trace.points().len() <= 7);
        }
    }

    #[test]
    fn a_constant_signal_keeps_its_time_span() {
        let mut envelope = Envelope::new(2);
        for i in 0..64 {
            envelope.push(f64::from(i), 3.0);
        }
        let points = envelope.points();
        assert_eq!(points.first(), Some(&(0.0, 3.0)));
        assert_eq!(points.last(), Some(&(63.0, 3.0)));
    }

    #[test]
    fn samples_that_are_not_numbers_are_skipped() {
        let mut envelope = Envelope::new(4);
        envelope.push(0.0, f64::NAN);
        envelope.push(1.0, 2.0);
        envelope.push(2.0, f64::INFINITY);
        assert_eq!(envelope.points(), vec![(1.0, 2.0)]);
    }

    #[test]
    fn a_full_trace_keeps_every_second_then_every_fourth_point() {
        let mut trace = Trace::new(4);
        for i in 0..4 {
            trace.push([f64::from(i), 0.0]);
        }
        assert_eq!(trace.points().len(), 4);
        for i in 4..9 {
            trace.push([f64::from(i), 0.0]);
        }
        let kept: Vec<_> = trace.points().iter().map(|p| p[0]).collect();
        assert_eq!(kept, [0.0, 4.0, 8.0]);
    }
}
