//! The names that a description gives to its bodies and points, and where those are in what moves.

use crate::mechanism::{Mark, Mechanism};
use nalgebra::{UnitComplex, Vector2};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Names of a described machine; a mechanism that was put together by hand has none.
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// The described bodies; several of them are one moving body where fixed joints hold them together.
    pub bodies: BTreeMap<String, Axes>,
    /// Points as `body.point`, those of the ground included.
    pub points: BTreeMap<String, NamedPoint>,
    /// The described body whose motion is the machine's output.
    pub output: Option<String>,
}

/// The axes in which a described body is written.
#[derive(Clone, Copy, Debug)]
pub struct Axes {
    /// Their origin.
    pub origin: Mark,
    /// Their angle in the moving body's own axes, rad.
    pub angle: f64,
    /// The described body's centre of mass, as declared.
    pub centre: Mark,
}

impl Axes {
    /// A vector of these axes in those of the moving body.
    pub fn turned(&self, v: Vector2<f64>) -> Vector2<f64> {
        if self.angle == 0.0 { v } else { UnitComplex::new(self.angle) * v }
    }

    /// The described body's centre of mass, as declared, in these axes.
    pub fn centred(&self) -> Vector2<f64> {
        UnitComplex::new(-self.angle) * (self.centre.point - self.origin.point)
    }
}

/// A named point, and what is there.
#[derive(Clone, Debug)]
pub struct NamedPoint {
    /// The point.
    pub mark: Mark,
    /// Angle (rad) of the described body's axes in those of the moving body.
    pub angle: f64,
    /// What is attached there.
    pub uses: Vec<Use>,
}

impl NamedPoint {
    /// Whether a joint is there.
    pub fn holds_a_joint(&self) -> bool {
        let joint = |place: &Use| !matches!(place, Use::Spring { .. } | Use::Sensor(_));
        self.uses.iter().any(joint)
    }
}

/// What is attached at a named point, by its index in the mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// The ring of a revolute joint.
    Ring(usize),
    /// The journal of a revolute joint.
    Journal(usize),
    /// The base of a prismatic joint.
    Base(usize),
    /// The slider of a prismatic joint.
    Slider(usize),
    /// An end of a spring, which is a load.
    Spring {
        /// Among the loads.
        load: usize,
        /// The first or the second.
        end: usize,
    },
    /// What a sensor looks at.
    Sensor(usize),
}

impl Mechanism {
    /// Moves a named point by a vector (m) in the axes of its described body, and with it the joints, spring
    /// ends and sensors there. The reference point of the output stays. False where nothing has that name.
    pub fn move_point(&mut self, name: &str, by: Vector2<f64>) -> bool {
        let Some(point) = self.names.points.get_mut(name) else { return false };
        let by = if point.angle == 0.0 { by } else { UnitComplex::new(point.angle) * by };
        point.mark.point += by;
        for place in &point.uses {
            match *place {
                Use::Ring(i) => self.revolutes[i].ring.point += by,
                Use::Journal(i) => self.revolutes[i].journal.point += by,
                Use::Base(i) => self.prismatics[i].base.point += by,
                Use::Slider(i) => self.prismatics[i].slider.point += by,
                Use::Spring { load, end } => {
                    if let Some(moved) = self.loads[load].with_end_moved(end, by) {
                        self.loads[load] = Arc::clone(&moved);
                    }
                }
                Use::Sensor(i) => {
                    if let Some(mark) = self.sensors[i].mark_mut() {
                        mark.point += by;
                    }
                }
            }
        }
        true
    }
}
