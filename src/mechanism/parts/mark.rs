//! Points that stay where they are in their body.

use crate::mechanism::{Attachment, Mechanism};
use nalgebra::Vector2;

/// A point of a body that stays where it is in the body, whatever mass is put on it: from the body's
/// reference point in its own axes, in m; of the ground in the world.
///
/// [`PointSpring`](crate::mechanism::PointSpring) has an example.
#[derive(Clone, Copy, Debug)]
pub struct Mark {
    /// The body, or the ground.
    pub body: Option<usize>,
    /// The point in m.
    pub point: Vector2<f64>,
}

impl Mark {
    /// The point as an attachment of this mechanism.
    pub fn attachment(&self, mechanism: &Mechanism) -> Attachment {
        let reference = self.body.map_or_else(Vector2::zeros, |i| mechanism.bodies[i].reference);
        Attachment { body: self.body, point: reference + self.point }
    }
}
