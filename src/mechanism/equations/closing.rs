//! The length of a link that would close a loop.

use crate::mechanism::{Attachment, BodyState, Command, Drive, JointIndex, Mechanism};
use nalgebra::{UnitComplex, Vector2, Vector3};

/// A link of a loop that is too short or too long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosingLength {
    /// The body, or the ground.
    pub body: Option<usize>,
    /// The joints at its ends.
    pub joints: [JointIndex; 2],
    /// Its length in m.
    pub length: f64,
    /// The lengths that would close the loop, in m: a polygon closes if no side is longer than all others
    /// together.
    pub range: [f64; 2],
}

/// A side of a loop's polygon: one body, or the two on both sides of a driven joint.
struct PolygonSide {
    body: Option<Option<usize>>,
    joints: [JointIndex; 2],
    length: f64,
}

impl Mechanism {
    /// A link of a loop of revolute joints through `joint` whose length keeps it open, driven joints at
    /// their first commands; none where no single link does.
    pub fn closing_length(&self, joint: JointIndex) -> Option<ClosingLength> {
        self.loops().into_iter().filter(|l| l.joints.contains(&joint)).find_map(|l| {
            let sides = self.sides(&l.joints)?;
            sides.iter().enumerate().find_map(|(i, side)| {
                let others: Vec<f64> =
                    (0..sides.len()).filter(|&k| k != i).map(|k| sides[k].length).collect();
                let sum: f64 = others.iter().sum();
                let longest = others.iter().copied().fold(0.0, f64::max);
                let range = [(2.0 * longest - sum).max(0.0), sum];
                let outside = side.length < range[0] || side.length > range[1];
                let body = side.body.filter(|_| outside)?;
                Some(ClosingLength { body, joints: side.joints, length: side.length, range })
            })
        })
    }

    /// The sides of the polygon of a loop's joints; none where one of them is prismatic.
    fn sides(&self, joints: &[JointIndex]) -> Option<Vec<PolygonSide>> {
        let mut commands = vec![Command::default(); self.actuators.len()];
        self.true_commands(0.0, &mut commands);
        let n = joints.len();
        let driven = |joint: JointIndex| {
            let mut actuators = self.actuators.iter();
            actuators.position(|a| a.joint == joint && a.drive != Drive::Effort)
        };
        let next = |i: usize| joints[(i + 1) % n];
        let mut sides = Vec::new();
        for i in 0..n {
            let (from, to) = (joints[i], next(i));
            if driven(from).is_some() {
                continue;
            }
            let (body, a, b) = self.between(from, to)?;
            if let Some(drive) = driven(to) {
                // The joint holds both of its bodies at the commanded angle.
                let after = joints[(i + 2) % n];
                let (other, c, d) = self.between(to, after)?;
                let JointIndex::Revolute(index) = to else { return None };
                let angle = commands[drive].position;
                let journal = self.revolutes[index].journal.body == other;
                let turned = UnitComplex::new(if journal { angle } else { -angle }) * (d - c);
                let length = (turned - (a - b)).norm();
                sides.push(PolygonSide { body: None, joints: [from, after], length });
            } else {
                sides.push(PolygonSide {
                    body: Some(body),
                    joints: [from, to],
                    length: (a - b).norm(),
                });
            }
        }
        Some(sides)
    }

    /// The body that two revolute joints share, and their centres in its own axes.
    fn between(
        &self,
        from: JointIndex,
        to: JointIndex,
    ) -> Option<(Option<usize>, Vector2<f64>, Vector2<f64>)> {
        let (JointIndex::Revolute(from), JointIndex::Revolute(to)) = (from, to) else {
            return None;
        };
        let ends = |i: usize| [&self.revolutes[i].ring, &self.revolutes[i].journal];
        let pairs = ends(from).into_iter().flat_map(|a| ends(to).map(|b| (a, b)));
        let shared = |(a, b): &(&Attachment, &Attachment)| a.body == b.body;
        pairs.into_iter().find(shared).map(|(a, b)| (a.body, a.point, b.point))
    }

    /// Coordinate (angles between −π and π), rate and acceleration of a joint, from the bodies' states and
    /// accelerations.
    pub fn motion_of(
        &self,
        joint: JointIndex,
        states: &[BodyState],
        acceleration: impl Fn(usize) -> Vector3<f64>,
    ) -> Command {
        let of = |body: Option<usize>| body.map_or_else(Vector3::zeros, &acceleration);
        match joint {
            JointIndex::Revolute(i) => {
                let joint = &self.revolutes[i];
                Command {
                    position: joint.rotation(states).angle(),
                    rate: joint.spin(states),
                    acceleration: of(joint.journal.body).z - of(joint.ring.body).z,
                }
            }
            JointIndex::Prismatic(i) => {
                let joint = &self.prismatics[i];
                let telescope = joint.telescope(states);
                let [_, _, along] = super::rows::prismatic_rows(&telescope, joint.bodies());
                let second = along.bodies.iter().zip(&along.jacobians);
                let second = second.fold(along.bias, |sum, (body, row)| sum + row.dot(&of(*body)));
                Command {
                    position: telescope.length,
                    rate: telescope.length_rate,
                    acceleration: second,
                }
            }
        }
    }
}
