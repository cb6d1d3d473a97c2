//! Which columns a machine's results have.

use crate::mechanism::{BodyState, Mark, Names};
use nalgebra::{Vector2, Vector3};

/// The columns of a machine's time series.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    /// Bodies and points whose motion is written.
    pub outputs: Vec<Written>,
    /// What stands after `q` and `F` in the columns of each drive.
    pub drives: Vec<String>,
    /// Named points of bodies, for pictures.
    pub marks: Vec<Mark>,
    /// What they are called.
    pub(super) mark_names: Vec<String>,
    /// Indices of the revolute joints that have columns: those with a declared clearance.
    pub joints: Vec<usize>,
}

/// A body or point whose motion is written.
#[derive(Clone, Debug)]
pub struct Written {
    /// What stands after `x`, `y`, `phi`, `vx`, … in its columns.
    pub label: String,
    /// Its name in texts.
    pub name: String,
    /// The moving body, and the point of it from its *reference point*, in its own axes, in m.
    pub body: usize,
    /// See there.
    pub point: Vector2<f64>,
    /// Angle (rad) of the written axes in the body's own.
    pub angle: f64,
}

impl Layout {
    /// Puts what is written where the named points are, which an effect may have moved.
    pub(in crate::model) fn follow(&mut self, names: &Names) {
        for output in &mut self.outputs {
            if let Some(point) = names.points.get(&output.name) {
                output.point = point.mark.point;
            }
        }
        for (mark, name) in self.marks.iter_mut().zip(&self.mark_names) {
            if let Some(point) = names.points.get(name) {
                *mark = point.mark;
            }
        }
    }
}

impl Written {
    /// Position and velocity of the written point; `reference` is the body's reference point from its centre
    /// of mass (m).
    pub fn state(&self, states: &[BodyState], reference: Vector2<f64>) -> BodyState {
        states[self.body].at(reference + self.point)
    }

    /// Its acceleration (m/s², m/s², rad/s²), from that of the body.
    pub fn acceleration(
        &self,
        state: &BodyState,
        a: Vector3<f64>,
        reference: Vector2<f64>,
    ) -> Vector3<f64> {
        state.acceleration_at(a, reference + self.point)
    }
}
