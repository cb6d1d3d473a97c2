//! How many ways a mechanism without clearance can move, which of them are driven, and which joints say
//! the same twice.

use super::assembly::matrix;
use super::rows::Row;
use super::tracker::Place;
use crate::mechanism::{Attachment, Bearing, BodyState, Command, Drive, JointIndex, Mechanism};
use nalgebra::{DMatrix, DVector, UnitComplex, Vector2, Vector3};

/// Share of the largest squared singular value below which one is zero: a thousand times its rounding.
const ZERO: f64 = 1e-13;

/// Share of a unit vector below which a joint or a body has no part in it.
const NO_PART: f64 = 1e-6;

/// How a mechanism can move at a pose.
///
/// ```
/// use freeplay::prelude::*;
///
/// let mechanism = assemble(&Scenario::load(None, &["contact.law=\"ideal\"".to_owned()])?)?.mechanism;
/// let states: Vec<BodyState> = mechanism.bodies.iter().map(|body| body.start).collect();
/// let freedoms = mechanism.freedoms(&states);
/// assert_eq!((freedoms.counted, freedoms.free, freedoms.driven), (3, 3, 3), "three legs drive a platform");
/// assert!(freedoms.redundant.is_empty() && freedoms.loose.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Freedoms {
    /// By Grübler's count: three for each body less one for each row of a joint.
    pub counted: i64,
    /// By the rank of the joints' Jacobian.
    pub free: usize,
    /// Joints whose rows depend on each other.
    pub redundant: Vec<JointIndex>,
    /// Freedoms that drives with a command determine.
    pub driven: usize,
    /// Drives with a command that ask for more than there is freedom.
    pub overdriven: Vec<usize>,
    /// Bodies that can move although every drive holds.
    pub loose: Vec<usize>,
}

impl Mechanism {
    /// The same mechanism without clearance, its drives with a command prescribed: what moves where nothing
    /// gives way.
    pub fn without_clearance(&self) -> Self {
        let mut ideal = self.clone();
        ideal.revolutes.retain(|joint| !joint.is_corner());
        for joint in &mut ideal.prismatics {
            joint.play = false;
        }
        for joint in &mut ideal.revolutes {
            joint.bearing = Bearing::Ideal;
            joint.out_of_round = None;
        }
        for actuator in &mut ideal.actuators {
            if actuator.drive != Drive::Effort {
                actuator.drive = Drive::Prescribed;
            }
        }
        ideal
    }

    /// The geometry alone: the same mechanism without clearance, each body's centre of mass where its reference
    /// point is, and all points on a grid far finer than any machine is made. What has been put on bodies, or
    /// changed of their masses, leaves it the same to the last bit.
    pub fn geometry(&self) -> Self {
        /// Steps of a metre and of a radian: a tenth of a picometre, where rounding is a thousandth of that, and a
        /// micrometre for starts, which are only near.
        const GRIDS: [f64; 2] = [(1u64 << 43) as f64, (1u64 << 20) as f64];
        // No minus before a zero.
        let on = |grid: f64| move |x: f64| (x * grid).round() / grid + 0.0;
        let mut geometry = self.without_clearance();
        for (i, body) in self.bodies.iter().enumerate() {
            geometry.set_mass(i, body.mass, body.reference, body.inertia);
        }
        let revolutes = geometry.revolutes.iter_mut().flat_map(|j| [&mut j.ring, &mut j.journal]);
        let prismatics = geometry.prismatics.iter_mut().flat_map(|j| [&mut j.base, &mut j.slider]);
        for attachment in revolutes.chain(prismatics) {
            attachment.point = attachment.point.map(on(GRIDS[0]));
        }
        for body in &mut geometry.bodies {
            body.reference = Vector2::zeros();
            body.start.position = body.start.position.map(on(GRIDS[1]));
            body.start.rotation = UnitComplex::new(on(GRIDS[1])(body.start.rotation.angle()));
            body.start.twist.fill(0.0);
        }
        geometry
    }

