//! The way from a step's start to its end: the coordinates of the machine in a row, so that the sums over stages
//! take four of them at once.

use super::super::looks::Looks;
use super::node::Node;
use super::tsitouras::{Accelerations, Lanes, STAGES, error, stage};
use crate::mechanism::{Dynamics, Mechanism};
use nalgebra::Vector3;

/// The way from a step's start to its end.
pub struct Path {
    /// How many coordinates there are; behind the last one lanes may be left over.
    count: usize,
    /// Radii in m of gyration of what turns: each has three coordinates, which come first.
    radii: Vec<f64>,
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

impl Path {
    /// A way of that mechanism.
    pub fn new(mechanism: &Mechanism, dynamics: &Dynamics, start: &Node) -> Self {
        let count = dynamics.coordinates();
        let row = vec![[0.0; 4]; count.div_ceil(4)];
        Self {
            count,
            radii: dynamics.radii(mechanism, &start.states),
            accelerations: vec![[[0.0; 4]; STAGES]; row.len()],
            starts: row.clone(),
            ways: row.clone(),
            row,
            shifts: vec![Vector3::zeros(); mechanism.bodies.len()],
            looks: Looks::new(STAGES, mechanism.revolutes.len()),
        }
    }

    /// Starts at an instant.
    pub fn begin(&mut self, dynamics: &mut Dynamics, start: &Node) {
        let Self { count, starts, row, .. } = self;
        let [rates, accelerations] = [starts, row].map(|row| &mut row.as_flattened_mut()[..*count]);
        dynamics.start(&start.states, &start.evaluation.accelerations, rates, accelerations);
        self.keep(0, start);
    }

    /// Goes to stage `I` of a step of `h` s, puts bodies to where they are there, and finds what acts there.
    #[inline]
    pub fn go<const I: usize>(
        &mut self,
        dynamics: &mut Dynamics,
        mechanism: &Mechanism,
        h: f64,
        [start, now]: [&mut Node; 2],
    ) {
        let lanes = self.ways.iter_mut().zip(&mut self.row);
        for ((way, rate), (start, a)) in lanes.zip(self.starts.iter().zip(&self.accelerations)) {
            stage::<I>(h, start, a, way, rate);
        }
        let row = [&self.ways, &self.row].map(|row| &row.as_flattened()[..self.count]);
        let Node { t, states, evaluation, .. } = &mut *now;
        dynamics.place(mechanism, *t, &start.states, row, (states, evaluation));
        if I + 1 == STAGES {
            self.arrive(dynamics, mechanism, [start, now]);
        } else {
            let row = &mut self.row.as_flattened_mut()[..self.count];
            now.evaluate_on_path(dynamics, mechanism, row);
        }
        self.keep(I, now);
    }

    /// Finds what acts at the last stage, the step's end.
    fn arrive(
        &mut self,
        dynamics: &mut Dynamics,
        mechanism: &Mechanism,
        [start, end]: [&mut Node; 2],
    ) {
        for state in &mut end.states {
            state.rotation.renormalize_fast();
        }
        let ways = &self.ways.as_flattened()[..self.count];
        dynamics.shifts(ways, [&start.states, &end.states], &mut self.shifts);
        let Node { t, states, evaluation, .. } = &mut *end;
        dynamics.project(mechanism, *t, states, &mut self.shifts, evaluation);
        end.evaluate(dynamics, mechanism);
        let row = &mut self.row.as_flattened_mut()[..self.count];
        dynamics.gather(&end.evaluation.accelerations, row);
    }

    /// Keeps what acts at a stage.
    #[inline]
    fn keep(&mut self, stage: usize, node: &Node) {
        for (a, now) in self.accelerations.iter_mut().zip(&self.row) {
            a[stage] = *now;
        }
        self.looks.set(stage, node.t, &node.evaluation.contacts);
    }

    /// How far each body comes from start to end (m, m, rad).
    pub fn shifts(&self) -> &[Vector3<f64>] {
        &self.shifts
    }

    /// Normal forces at each stage.
    pub fn looks(&self) -> &Looks {
        &self.looks
    }

    /// Estimated error of the step of `h` s in m/s; an angular speed counts with the radius of gyration (m).
    pub fn error(&mut self, h: f64) -> f64 {
        for (lanes, a) in self.row.iter_mut().zip(&self.accelerations) {
            *lanes = error(h, a);
        }
        let errors = &self.row.as_flattened()[..self.count];
        let (turning, lengths) = errors.split_at(3 * self.radii.len());
        let turning = turning.as_chunks().0.iter().zip(&self.radii);
        let squares = turning.map(|([x, y, z], radius)| x * x + y * y + (z * radius).powi(2));
        let mut worst = 0.0;
        for square in squares.chain(lengths.iter().map(|length| length * length)) {
            // What is no number stays.
            if square.is_nan() || square > worst {
                worst = square;
            }
        }
        worst.sqrt()
    }
}
