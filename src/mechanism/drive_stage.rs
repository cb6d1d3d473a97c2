//! One prismatic joint with its drive: a load that slides on the ground along the x axis.

use super::{
    Actuator, Attachment, Body, BodyState, Commands, Drive, JointIndex, Mechanism, Prismatic,
};
use nalgebra::{UnitComplex, Vector2, Vector3};
use std::sync::Arc;

/// Inertia in kg·m² of the load, which cannot turn: any would do.
const INERTIA: f64 = 1.0;

/// Builds the stage: a load of `mass` kg on the joint `P1`, starting at a length (m) and a rate (m/s), moved
/// by `drive` after `commands`. The joint's axis is horizontal; `gravity` is in m/s².
pub fn build(
    mass: f64,
    drive: Drive,
    start: [f64; 2],
    commands: Arc<dyn Commands>,
    gravity: Vector2<f64>,
) -> Mechanism {
    let load = Body::new("load", mass, INERTIA, state(start));
    Mechanism {
        revolutes: Vec::new(),
        prismatics: vec![Prismatic {
            name: "P1".to_owned(),
            base: Attachment { body: None, point: Vector2::zeros() },
            slider: Attachment { body: Some(0), point: Vector2::zeros() },
            axes: [UnitComplex::identity(); 2],
        }],
        actuators: vec![Actuator::new("P1", JointIndex::Prismatic(0), drive)],
        commands,
        gravity,
        ..Mechanism::free(vec![load])
    }
}

/// State of the load at a length in m and a rate in m/s.
pub fn state([length, rate]: [f64; 2]) -> BodyState {
    BodyState {
        position: Vector2::new(length, 0.0),
        rotation: UnitComplex::identity(),
        twist: Vector3::new(rate, 0.0, 0.0),
    }
}
