//! One prismatic joint with its drive: a load that slides on the ground along the x axis.

use super::{Attachment, Body, BodyState, Commands, Drive, Mechanism, NativeContacts, Prismatic};
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
    let load = Body {
        name: "load".to_owned(),
        mass,
        inertia: INERTIA,
        start: state(start),
        reference: Vector2::zeros(),
    };
    Mechanism {
        bodies: vec![load],
        revolutes: Vec::new(),
        prismatics: vec![Prismatic {
            name: "P1".to_owned(),
            cylinder: Attachment { body: None, point: Vector2::zeros() },
            rod: Attachment { body: Some(0), point: Vector2::zeros() },
            drive,
            transmission: None,
            reading_errors: Vec::new(),
        }],
        commands,
        epoch: 0.0,
        gravity,
        loads: Vec::new(),
        native: NativeContacts::default(),
        output: 0,
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
