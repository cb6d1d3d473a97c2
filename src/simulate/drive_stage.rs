//! What assembling a drive stage takes.

use super::assemble::drive;
use super::ideal::Ideal;
use crate::mechanism::motion::Motion;
use crate::mechanism::{Command, Commands, Drive, Mechanism, drive_stage};
use crate::scenario::{DriveStage, Scenario};
use nalgebra::Vector2;
use std::sync::Arc;

/// The length is the motion's x.
#[derive(Debug)]
struct Along(Arc<dyn Motion>);

impl Commands for Along {
    fn at(&self, t: f64, commands: &mut [Command]) {
        let point = self.0.at(t);
        for command in commands {
            *command = Command {
                position: point.pose.x,
                rate: point.rate.x,
                acceleration: point.acceleration.x,
            };
        }
    }
}

/// The stage, and itself with a drive that follows exactly.
pub(super) fn assemble(
    scenario: &Scenario,
    stage: &DriveStage,
    motion: Arc<dyn Motion>,
) -> (Mechanism, Ideal) {
    let gravity: Vector2<f64> = scenario.environment.gravity.into();
    let first = motion.at(0.0);
    let commands: Arc<dyn Commands> = Arc::new(Along(Arc::clone(&motion)));
    let build = |drive| {
        let start = [first.pose.x, first.rate.x];
        drive_stage::build(stage.mass, drive, start, Arc::clone(&commands), gravity)
    };
    let states = move |t| {
        let point = motion.at(t);
        vec![drive_stage::state([point.pose.x, point.rate.x])]
    };
    (build(drive(scenario)), Ideal::new(build(Drive::Prescribed), Box::new(states)))
}
