//! Effects in drives: their commands, controllers, transmissions and rotors, and the friction of their rods.

pub(super) mod actuator_friction;
pub(super) mod command_delay;
pub(super) mod drive_backlash;
pub(super) mod drive_compliance;
pub(super) mod drive_lag;
pub(super) mod film_friction;
pub(super) mod rotor_inertia;
pub(super) mod screw_ripple;
pub(super) mod servo_gain;
pub(super) mod servo_lag;
pub(super) mod stribeck_friction;
pub(super) mod torque_ripple;
