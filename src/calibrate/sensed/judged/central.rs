//! Where a fixed place pulls a point of the machine, and by how much at each distance.

use super::table_fits::TableFits;
use crate::calibrate::sensed::residuals::problem::{RigProblem, Split};
use crate::calibrate::values::instrument::Replicated;
use crate::effects::{Central, Setting};
use nalgebra::{DMatrix, DVector, Vector2};
use std::f64::consts::FRAC_PI_4;

/// Places along each side of the square where a search begins, and how far it goes beyond what the point passed, as a share of
/// half of that: a pull from farther away is nearly even, and a step leads on to where it comes from.
const PLACES: usize = 7;
const BEYOND: f64 = 1.5;

/// Gaussians along the distance, few at first: many follow what is left near a wrong place, and no step leads on from there.
/// With the last what varies over a tenth of the way is held.
const RINGS: &[usize] = &[4, 8, 16];

/// Looks around a place: as many as halve the distance to a hundredth of where the search began, and some on the way.
const INWARDS: usize = 10;

/// Steps towards the best place, at most: each is right up to the curvature of the residuals.
const STEPS: usize = 8;

/// How often a step that leaves more is halved.
const HALVINGS: usize = 3;

/// Share of what is left by which a step has to improve to go on.
const SETTLED: f64 = 1e-3;

/// Ridge, as a share of the mean square of columns: rings that the point hardly passed stay where they are.
const RIDGE: f64 = 1e-4;

/// Share of the machine's size that a point has to move along x and y.
const MOVES: f64 = 0.02;

/// Displacement that derivatives by the place are taken with, as a share of the farthest distance.
const DERIVED: f64 = 1e-3;

/// A point of the machine and where it was.
struct Passed {
    point: Option<String>,
    places: Vec<Vector2<f64>>,
}

/// A place, the force from there that leaves least, and what it leaves of the residuals.
struct Pulled {
    table: Central,
    columns: DMatrix<f64>,
    left: DVector<f64>,
}

impl Pulled {
    /// Sum of squares of what it leaves, in units of noise.
    fn squares(&self) -> f64 {
        self.left.norm_squared()
    }
}

/// The central force that leaves least of the residuals of all points of the machine, with the share that it removes of what
/// stands above noise in the data that is held back, or the one on the point of a known table; none where no point moves freely
/// enough to tell.
pub(super) fn pull(
    fits: &TableFits<impl Replicated>,
    problem: &RigProblem,
    split: &Split,
    known: Option<&Central>,
) -> Option<(f64, Setting)> {
    let asked = |passed: &Passed| known.is_none_or(|known| known.point == passed.point);
    let first = |passed: Passed| {
        let place = match known {
            Some(known) => Vector2::from(known.place),
            None => begun(fits, &passed)?,
        };
        Some((settled(fits, &passed, place, RINGS[0])?, passed))
    };
    let points = passed(problem, split).into_iter().filter(asked).filter_map(first);
    let (mut best, passed) = points.min_by(|(a, _), (b, _)| a.squares().total_cmp(&b.squares()))?;
    if known.is_none() {
        best = surrounded(fits, &passed, best);
    }
    for rings in &RINGS[1..] {
        best = settled(fits, &passed, best.table.place.into(), *rings)?;
    }
    let (share, weights) = fits.regressed(&units(&best.table), 1)?;
    let coefficients = weights.as_slice().to_vec();
    Some((share, Setting::unnamed_central(Central { coefficients, ..best.table })))
}

/// The force that leaves least around a place, from half the distance of two where the search began inwards: joints lean the
/// other way where a force turns round, which no derivative foretells (a compass search; Kolda, Lewis and Torczon, *SIAM
/// Review* 45, 2003).
fn surrounded(fits: &TableFits<impl Replicated>, passed: &Passed, mut best: Pulled) -> Pulled {
    let extent = [0, 1].map(|k| half_range(&passed.places, k)[1]);
    let mut away = (1.0 + BEYOND) / (PLACES - 1) as f64;
    for _ in 0..INWARDS {
        let around = (0..8).map(|k| f64::from(k) * FRAC_PI_4).filter_map(|angle| {
            let by = Vector2::new(extent[0] * angle.cos(), extent[1] * angle.sin()) * away;
            let place = Vector2::from(best.table.place) + by;
            pulled(fits, passed.towards(place, best.table.coefficients.len()))
        });
        match around.min_by(|a, b| a.squares().total_cmp(&b.squares())) {
            Some(next) if next.squares() < best.squares() => best = next,
            _ => away *= 0.5,
        }
    }
    best
}

/// The force that leaves least near a place, with so many rings.
fn settled(
    fits: &TableFits<impl Replicated>,
    passed: &Passed,
    place: Vector2<f64>,
    rings: usize,
) -> Option<Pulled> {
    let mut best = pulled(fits, passed.towards(place, rings))?;
    for _ in 0..STEPS {
        let before = best.squares();
        let Some(next) = stepped(fits, passed, &best) else { break };
        best = next;
        if best.squares() > before * (1.0 - SETTLED) {
            break;
        }
    }
    Some(best)
}

/// A table with each coefficient alone.
fn units(table: &Central) -> Vec<Setting> {
    let count = table.coefficients.len();
    let unit = |i: usize| {
        let coefficients = (0..count).map(|k| f64::from(u8::from(k == i))).collect();
        Setting::unnamed_central(Central { coefficients, ..table.clone() })
    };
    (0..count).map(unit).collect()
}

