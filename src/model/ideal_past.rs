//! What a machine without clearance said, so that others need not be asked.

use nalgebra::{Vector2, Vector3};
use std::sync::Arc;

/// Instants of a run that are kept at most, 15 MB of them: more rows take minutes to simulate, and their ideal machine a
/// twentieth of that.
const MOST_KEPT: usize = 100_000;

/// What an ideal machine said of one instant.
#[derive(Clone, Debug)]
pub(super) struct Said {
    /// Time in s.
    pub t: f64,
    /// Of the output, in m, m/s, and m/s², rad/s².
    pub position: Vector2<f64>,
    pub velocity: Vector2<f64>,
    pub acceleration: Vector3<f64>,
    /// In N or N·m.
    pub drive_forces: Vec<f64>,
}

impl Said {
    /// Nothing, of a machine with so many drives.
    pub fn of(drives: usize) -> Self {
        Self {
            t: f64::NAN,
            position: Vector2::zeros(),
            velocity: Vector2::zeros(),
            acceleration: Vector3::zeros(),
            drive_forces: vec![0.0; drives],
        }
    }
}

/// Whether what an ideal machine says is kept, or known.
#[derive(Debug, Default)]
pub(super) enum Past {
    /// Neither.
    #[default]
    Nothing,
    /// It is kept; it follows from what `key` says.
    Kept { key: String, said: Vec<Said> },
    /// Another machine has said it; so many instants have been asked for.
    Known { said: Arc<Vec<Said>>, asked: usize },
}

impl Past {
    /// What another machine said of the time `t` (s) when it was asked next.
    pub fn next(&mut self, t: f64) -> Option<&Said> {
        let Past::Known { said, asked } = self else { return None };
        let next = said.get(*asked).filter(|said| said.t == t);
        *asked += 1;
        next
    }

    /// Keeps what was said, where that is wanted.
    pub fn keep(&mut self, now: &Said) {
        match self {
            Past::Kept { said, .. } if said.len() < MOST_KEPT => said.push(now.clone()),
            Past::Kept { .. } => *self = Past::Nothing,
            Past::Nothing | Past::Known { .. } => {}
        }
    }
}
