//! Inverse dynamics: the efforts and joint forces that a motion of the machine without clearance takes, and
//! where its bodies are when journals lean on their rings under those forces.

use super::assembly::matrix;
use super::factors::Factors;
use super::rows::Row;
use crate::contact::Friction;
use crate::mechanism::{
    Bearing, BodyState, Command, JointIndex, Mechanism, Revolute, Situation, Tracker,
};
use nalgebra::{DMatrix, DVector, UnitComplex, Vector2, Vector3};

/// What a motion takes at one instant.
#[derive(Clone, Debug)]
pub struct Taken {
    /// Effort along the coordinate of each drive, in N or N·m.
    pub efforts: Vec<f64>,
    /// Force of each revolute joint on its journal's body in N, world directions.
    pub reactions: Vec<Vector2<f64>>,
    /// States with journals that lean on their rings as the forces say, what imposes the motion as it is.
    pub leaning: Vec<BodyState>,
}

/// An instant of a motion with what inverse dynamics takes from the geometry there: ready for any masses and loads
/// of a machine of that geometry.
#[derive(Clone, Debug)]
pub struct Posed {
    /// Time in s.
    t: f64,
    states: Vec<BodyState>,
    /// Angle of each body in rad, whole turns included.
    angles: Vec<f64>,
    accelerations: Vec<Vector3<f64>>,
    /// Each body's reference point, from the centre of mass that the motion is given for.
    references: Vec<Vector2<f64>>,
    drives: usize,
    /// Driven joints' rows, a column for each, and which drive that is.
    driven: DMatrix<f64>,
    driving: Vec<usize>,
    /// From what bodies need to the efforts of these, a column for each.
    efforts: DMatrix<f64>,
    /// Revolute joints with rows of their own.
    revolutes: Vec<usize>,
    /// From what bodies need beside the efforts to these joints' forces, x and y of one after another.
    forces: DMatrix<f64>,
    /// From these joints' gaps, likewise, to the shifts of bodies.
    shifts: DMatrix<f64>,
}

impl Tracker {
    /// The present instant, to be asked what it takes. None in a singular pose.
    pub fn posed(&self) -> Option<Posed> {
        let bodies = self.states().len();
        let mut commands = vec![Command::default(); self.mechanism().actuators.len()];
        self.mechanism().true_commands(self.time(), &mut commands);
        let closure = self.mechanism().closure(self.states(), &commands);
        let rows = matrix(&closure.rows, bodies);
        let all = 0..closure.rows.len();
        let (driven, joints): (Vec<usize>, Vec<usize>) =
            all.partition(|&row| closure.driven[row].is_some());
        let revolute = |row: usize| match closure.joints[row] {
            JointIndex::Revolute(i) => Some(i),
            JointIndex::Prismatic(_) => None,
        };
        let is_revolute = |place: &usize| revolute(joints[*place]).is_some();
        let places: Vec<usize> = (0..joints.len()).filter(is_revolute).collect();
        let own: Vec<usize> = places.iter().map(|&k| joints[k]).collect();
        // What is imposed stays where it is. By a target the rows of joints stand first, without those of drives among them.
        let (imposed, determining) = self.determining();
        let target = (!self.by_drives()).then(|| Factors::of(rows.clone()));
        let factors = target.as_ref().unwrap_or(determining);
        // `Jᵀ x = w` asks for rows of (Jᵀ)⁻¹, which are columns of J⁻¹.
        let [efforts, shifts] = [&driven, &own].map(|of| factors.responses(of));
        let (efforts, shifts) = (efforts?, shifts?);
        let forces = forces(&shifts, &efforts, self.mechanism().size())?;
        let held = |imposed: &[Row]| at_rest(&shifts, &efforts, &matrix(imposed, bodies));
        let shifts = match &target {
            None => shifts,
            Some(all) if all.is_square() && determining.is_square() => {
                held(&imposed[joints.len()..])?
            }
            Some(_) => determining.responses(&places)?,
        };
        Some(Posed {
            t: self.time(),
            states: self.states().to_vec(),
            angles: self.angles().to_vec(),
            accelerations: (0..bodies).map(|i| self.acceleration(i)).collect(),
            references: self.mechanism().bodies.iter().map(|body| body.reference).collect(),
            drives: self.mechanism().actuators.len(),
            efforts,
            driving: driven.iter().filter_map(|&row| closure.driven[row]).collect(),
            driven: rows.select_rows(&driven).transpose(),
            revolutes: own.iter().step_by(2).filter_map(|&row| revolute(row)).collect(),
            forces,
            shifts,
        })
    }
}

impl Posed {
    /// Time in s.
    pub fn time(&self) -> f64 {
        self.t
    }