/// The output's reference point and every named point that moves along x and y in the data that is fitted to, each place of the
/// machine once.
fn passed(problem: &RigProblem, split: &Split) -> Vec<Passed> {
    let machine = &problem.declared;
    let named = machine.names.points.keys().cloned().map(Some);
    let mut found: Vec<Passed> = Vec::new();
    for point in named.chain([None]) {
        let Some(mark) = Central::empty(point.clone(), [0.0; 2], [0.0; 2], 0).mark(machine) else {
            continue;
        };
        let Some(body) = mark.body else { continue };
        let own = mark.attachment(machine).point;
        let mut places = Vec::new();
        for segment in &split.on {
            let run = &problem.runs[segment.run].view;
            for pose in problem.poses(run, machine, segment).iter().flat_map(|poses| poses.iter()) {
                places.push(pose.states(machine)[body].at(own).position);
            }
        }
        let near = MOVES * machine.size();
        let moves = (0..2).all(|k| half_range(&places, k)[1] > near);
        let again =
            |known: &Passed| known.places.iter().zip(&places).all(|(a, b)| (a - b).norm() < near);
        if moves && !found.iter().any(again) {
            found.push(Passed { point, places });
        }
    }
    found
}

/// Middle and half the range of places along x or y.
fn half_range(places: &[Vector2<f64>], k: usize) -> [f64; 2] {
    let low = places.iter().map(|place| place[k]).fold(f64::INFINITY, f64::min);
    let high = places.iter().map(|place| place[k]).fold(f64::NEG_INFINITY, f64::max);
    [0.5 * (low + high), 0.5 * (high - low)]
}

impl Passed {
    /// A table over the distance from a place that is no force yet.
    fn towards(&self, place: Vector2<f64>, rings: usize) -> Central {
        let distances = self.places.iter().map(|passed| (passed - place).norm());
        let (near, far) =
            distances.fold((f64::INFINITY, 0.0f64), |(near, far), d| (near.min(d), far.max(d)));
        Central::empty(self.point.clone(), place.into(), [near, far], rings)
    }
}

/// The place of a square around what the point passed from which a pull leaves least.
fn begun(fits: &TableFits<impl Replicated>, passed: &Passed) -> Option<Vector2<f64>> {
    let [x, y] = [0, 1].map(|k| half_range(&passed.places, k));
    let along = |[middle, half]: [f64; 2], i: usize| {
        middle + (1.0 + BEYOND) * half * (2.0 * i as f64 / (PLACES - 1) as f64 - 1.0)
    };
    let squares = (0..PLACES * PLACES).filter_map(|i| {
        let place = Vector2::new(along(x, i / PLACES), along(y, i % PLACES));
        Some((place, pulled(fits, passed.towards(place, RINGS[0]))?.squares()))
    });
    squares.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
}

/// Weights of columns that leave least of a residual, and what they leave; the first `count` with a ridge.
fn solved(
    columns: &DMatrix<f64>,
    count: usize,
    white: &DVector<f64>,
) -> Option<(DVector<f64>, DVector<f64>)> {
    let mut normal = columns.transpose() * columns;
    let size = normal.diagonal().rows(0, count).mean();
    for k in 0..normal.nrows() {
        normal[(k, k)] += RIDGE * if k < count { size } else { normal[(k, k)] };
    }
    let weights = normal.cholesky()?.solve(&-(columns.transpose() * white));
    let left = white + columns * &weights;
    left.iter().all(|value| value.is_finite()).then_some((weights, left))
}

/// The force from the place of a table that leaves least.
fn pulled(fits: &TableFits<impl Replicated>, table: Central) -> Option<Pulled> {
    let columns = fits.columns(&units(&table))?;
    let (weights, left) = solved(&columns, columns.ncols(), fits.white())?;
    Some(Pulled {
        table: Central { coefficients: weights.as_slice().to_vec(), ..table },
        columns,
        left,
    })
}

/// A step of place and force together to where they leave less (Gauss and Newton's; Nocedal and Wright, *Numerical
/// Optimization*, §10.3); none where none does.
fn stepped(fits: &TableFits<impl Replicated>, passed: &Passed, from: &Pulled) -> Option<Pulled> {
    let by = DERIVED * from.table.reach[1];
    let place = Vector2::from(from.table.place);
    let moved = [Vector2::x(), Vector2::y()].map(|axis| {
        let place = (place + axis * by).into();
        Setting::unnamed_central(Central { place, ..from.table.clone() })
    });
    let here = &from.left - fits.white();
    let slopes = fits.columns(&moved)?;
    let slopes = DMatrix::from_fn(slopes.nrows(), 2, |r, c| (slopes[(r, c)] - here[r]) / by);
    let count = from.columns.ncols();
    let both = DMatrix::from_fn(here.len(), count + 2, |r, c| {
        if c < count { from.columns[(r, c)] } else { slopes[(r, c - count)] }
    });
    let (weights, _) = solved(&both, count, fits.white())?;
    let mut step = Vector2::new(weights[count], weights[count + 1]);
    let longest = 0.5 * from.table.reach[1];
    if step.norm() > longest {
        step *= longest / step.norm();
    }
    for _ in 0..=HALVINGS {
        let next = pulled(fits, passed.towards(place + step, count))?;
        if next.squares() < from.squares() {
            return Some(next);
        }
        step *= 0.5;
    }
    None
}
