//! A film of a long run in constant memory: snapshots, and what signals did between them.

/// One picture of a film.
///
/// [`Frames`] has an example.
#[derive(Debug, Clone, PartialEq)]
pub struct FilmFrame {
    /// When, in s.
    pub t: f64,
    /// What is so at that instant, in whatever units the caller uses.
    pub values: Vec<f32>,
    /// Lowest and highest value of each signal since the frame before, this instant included.
    pub extremes: Vec<[f32; 2]>,
}

impl FilmFrame {
    /// Makes the extremes cover those of the frame before too.
    fn include(&mut self, earlier: &FilmFrame) {
        for (mine, other) in self.extremes.iter_mut().zip(&earlier.extremes) {
            *mine = [mine[0].min(other[0]), mine[1].max(other[1])];
        }
    }
}

/// Snapshots of a run, thinned evenly: every one until it is full, then every 2nd, every 4th, … What
/// a signal did at the instants left out goes into the extremes of the next frame, so no peak is lost.
///
/// ```
/// use freeplay::measure::frames::{FilmFrame, Frames};
///
/// let mut film = Frames::new(8);
/// for i in 0..100 {
///     let force = if i == 33 { 50.0 } else { 1.0 };
///     film.push(FilmFrame { t: f64::from(i), values: vec![0.0], extremes: vec![[force; 2]] });
/// }
/// assert!(film.thinned() && film.all().count() <= 9);
/// assert!(film.all().any(|frame| frame.extremes[0][1] == 50.0), "what happened between frames is kept");
/// ```
#[derive(Debug, Clone)]
pub struct Frames {
    kept: Vec<FilmFrame>,
    capacity: usize,
    /// One snapshot in so many is kept.
    stride: usize,
    seen: usize,
    /// The last snapshot, while it is not kept; its extremes cover all since the last frame kept.
    waiting: Option<FilmFrame>,
}

impl Frames {
    /// No frames yet, and never more than `capacity` (at least 2) and the last snapshot.
    pub fn new(capacity: usize) -> Self {
        Self { kept: Vec::new(), capacity: capacity.max(2), stride: 1, seen: 0, waiting: None }
    }

    /// Takes the next snapshot.
    pub fn push(&mut self, mut frame: FilmFrame) {
        if let Some(earlier) = self.waiting.take() {
            frame.include(&earlier);
        }
        if self.seen.is_multiple_of(self.stride)
            && self.kept.len() == self.capacity
            && let Some(earlier) = self.halve()
        {
            frame.include(&earlier);
        }
        if self.seen.is_multiple_of(self.stride) {
            self.kept.push(frame);
        } else {
            self.waiting = Some(frame);
        }
        self.seen += 1;
    }

    /// Lets every second frame go; the first one stays. Returns the last one if it went and no frame
    /// that stays follows it.
    fn halve(&mut self) -> Option<FilmFrame> {
        self.stride *= 2;
        let mut last = None;
        for mut frame in std::mem::take(&mut self.kept) {
            match last.take() {
                None if !self.kept.is_empty() => last = Some(frame),
                None => self.kept.push(frame),
                Some(gone) => {
                    frame.include(&gone);
                    self.kept.push(frame);
                }
            }
        }
        last
    }

    /// All frames in order of time, the last snapshot taken among them.
    pub fn all(&self) -> impl Iterator<Item = &FilmFrame> {
        self.kept.iter().chain(&self.waiting)
    }

    /// Whether snapshots were left out.
    pub fn thinned(&self) -> bool {
        self.stride > 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film(capacity: usize, count: usize, signal: impl Fn(usize) -> f32) -> Frames {
        let mut frames = Frames::new(capacity);
        for i in 0..count {
            let extremes = vec![[signal(i); 2]];
            frames.push(FilmFrame { t: i as f64, values: vec![i as f32], extremes });
        }
        frames
    }

    #[test]
    fn until_it_is_full_every_snapshot_is_kept() {
        let frames = film(8, 8, |i| i as f32);
        assert_eq!(frames.all().count(), 8);
        assert!(!frames.thinned());
        assert!(frames.all().all(|f| f.extremes == [[f.t as f32; 2]]));
    }

    /// Whatever the number of snapshots, each peak is in the frame that ends its stretch.
    #[test]
    fn no_peak_is_lost_and_the_ends_are_there() {
        for capacity in [2, 3, 4, 7, 8] {
            for count in 1..70 {
                for peak in 0..count {
                    let frames = film(capacity, count, |i| if i == peak { 9.0 } else { 1.0 });
                    let times: Vec<f64> = frames.all().map(|f| f.t).collect();
                    let case = format!("{capacity} {count} {peak}: {times:?}");
                    assert!(times.len() <= capacity + 1, "{case}");
                    assert_eq!((times[0], times[times.len() - 1]), (0.0, (count - 1) as f64));
                    assert!(times.is_sorted_by(|a, b| a < b), "{case}");
                    let high: Vec<f64> =
                        frames.all().filter(|f| f.extremes[0][1] == 9.0).map(|f| f.t).collect();
                    let end = times.iter().copied().find(|t| *t >= peak as f64);
                    assert_eq!(high, [end.expect("the last one ends it")], "{case}");
                }
            }
        }
    }
}
