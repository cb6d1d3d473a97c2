//! What is measured of a run, by name.

use crate::study::compare::ComparedQuantity;

/// One measured quantity; the number is its place in the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Item {
    /// Largest |(a_x, a_y)| of the platform over all steps.
    PeakAcceleration,
    /// Root mean square of |(a_x, a_y) − ideal|.
    AccelerationDeviation,
    /// Root mean square of φ'' − ideal.
    AngularDeviation,
    /// Largest |F| of an actuator over all steps.
    PeakActuatorForce,
    /// Root mean square of F − ideal, mean of all actuators.
    ActuatorDeviation,
    /// Largest normal force in a joint over all steps.
    PeakContactForce,
    /// Normal force that touching joints exceed in one sample of a hundred.
    ContactForce99,
    /// Share of time in contact.
    ContactFraction,
    /// Contacts begun a second.
    Impacts,
    /// Root mean square distance from the ideal position.
    PathError,
    /// Jump of (a_x, a_y): its change within 1 ms, as a share of what noise changes.
    AccelerationJump,
    /// Jump of φ''.
    AngularJump,
    /// Jump of the actuator forces.
    ForceJump,
    /// Jump of the actuator forces of the ideal machine.
    IdealForceJump,
    /// `ActuatorDeviation` over the root mean square of the ideal forces.
    ForceShare,
    /// The same of 10 ms means of the forces.
    SmoothForceShare,
    /// Largest |(a_x, a_y)| of the ideal machine.
    IdealPeakAcceleration,
    /// Largest |F| of the ideal machine.
    IdealPeakActuatorForce,
    /// Largest Lyapunov exponent, from a pair of runs a hair apart.
    Lyapunov,
}

/// Number of measured quantities.
pub const COUNT: usize = 19;

/// Time in s over which a signal's change tells a jump: a few hits long (3e-4 s), short against a
/// turn of the motion (1 s).
pub const JUMP: f64 = 1e-3;

const fn quantity(key: &'static str, label: &'static str, unit: &'static str) -> ComparedQuantity {
    ComparedQuantity { key, label, unit }
}

/// The measured quantities, in the order of [`Item`]. All leave out the start (`simulation.settle`)
/// but the Lyapunov exponent, which comes from the first 0.2 s. Jumps are the root mean square change
/// of a signal within 1 ms over √2 times its standard deviation: 0.004 of a sine of 1 Hz, 1 of noise.
pub const QUANTITIES: [ComparedQuantity; COUNT] = [
    quantity("peak_platform_acceleration_m_s2", "platform acceleration, peak", "m/s²"),
    quantity(
        "rms_acceleration_deviation_m_s2",
        "platform acceleration, rms deviation from ideal",
        "m/s²",
    ),
    quantity(
        "rms_angular_acceleration_deviation_rad_s2",
        "angular acceleration, rms deviation from ideal",
        "rad/s²",
    ),
    quantity("peak_actuator_force_N", "actuator force, peak", "N"),
    quantity("rms_actuator_force_deviation_N", "actuator forces, rms deviation from ideal", "N"),
    quantity("peak_contact_force_N", "contact force, peak", "N"),
    quantity("contact_force_99_N", "contact force while touching, 99 % quantile", "N"),
    quantity("contact_fraction", "share of time in contact", ""),
    quantity("impacts_per_s", "impacts per second", "1/s"),
    quantity("rms_path_error_m", "path error, rms", "m"),
    quantity("acceleration_jump", "platform acceleration, jump within 1 ms", ""),
    quantity("angular_acceleration_jump", "angular acceleration, jump within 1 ms", ""),
    quantity("actuator_force_jump", "actuator forces, jump within 1 ms", ""),
    quantity("ideal_actuator_force_jump", "ideal actuator forces, jump within 1 ms", ""),
    quantity(
        "actuator_force_deviation_share",
        "actuator forces, rms deviation over rms of the ideal forces",
        "",
    ),
    quantity(
        "smooth_actuator_force_deviation_share",
        "actuator forces, 10 ms means, rms deviation over rms of the ideal forces",
        "",
    ),
    quantity("ideal_peak_platform_acceleration_m_s2", "ideal acceleration, peak", "m/s²"),
    quantity("ideal_peak_actuator_force_N", "ideal actuator force, peak", "N"),
    quantity("lyapunov_exponent_1_s", "largest Lyapunov exponent", "1/s"),
];

impl Item {
    /// Its name, label and unit.
    pub fn quantity(self) -> &'static ComparedQuantity {
        &QUANTITIES[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_and_names_stand_in_one_order() {
        assert_eq!(Item::PeakAcceleration.quantity().key, "peak_platform_acceleration_m_s2");
        assert_eq!(Item::PathError.quantity().key, "rms_path_error_m");
        assert_eq!(Item::IdealForceJump.quantity().key, "ideal_actuator_force_jump");
        assert_eq!(Item::Lyapunov.quantity().key, "lyapunov_exponent_1_s");
        assert_eq!(Item::Lyapunov as usize + 1, COUNT);
    }
}