    /// Angle of each body in rad, whole turns included: from that of its start on.
    pub fn angles(&self) -> &[f64] {
        &self.angles
    }

    /// Memory that it takes, in numbers of eight bytes, all but a few: thirteen of each body's state, angle, acceleration and
    /// reference point, and the matrices.
    pub fn size(&self) -> usize {
        let matrices = [&self.driven, &self.efforts, &self.forces, &self.shifts];
        13 * self.states.len() + matrices.map(|matrix| matrix.len()).iter().sum::<usize>()
    }

    /// Centre of mass of a body of `mechanism` (m, in its own axes) from the one that the motion is given for.
    fn centre(&self, mechanism: &Mechanism, body: usize) -> Vector2<f64> {
        self.references[body] - mechanism.bodies[body].reference
    }

    /// States of all bodies of `mechanism`.
    pub fn states(&self, mechanism: &Mechanism) -> Vec<BodyState> {
        let centred = |(i, state): (usize, &BodyState)| state.at(self.centre(mechanism, i));
        self.states.iter().enumerate().map(centred).collect()
    }

    /// Acceleration of body `index` of `mechanism` (m/s², m/s², rad/s²).
    pub fn acceleration(&self, mechanism: &Mechanism, index: usize) -> Vector3<f64> {
        let centre = self.centre(mechanism, index);
        self.states[index].acceleration_at(self.accelerations[index], centre)
    }

    /// What the motion takes of `mechanism`, the machine with its
    /// clearances and loads: with M, the masses, a, the accelerations, w, gravity and loads, J and B, the rows
    /// of the joints and of the drives' coordinates, `M a = w + Jᵀ λ + Bᵀ τ`, τ being the efforts.
    ///
    /// Joint forces are those λ that fit best when the `measured` efforts (N, N·m; of each drive) act in place
    /// of τ: what acts on the machine beside them turns fewer of them. Friction in joints with clearance
    /// depends on λ: it is looked at without, then with it.
    ///
    /// `t` is the time in s that loads see; `applied` are efforts at joints beside those of the drives. None in a
    /// singular pose.
    pub fn taken(
        &self,
        mechanism: &Mechanism,
        t: f64,
        measured: &[Option<f64>],
        applied: &[(JointIndex, f64)],
    ) -> Option<Taken> {
        let states = self.states(mechanism);
        let mut needed = self.needed(mechanism, &states, t, applied);
        let sliding: Vec<f64> =
            mechanism.revolutes.iter().map(|joint| sliding(joint, &states)).collect();
        let rubbing = sliding.iter().any(|&coefficient| coefficient != 0.0);
        let mut taken = Taken {
            efforts: vec![0.0; self.drives],
            reactions: vec![Vector2::zeros(); mechanism.revolutes.len()],
            leaning: Vec::new(),
        };
        let mut left = needed.clone();
        for pass in 0..=usize::from(rubbing) {
            if pass > 0 {
                rub(mechanism, &sliding, &taken.reactions, &mut needed);
            }
            let exact = self.efforts.tr_mul(&needed);
            left.copy_from(&needed);
            for (k, &drive) in self.driving.iter().enumerate() {
                taken.efforts[drive] = exact[k];
                let given = measured.get(drive).copied().flatten().unwrap_or(exact[k]);
                left.axpy(-given, &self.driven.column(k), 1.0);
            }
            let forces = &self.forces * &left;
            if !forces.iter().all(|x| x.is_finite()) {
                return None;
            }
            for (k, &joint) in self.revolutes.iter().enumerate() {
                taken.reactions[joint] = forces.fixed_rows::<2>(2 * k).into_owned();
            }
        }
        taken.leaning = self.leaning(mechanism, &sliding, &taken.reactions);
        Some(taken)
    }

    /// States with journals that lean on their rings under these joint forces (N).
    fn leaning(
        &self,
        mechanism: &Mechanism,
        sliding: &[f64],
        reactions: &[Vector2<f64>],
    ) -> Vec<BodyState> {
        let mut gaps = DVector::zeros(self.shifts.ncols());
        for (k, &joint) in self.revolutes.iter().enumerate() {
            let lean = self.lean(&mechanism.revolutes[joint], sliding[joint], reactions[joint]);
            gaps.fixed_rows_mut::<2>(2 * k).copy_from(&lean);
        }
        let shift = &self.shifts * gaps;
        let moved = |(i, state): (usize, &BodyState)| {
            let mut state = *state;
            state.position += shift.fixed_rows::<2>(3 * i);
            state.rotation *= UnitComplex::new(shift[3 * i + 2]);
            state.at(self.centre(mechanism, i))
        };
        self.states.iter().enumerate().map(moved).collect()
    }