    /// How the mechanism, without clearance, can move at the given states.
    pub fn freedoms(&self, states: &[BodyState]) -> Freedoms {
        let commands = vec![Command::default(); self.actuators.len()];
        let closure = self.closure(states, &commands);
        let bodies = states.len();
        let all = self.scaled(matrix(&closure.rows, bodies));
        let passive: Vec<usize> =
            (0..closure.rows.len()).filter(|&i| closure.driven[i].is_none()).collect();
        let joints = all.select_rows(&passive);
        let (rank, dependent) = dependent_rows(&joints);
        let mut redundant: Vec<JointIndex> = Vec::new();
        for row in dependent {
            let joint = closure.joints[passive[row]];
            if !redundant.contains(&joint) {
                redundant.push(joint);
            }
        }
        let (whole, dependent) = dependent_rows(&all);
        let drives = closure.rows.len() - passive.len();
        let overdriven = if whole - rank < drives {
            dependent.into_iter().filter_map(|row| closure.driven[row]).collect()
        } else {
            Vec::new()
        };
        Freedoms {
            counted: 3 * bodies as i64 - passive.len() as i64,
            free: 3 * bodies - rank,
            redundant,
            driven: whole - rank,
            overdriven,
            loose: loose(&all, bodies),
        }
    }

    /// Which of these places, one after another, say something of how the mechanism, without clearance, stands at the given
    /// states that drives' coordinates and those before do not. None where all of them together leave it a freedom.
    pub fn determining(&self, states: &[BodyState], places: &[Place]) -> Option<Vec<usize>> {
        let commands = vec![Command::default(); self.actuators.len()];
        let mut rows = self.closure(states, &commands).rows;
        let rank = |rows: &[Row]| dependent_rows(&self.scaled(matrix(rows, states.len()))).0;
        let (mut known, mut chosen) = (rank(&rows), Vec::new());
        for (i, place) in places.iter().enumerate() {
            let Some((row, _)) = place.row(states, 0.0) else { continue };
            rows.push(row);
            let with = rank(&rows);
            if with > known {
                chosen.push(i);
                known = with;
            } else {
                rows.pop();
            }
        }
        (known == 3 * states.len()).then_some(chosen)
    }

    /// Columns of angles as arcs at the distance of the mechanism's size, so that all are in m.
    fn scaled(&self, mut matrix: DMatrix<f64>) -> DMatrix<f64> {
        let size = self.size();
        for (i, mut column) in matrix.column_iter_mut().enumerate() {
            if i % 3 == 2 {
                column /= size;
            }
        }
        matrix
    }

    /// How well the drives hold the mechanism at the given states: see [`Hold`]. None where joints depend
    /// on each other or drives do not determine the motion.
    pub fn hold(&self, states: &[BodyState]) -> Option<Hold> {
        let commands = vec![Command::default(); self.actuators.len()];
        let closure = self.closure(states, &commands);
        let bodies = states.len();
        if closure.rows.len() != 3 * bodies {
            return None;
        }
        let scaled = self.scaled(matrix(&closure.rows, bodies));
        if scaled.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let factors = scaled.lu();
        let sign = factors.determinant().signum();
        let mut hold = Hold { sign, share: f64::INFINITY, drive: 0 };
        let size = self.size();
        for (row, drive) in closure.driven.iter().enumerate() {
            let Some(drive) = *drive else { continue };
            let mut unit = DVector::zeros(closure.rows.len());
            unit[row] = self.reach(drive).recip();
            let fastest = factors.solve(&unit).map_or(f64::INFINITY, |mut motion| {
                for body in 0..bodies {
                    motion[3 * body + 2] /= size;
                }
                self.fastest_point(states, &motion)
            });
            let share = if fastest.is_nan() { 0.0 } else { 1.0 / fastest };
            if share < hold.share {
                (hold.share, hold.drive) = (share, drive);
            }
        }
        Some(hold)
    }

