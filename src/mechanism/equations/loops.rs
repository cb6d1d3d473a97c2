//! Closed loops of joints, and the sign of the area that each runs around: the branch on which it was put
//! together.

use crate::mechanism::{BodyState, JointIndex, Mechanism};
use nalgebra::Vector2;

/// A loop of joints, in order around it.
///
/// ```
/// use freeplay::prelude::*;
/// use std::path::Path;
///
/// // A four-bar: one loop of four joints, whose area says on which branch it was put together.
/// let rig = Scenario::load(Some(Path::new("assets/rigs-planar/planar-2/rig.toml")), &[])?;
/// let mechanism = assemble(&rig)?.mechanism;
/// let loops = mechanism.loops();
/// assert_eq!((loops.len(), loops[0].joints.len()), (1, 4));
/// let states: Vec<BodyState> = mechanism.bodies.iter().map(|body| body.start).collect();
/// assert!(mechanism.signed_area(&loops[0], &states).abs() > 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// The joints.
    pub joints: Vec<JointIndex>,
}

impl Mechanism {
    /// The two bodies of a joint; the ground has none.
    pub fn joint_bodies(&self, joint: JointIndex) -> [Option<usize>; 2] {
        match joint {
            JointIndex::Revolute(i) => self.revolutes[i].bodies(),
            JointIndex::Prismatic(i) => self.prismatics[i].bodies(),
        }
    }

    /// Name of a joint.
    pub fn joint_name(&self, joint: JointIndex) -> &str {
        match joint {
            JointIndex::Revolute(i) => &self.revolutes[i].name,
            JointIndex::Prismatic(i) => &self.prismatics[i].name,
        }
    }

    /// The body that most joints separate from the ground; the last of several.
    pub fn farthest_body(&self) -> usize {
        let joints: Vec<(JointIndex, [Option<usize>; 2])> =
            self.joints().map(|(_, joint)| (joint, self.joint_bodies(joint))).collect();
        let distance = |body: usize| way(&joints, Some(body), None).map_or(0, |way| way.len());
        (0..self.bodies.len()).max_by_key(|&body| distance(body)).unwrap_or_default()
    }

    /// Independent loops: each joint that is not needed to connect a body with the ground closes one, the
    /// shortest through it.
    pub fn loops(&self) -> Vec<Loop> {
        let joints: Vec<(JointIndex, [Option<usize>; 2])> =
            self.joints().map(|(_, joint)| (joint, self.joint_bodies(joint))).collect();
        let mut open: Vec<(JointIndex, [Option<usize>; 2])> = Vec::new();
        let mut loops = Vec::new();
        for (joint, [a, b]) in joints {
            if let Some(mut way) = way(&open, a, b) {
                way.push(joint);
                loops.push(Loop { joints: way });
            }
            open.push((joint, [a, b]));
        }
        loops
    }

    /// Whether the sign of a loop's area names its branch: where all its joints are revolute. The triangle of
    /// a slider-crank turns over at every dead centre of the crank.
    pub fn has_branches(&self, of: &Loop) -> bool {
        of.joints.iter().all(|joint| matches!(joint, JointIndex::Revolute(_)))
    }

    /// Area in m² of the polygon of a loop's joints, positive where they run counterclockwise; zero where
    /// the loop has fewer than three corners.
    pub fn signed_area(&self, of: &Loop, states: &[BodyState]) -> f64 {
        let corner = |joint: &JointIndex| match *joint {
            JointIndex::Revolute(i) => self.revolutes[i].journal.frame(states).centre,
            JointIndex::Prismatic(i) => self.prismatics[i].slider.frame(states).centre,
        };
        let corners: Vec<Vector2<f64>> = of.joints.iter().map(corner).collect();
        let edges = corners.iter().zip(corners.iter().cycle().skip(1));
        0.5 * edges.map(|(a, b)| a.perp(b)).sum::<f64>()
    }
}

/// The shortest way of joints from body `from` to body `to`, breadth first.
fn way(
    joints: &[(JointIndex, [Option<usize>; 2])],
    from: Option<usize>,
    to: Option<usize>,
) -> Option<Vec<JointIndex>> {
    let mut ways = vec![(to, Vec::new())];
    let mut seen = vec![to];
    let mut next = 0;
    while next < ways.len() {
        let (body, way) = ways[next].clone();
        if body == from {
            return Some(way);
        }
        for (joint, ends) in joints {
            for side in 0..2 {
                if ends[side] == body && !seen.contains(&ends[1 - side]) {
                    seen.push(ends[1 - side]);
                    let mut longer = way.clone();
                    longer.push(*joint);
                    ways.push((ends[1 - side], longer));
                }
            }
        }
        next += 1;
    }
    None
}