    /// From the ring's centre to the journal's in m, where the ring pushes the journal, which slides by this
    /// [coefficient](sliding), with this force (N).
    fn lean(&self, joint: &Revolute, sliding: f64, force: Vector2<f64>) -> Vector2<f64> {
        let size = force.norm();
        let Bearing::Clearance(clearance) = &joint.bearing else { return Vector2::zeros() };
        if size == 0.0 {
            return Vector2::zeros();
        }
        // A journal that turns climbs its ring by the angle of friction: what is tangential is not borne by depth.
        let (normal, tangential) = borne(sliding, size);
        let climbed = UnitComplex::new(-tangential.atan2(normal));
        let (along, depth) = (climbed * force / -size, clearance.law.resting_penetration(normal));
        match &joint.out_of_round {
            None => along * (clearance.radial() + depth),
            Some(shape) => {
                let turned = joint
                    .ring
                    .body
                    .map_or_else(UnitComplex::identity, |ring| self.states[ring].rotation);
                shape.resting(clearance.radial(), depth, turned, along)
            }
        }
    }

    /// `M a − w` about the points that the motion is given for, but for friction in joints with clearance.
    fn needed(
        &self,
        mechanism: &Mechanism,
        states: &[BodyState],
        t: f64,
        applied: &[(JointIndex, f64)],
    ) -> DVector<f64> {
        let mut given: Vec<Vector3<f64>> =
            mechanism.bodies.iter().map(|body| (mechanism.gravity * body.mass).push(0.0)).collect();
        let at = Situation { t, mechanism, states, angles: Some(&self.angles) };
        for load in &mechanism.loads {
            load.add(at, &mut given);
        }
        for (joint, effort) in applied {
            mechanism.add_effort(*joint, *effort, states, &mut given);
        }
        let mut needed = DVector::zeros(3 * states.len());
        for (i, (body, given)) in mechanism.bodies.iter().zip(given).enumerate() {
            let masses = Vector3::new(body.mass, body.mass, body.inertia);
            let mut wrench = masses.component_mul(&self.acceleration(mechanism, i)) - given;
            let arm = states[i].rotation * self.centre(mechanism, i);
            wrench.z += arm.perp(&wrench.xy());
            needed.fixed_rows_mut::<3>(3 * i).copy_from(&wrench);
        }
        for rotor in &mechanism.rotors {
            let bodies = mechanism.revolutes[rotor.joint].bodies();
            let turn = |body: Option<usize>| body.map_or(0.0, |body| self.accelerations[body].z);
            let torques = rotor.torques(bodies.map(turn));
            for (body, torque) in bodies.into_iter().zip(torques) {
                if let Some(body) = body {
                    needed[3 * body + 2] += torque;
                }
            }
        }
        needed
    }
}

impl Mechanism {
    /// Adds the wrenches of an effort (N, N·m) at a joint to those of the bodies.
    pub fn add_effort(
        &self,
        joint: JointIndex,
        effort: f64,
        states: &[BodyState],
        wrenches: &mut [Vector3<f64>],
    ) {
        let ([first, second], [a, b]) = match joint {
            JointIndex::Prismatic(i) => {
                let joint = &self.prismatics[i];
                (joint.bodies(), joint.telescope(states).drive(effort))
            }
            JointIndex::Revolute(i) => {
                let torque = Vector3::new(0.0, 0.0, effort);
                (self.revolutes[i].bodies(), [-torque, torque])
            }
        };
        for (body, wrench) in [(first, a), (second, b)] {
            if let Some(body) = body {
                wrenches[body] += wrench;
            }
        }
    }
}

/// What turns that which bodies need into the λ that leaves least of `needed − Jᵀ λ`, moments as forces at the `size` L of
/// the mechanism in m, from what joints and drives by themselves move, `J P = 1`, `J Q = 0`.
///
/// With S = diag(1, 1, 1/L) what is left, r, has `J S² r = 0`, hence is `S⁻² Q c`; `Qᵀ needed = Qᵀ S⁻² Q c` says what c
/// is, and `λ = Pᵀ (needed − S⁻² Q c)` is the smallest where joints say the same twice, as P is.
fn forces(joints: &DMatrix<f64>, drives: &DMatrix<f64>, size: f64) -> Option<DMatrix<f64>> {
    let mut weighted = drives.clone();
    for mut moments in weighted.row_iter_mut().skip(2).step_by(3) {
        moments *= size * size;
    }
    let left = drives.tr_mul(&weighted).cholesky()?.solve(&drives.transpose());
    Some(joints.transpose() - joints.tr_mul(&weighted) * left)
}

/// What the gaps of joints shift where drives move so that what is imposed (rows T) stays as it is, out of what gaps (P) and
/// drives (Q) shift by themselves: `P − Q (T Q)⁻¹ T P`, of `T (P g + Q q) = 0`.
fn at_rest(
    joints: &DMatrix<f64>,
    drives: &DMatrix<f64>,
    imposed: &DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    let moved = (imposed * drives).lu().solve(&(imposed * joints))?;
    Some(joints - drives * moved)
}