    /// What turns a drive's rate into a speed: 1 of a prismatic joint; of a revolute one the largest distance
    /// (m) of a joint on its two bodies from it.
    fn reach(&self, drive: usize) -> f64 {
        let JointIndex::Revolute(index) = self.actuators[drive].joint else { return 1.0 };
        let joint = &self.revolutes[index];
        let mut reach = 0.0f64;
        for pivot in [&joint.ring, &joint.journal] {
            for point in self.attachments().filter(|a| pivot.body.is_some() && a.body == pivot.body)
            {
                reach = reach.max((point.point - pivot.point).norm());
            }
        }
        if reach > 0.0 { reach } else { self.size() }
    }

    /// Points of all joints on bodies.
    fn attachments(&self) -> impl Iterator<Item = &Attachment> {
        let revolutes = self.revolutes.iter().flat_map(|j| [&j.ring, &j.journal]);
        revolutes.chain(self.prismatics.iter().flat_map(|j| [&j.base, &j.slider]))
    }

    /// Largest speed of a joint's point or a centre of mass, m/s.
    fn fastest_point(&self, states: &[BodyState], motion: &DVector<f64>) -> f64 {
        let speed = |body: usize, arm: Vector2<f64>| {
            let twist: Vector3<f64> = motion.fixed_rows::<3>(3 * body).into();
            (twist.xy() + Vector2::new(-arm.y, arm.x) * twist.z).norm()
        };
        let centres = (0..states.len()).map(|body| speed(body, Vector2::zeros()));
        let points = self
            .attachments()
            .filter_map(|a| a.body.map(|body| speed(body, states[body].rotation * a.point)));
        centres.chain(points).fold(0.0, f64::max)
    }
}

/// How well drives hold a mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// Sign of the determinant of all joints' and drives' rows. Where it changes, drives that hold leave the
    /// mechanism a motion: a singular pose.
    pub sign: f64,
    /// Speed of the drive that does least, in shares of the fastest point's, when it alone moves: the
    /// inverse of the gain from an error of the drive, or from a clearance of its size, to the machine. Zero
    /// in a singular pose.
    pub share: f64,
    /// That drive.
    pub drive: usize,
}

/// Rank of the rows, and those that have a part in a dependence.
fn dependent_rows(matrix: &DMatrix<f64>) -> (usize, Vec<usize>) {
    if matrix.is_empty() {
        return (0, Vec::new());
    }
    let lengths: Vec<f64> =
        matrix.row_iter().map(|row| row.norm().max(f64::MIN_POSITIVE)).collect();
    let unit = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] / lengths[i]);
    let gram = &unit * unit.transpose();
    if gram.iter().any(|x| !x.is_finite()) {
        return (0, Vec::new());
    }
    let eigen = gram.symmetric_eigen();
    let zero = eigen.eigenvalues.amax() * ZERO;
    let mut part = vec![false; matrix.nrows()];
    let mut rank = matrix.nrows();
    for (k, value) in eigen.eigenvalues.iter().enumerate() {
        if *value <= zero {
            rank -= 1;
            for (part, x) in part.iter_mut().zip(eigen.eigenvectors.column(k).iter()) {
                *part |= x.abs() > NO_PART;
            }
        }
    }
    (rank, (0..part.len()).filter(|&i| part[i]).collect())
}

/// Bodies that take part in motions which the rows allow.
fn loose(matrix: &DMatrix<f64>, bodies: usize) -> Vec<usize> {
    let gram = matrix.transpose() * matrix;
    if gram.iter().any(|x| !x.is_finite()) {
        return Vec::new();
    }
    let eigen = gram.symmetric_eigen();
    let zero = eigen.eigenvalues.amax() * ZERO;
    let moves = |body: usize| {
        (0..3 * bodies).any(|k| {
            let motion = eigen.eigenvectors.column(k);
            eigen.eigenvalues[k] <= zero
                && (3 * body..3 * body + 3).any(|i| motion[i].abs() > NO_PART)
        })
    };
    (0..bodies).filter(|&body| moves(body)).collect()
}
