//! The way from a step's start to its end: the coordinates of all bodies in a row, three of each, so that
//! the sums over stages take four of them at once.

use super::super::looks::Looks;
use super::node::Node;
use super::tsitouras::{Accelerations, Lanes, STAGES, error, stage};
use crate::mechanism::{BodyState, turn};
use nalgebra::{UnitComplex, Vector2, Vector3};

/// The way from a step's start to its end.
pub struct Path {
    /// Rates of all coordinates at the start.
    starts: Vec<Lanes>,
    /// Their accelerations at each stage.
    accelerations: Vec<Accelerations>,
    /// How far they have come at the present stage.
    ways: Vec<Lanes>,
    /// Workspace.
    row: Vec<Lanes>,
    /// How far each body has come at the end (m, m, rad).
    shifts: Vec<Vector3<f64>>,
    /// Normal forces at each stage.
    looks: Looks,
}

/// The three coordinates of each body, of all in a row; behind the last body lanes may be left over.
fn of_bodies(lanes: &[Lanes]) -> impl Iterator<Item = &[f64; 3]> {
    lanes.as_flattened().as_chunks().0.iter()
}

impl Path {
    /// A way of so many bodies, with so many joints to look at.
    pub fn new(bodies: usize, joints: usize) -> Self {
        let row = vec![[0.0; 4]; (3 * bodies).div_ceil(4)];
        Self {
            accelerations: vec![[[0.0; 4]; STAGES]; row.len()],
            starts: row.clone(),
            ways: row.clone(),
            row,
            shifts: vec![Vector3::zeros(); bodies],
            looks: Looks::new(STAGES, joints),
        }
    }

    /// Starts at an instant.
    pub fn begin(&mut self, start: &Node) {
        let twists = start.states.iter().map(|state| &state.twist);
        for (rates, twist) in
            self.starts.as_flattened_mut().as_chunks_mut().0.iter_mut().zip(twists)
        {
            *rates = [twist.x, twist.y, twist.z];
        }
        self.keep(0, start);
    }

    /// Keeps what acts at a stage.
    #[inline]
    pub fn keep(&mut self, stage: usize, node: &Node) {
        let row = self.row.as_flattened_mut().as_chunks_mut().0.iter_mut();
        for (a, now) in row.zip(&node.evaluation.accelerations) {
            *a = [now.x, now.y, now.z];
        }
        for (a, now) in self.accelerations.iter_mut().zip(&self.row) {
            a[stage] = *now;
        }
        self.looks.set(stage, node.t, &node.evaluation.contacts);
    }

    /// Puts bodies to where they are at stage `I` of a step of `h` s.
    #[inline]
    pub fn go<const I: usize>(&mut self, h: f64, start: &[BodyState], states: &mut [BodyState]) {
        let lanes = self.ways.iter_mut().zip(&mut self.row);
        for ((way, rate), (start, a)) in lanes.zip(self.starts.iter().zip(&self.accelerations)) {
            stage::<I>(h, start, a, way, rate);
        }
        let bodies = start.iter().zip(states);
        // Bodies that slide on each other turn alike.
        let (mut angle, mut turned) = (0.0, UnitComplex::identity());
        for ((from, state), (by, twist)) in
            bodies.zip(of_bodies(&self.ways).zip(of_bodies(&self.row)))
        {
            if by[2] != angle {
                (angle, turned) = (by[2], turn(by[2]));
            }
            *state = BodyState {
                position: from.position + Vector2::new(by[0], by[1]),
                rotation: from.rotation * turned,
                twist: Vector3::from(*twist),
            };
        }
    }

    /// How far each body has come at the present stage, the last one, to be kept (m, m, rad).
    pub fn arrive(&mut self) -> &mut [Vector3<f64>] {
        for (shift, by) in self.shifts.iter_mut().zip(of_bodies(&self.ways)) {
            *shift = Vector3::from(*by);
        }
        &mut self.shifts
    }

    /// How far each body comes from start to end (m, m, rad).
    pub fn shifts(&self) -> &[Vector3<f64>] {
        &self.shifts
    }

    /// Normal forces at each stage.
    pub fn looks(&self) -> &Looks {
        &self.looks
    }

    /// Estimated error of the step of `h` s in m/s; an angular speed counts with the body's radius of gyration (m).
    pub fn error(&mut self, h: f64, radii: &[f64]) -> f64 {
        for (lanes, a) in self.row.iter_mut().zip(&self.accelerations) {
            *lanes = error(h, a);
        }
        let mut worst = 0.0;
        for ([x, y, z], radius) in of_bodies(&self.row).zip(radii) {
            let turn = z * radius;
            let square = x * x + y * y + turn * turn;
            // What is no number stays.
            if square.is_nan() || square > worst {
                worst = square;
            }
        }
        worst.sqrt()
    }
}