/// Takes the friction of joints with clearance, under these joint forces (N), from what bodies need.
fn rub(
    mechanism: &Mechanism,
    sliding: &[f64],
    reactions: &[Vector2<f64>],
    needed: &mut DVector<f64>,
) {
    for ((joint, &sliding), reaction) in mechanism.revolutes.iter().zip(sliding).zip(reactions) {
        let Some((_, radius)) = friction(joint) else { continue };
        let torque = -radius * borne(sliding, reaction.norm()).1;
        for (body, torque) in joint.bodies().into_iter().zip([-torque, torque]) {
            if let Some(body) = body {
                needed[3 * body + 2] -= torque;
            }
        }
    }
}

/// Tangential over normal force of a joint as it turns, the former along the sliding; 0 where nothing rubs.
fn sliding(joint: &Revolute, states: &[BodyState]) -> f64 {
    friction(joint).map_or(0.0, |(law, radius)| law.force(1.0, joint.spin(states) * radius))
}

/// Normal and tangential part in N of a joint's force of this size, the latter `sliding` times the former,
/// `F² = N² + (µ N)²` (the circle of friction of a journal bearing: J. L. Meriam, L. G. Kraige, Engineering Mechanics:
/// Statics).
fn borne(sliding: f64, size: f64) -> (f64, f64) {
    let normal = size / sliding.hypot(1.0);
    (normal, sliding * normal)
}

/// Friction of a joint and its journal's radius in m, if it rubs.
fn friction(joint: &Revolute) -> Option<(Friction, f64)> {
    match &joint.bearing {
        Bearing::Clearance(clearance) => Some((clearance.friction?, clearance.journal_radius)),
        Bearing::Ideal | Bearing::Native { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two bodies, four rows of joints, two drives, and two rows of something else that stays as it is.
    #[test]
    fn what_is_imposed_stays_where_it_is_when_joints_give_way() {
        let number = |i: usize, k: usize| ((7 * i * i + 5 * k + 3 * i * k + 1) as f64).sin();
        let by_drives = DMatrix::from_fn(6, 6, number);
        let imposed = DMatrix::from_fn(2, 6, |i, k| number(i + 9, k));
        let mut determining = by_drives.clone();
        determining.rows_mut(4, 2).copy_from(&imposed);
        let factors = Factors::of(by_drives);
        let [joints, drives] = [vec![0, 1, 2, 3], vec![4, 5]].map(|rows| factors.responses(&rows));
        let found = at_rest(&joints.unwrap(), &drives.unwrap(), &imposed).unwrap();
        let expected = Factors::of(determining).responses(&[0, 1, 2, 3]).unwrap();
        assert!((&found - &expected).amax() < 1e-9, "{found} {expected}");
    }

    /// Two bodies, five rows of joints of which one says twice what another does, and two drives: forces are the smallest
    /// of those that leave least, as normal equations in weighted rows give them (with the smallest solution by singular
    /// values), and what joints bear alone they bear wholly.
    #[test]
    fn forces_leave_least_and_are_the_smallest_that_do() {
        let size = 0.4;
        let number = |i: usize, k: usize| ((7 * i * i + 5 * k + 3 * i * k + 1) as f64).sin();
        let mut joints = DMatrix::from_fn(5, 6, number);
        joints.set_row(4, &(2.0 * joints.row(1)));
        let drives = DMatrix::from_fn(2, 6, |i, k| number(i + 9, k));
        let all = DMatrix::from_fn(7, 6, |i, k| match i {
            0..5 => joints[(i, k)],
            _ => drives[(i - 5, k)],
        });
        let factors = Factors::of(all);
        let [own, driven] = [vec![0, 1, 2, 3, 4], vec![5, 6]].map(|rows| factors.responses(&rows));
        let found = forces(&own.unwrap(), &driven.unwrap(), size).unwrap();
        let weight = |k: usize| if k % 3 == 2 { 1.0 / size } else { 1.0 };
        let scaled = DMatrix::from_fn(5, 6, |i, k| joints[(i, k)] * weight(k));
        let least = scaled.transpose().pseudo_inverse(1e-10).unwrap();
        let expected = DMatrix::from_fn(5, 6, |i, k| least[(i, k)] * weight(k));
        assert!((&found - &expected).amax() < 1e-9, "{found} {expected}");
        let borne = joints.transpose() * DVector::from_vec(vec![1.0, 0.0, -2.0, 0.5, 0.0]);
        assert!((joints.transpose() * (&found * &borne) - &borne).amax() < 1e-9);
    }
}
