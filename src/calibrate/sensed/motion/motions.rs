//! Motions of a machine's geometry that views of recordings show, kept: most effects change neither, and following
//! a motion takes several times as long as asking what it takes.

use super::basis::{Basis, Moved};
use crate::calibrate::sensed::recorded::view::View;
use crate::mechanism::{Closing, Mechanism, Posed, Tracker};
use std::collections::{HashSet, VecDeque};
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// Numbers of eight bytes that kept motions may take together: 256 MB, some ten motions of a machine of seven bodies
/// over three seconds.
const ROOM: usize = 32 << 20;

/// Instants of a motion.
pub type Poses = Arc<Vec<Posed>>;

/// Motions that were asked for more than once.
#[derive(Debug, Default)]
pub struct Motions(Mutex<KeptMotion>);

#[derive(Debug, Default)]
struct KeptMotion {
    /// Digests of what was asked for once: a motion that one look alone needs is not kept.
    once: HashSet<u64>,
    motions: VecDeque<(u64, Poses)>,
}

impl Motions {
    /// The motion that a view shows of a machine at some rows; none where it leads the machine where it cannot be.
    pub fn of(
        &self,
        view: &View,
        mechanism: &Mechanism,
        basis: &Basis,
        rows: Range<usize>,
    ) -> Option<Poses> {
        let moved = basis.moved(view, mechanism);
        let digest = moved.digest() ^ (rows.start as u64).rotate_left(20) ^ rows.end as u64;
        if let Some(known) = self.known(digest) {
            return Some(known);
        }
        let poses = Arc::new(followed(moved, view, rows)?);
        self.keep(digest, &poses);
        Some(poses)
    }

    fn known(&self, digest: u64) -> Option<Poses> {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let place = kept.motions.iter().position(|(known, _)| *known == digest)?;
        // The one that was used last stays longest.
        let known = kept.motions.remove(place)?;
        let poses = Arc::clone(&known.1);
        kept.motions.push_back(known);
        Some(poses)
    }

    fn keep(&self, digest: u64, poses: &Poses) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.once.insert(digest) || kept.motions.iter().any(|(known, _)| *known == digest) {
            return;
        }
        kept.motions.push_back((digest, Arc::clone(poses)));
        let size = |poses: &Poses| poses.iter().map(Posed::size).sum::<usize>();
        let mut sum: usize = kept.motions.iter().map(|(_, poses)| size(poses)).sum();
        while sum > ROOM {
            let Some((_, oldest)) = kept.motions.pop_front() else { break };
            sum -= size(&oldest);
        }
    }
}

fn followed(moved: Moved, view: &View, rows: Range<usize>) -> Option<Vec<Posed>> {
    closed(moved, Closing::Chord, view, rows)
}

fn closed(moved: Moved, closing: Closing, view: &View, rows: Range<usize>) -> Option<Vec<Posed>> {
    let Moved { ideal, imposed, .. } = moved;
    let starts = ideal.bodies.iter().map(|body| body.start).collect();
    let mut tracker = Tracker::new(ideal, imposed, starts, 0.0).ok()?.closing(closing);
    rows.step_by(view.stride)
        .map(|row| {
            tracker.advance(row as f64 * view.interval).ok()?;
            tracker.posed()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::start::machine;
    use super::*;
    use crate::calibrate::sensed::recorded::recording::Recording;
    use crate::calibrate::sensed::residuals::problem::RigProblem;
    use crate::calibrate::sensed::residuals::residual::residuals;
    use crate::effects::{Setting, Target, named};

    /// A recorded slider-crank, and the same with something on its piston, which moves that body's centre of mass.
    fn loaded() -> (Recording, [Mechanism; 2]) {
        let mut problem = RigProblem::planar("planar-1");
        let recording = problem.runs.remove(0).recording;
        let target = Target::Body("piston".to_owned());
        let values = [("mass_kg", 0.1), ("com_x_m", 0.01), ("com_y_m", -0.02)];
        let payload = Setting::on(named("payload").unwrap(), target, &values);
        let machines =
            [vec![], vec![payload]].map(|e| machine(&problem.rig, &e, &recording).unwrap());
        (recording, machines)
    }

    /// To a hundredth of what the finest sensors see of places and a millionth of forces.
    #[test]
    fn old_derivatives_close_joints_as_new_ones_do() {
        let (recording, [plain, _]) = loaded();
        let view = View::new(&recording, plain.sensors.len());
        let basis = Basis::of(&plain, &recording).unwrap();
        let [newton, chord] = [Closing::Newton, Closing::Chord].map(|closing| {
            closed(basis.moved(&view, &plain), closing, &view, view.rows()).unwrap()
        });
        let largest = |of: &dyn Fn(&Posed, &Posed) -> f64| {
            newton.iter().zip(&chord).map(|(a, b)| of(a, b)).fold(0.0, f64::max)
        };
        let off = largest(&|a, b| {
            let pairs = a.angles().iter().zip(b.angles());
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        });
        assert!(off < 1e-10, "{off:e} rad");
        let effort =
            |pose: &Posed| pose.taken(&plain, pose.time(), &[None], &[]).unwrap().efforts[0];
        let size = largest(&|a, _| effort(a).abs());
        let off = largest(&|a, b| (effort(a) - effort(b)).abs());
        assert!(off < 1e-6 * size, "{off:e} of {size} N·m");
    }

    /// A crank that has gone round before the rows that are looked at is as far as it is when all are.
    #[test]
    fn turns_are_counted_from_whatever_row_on() {
        let (recording, [plain, _]) = loaded();
        let view = View::new(&recording, plain.sensors.len());
        let basis = Basis::of(&plain, &recording).unwrap();
        let all = followed(basis.moved(&view, &plain), &view, view.rows()).unwrap();
        let middle = all.len() / 2;
        let rows = view.rows().start + middle * view.stride..view.rows().end;
        let late = followed(basis.moved(&view, &plain), &view, rows).unwrap();
        assert_eq!(late.len(), all.len() - middle);
        assert!(late[0].angles()[0].abs() > 4.0, "{:?}", late[0].angles());
        for (late, whole) in late.iter().zip(&all[middle..]) {
            for (a, b) in late.angles().iter().zip(whole.angles()) {
                assert!((a - b).abs() < 1e-9, "{a} {b} at {}", whole.time());
            }
        }
    }

    #[test]
    fn a_load_leaves_the_motion_and_looks_at_it_through_a_kept_one_are_the_same() {
        let (recording, [plain, loaded]) = loaded();
        let view = View::new(&recording, plain.sensors.len());
        let basis = Basis::of(&plain, &recording).unwrap();
        let digests = [&plain, &loaded].map(|machine| basis.moved(&view, machine).digest());
        assert_eq!(digests[0], digests[1]);
        let look = |machine: &Mechanism, motions: &Motions| {
            residuals(&view, machine, &basis, view.rows(), motions).unwrap().signals
        };
        let kept = Motions::default();
        for _ in 0..2 {
            look(&plain, &kept);
        }
        let [known, fresh] = [&kept, &Motions::default()].map(|motions| look(&loaded, motions));
        let plain = look(&plain, &kept);
        for ((known, fresh), plain) in known.iter().zip(&fresh).zip(&plain) {
            assert_eq!(known.values, fresh.values);
            assert_eq!(known.values.len(), plain.values.len());
        }
        assert!(known.iter().zip(&plain).any(|(a, b)| a.values != b.values));
    }
}
