//! Errors of what sensors of joints read.

use crate::effects::{Setting, Wrong};
use crate::mechanism::{Drive, Mechanism, ReadingError, Reads, Sensor};
use std::sync::Arc;

/// Gives the sensors of joints that a setting names an error. The sensor of a joint that a drive holds is that
/// drive's encoder: the servo, and whoever else reads the joint, sees the error, too. Of other joints the
/// sensor alone is off.
pub(super) fn give(
    setting: &Setting,
    mechanism: &mut Mechanism,
    of_drive: &Arc<dyn ReadingError>,
    of_sensor: impl Fn(&mut Sensor),
) -> Result<(), Wrong> {
    let mut given = Vec::new();
    for index in setting.sensors(mechanism)? {
        let Reads::Position(joint) = mechanism.sensors[index].reads else {
            of_sensor(&mut mechanism.sensors[index]);
            continue;
        };
        let mut drives = mechanism.actuators.iter_mut();
        match drives.find(|drive| drive.joint == joint && drive.drive != Drive::Effort) {
            Some(drive) if !given.contains(&joint) => {
                drive.reading_errors.push(Arc::clone(of_drive));
                given.push(joint);
            }
            Some(_) => {}
            None => of_sensor(&mut mechanism.sensors[index]),
        }
    }
    Ok(())
}
