//! Which bodies of a description hang together: as one body, or at all.

use crate::scenario::{Body, Described, GROUND, Joint};
use std::collections::BTreeSet;

impl Described {
    /// Names of the bodies that fixed joints make one with the body `name`, or with the ground; that name
    /// among them.
    pub(crate) fn rigid_with<'a>(&'a self, name: &'a str) -> BTreeSet<&'a str> {
        let fixed = self.joints.iter().filter(|joint| matches!(joint, Joint::Fixed(_)));
        reached(name, &fixed.map(bodies).collect::<Vec<_>>())
    }

    /// Bodies that no chain of joints and springs connects to the ground.
    pub(crate) fn floating(&self) -> Vec<&Body> {
        let links: Vec<[&str; 2]> = self.joints.iter().map(bodies).chain(self.springs()).collect();
        let held = reached(GROUND, &links);
        self.bodies.iter().filter(|body| !held.contains(body.name.as_str())).collect()
    }

    /// Whether a joint or a spring holds the body `name` to anything.
    pub(crate) fn is_held(&self, name: &str) -> bool {
        self.joints.iter().map(bodies).chain(self.springs()).any(|link| link.contains(&name))
    }

    /// The bodies that springs between two points connect.
    fn springs(&self) -> impl Iterator<Item = [&str; 2]> {
        let between = self.springs.iter().filter_map(|spring| spring.between.as_ref());
        between.map(|points| points.each_ref().map(|point| body_of(point)))
    }
}

/// The body of a `body.point`.
pub(super) fn body_of(point: &str) -> &str {
    point.split_once('.').map_or(point, |(body, _)| body)
}

/// The two bodies of a joint.
fn bodies(joint: &Joint) -> [&str; 2] {
    joint.points().map(|(_, point)| body_of(point))
}

/// All names that links lead to from one.
fn reached<'a>(from: &'a str, links: &[[&'a str; 2]]) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::from([from]);
    loop {
        let before = reached.len();
        for [a, b] in links {
            if reached.contains(a) || reached.contains(b) {
                reached.extend([a, b]);
            }
        }
        if reached.len() == before {
            return reached;
        }
    }
}
