//! Physical effects that a declared machine may lack: a payload nobody mentioned, a worn joint, a
//! servo that lags. One file each, in a folder by what it acts on, all of them in [`ALL`]; a [`Kind`] says what it can act on and lists
//! its targets on a machine ([`Kind::targets_of`], [`Kind::candidates`]); an effect changes a
//! [`Mechanism`](crate::mechanism::Mechanism) after it was built, so that whatever simulates or
//! inverts mechanisms knows it already.

mod bodies;
mod drives;
mod joints;
mod kind;
mod reading;
#[cfg(test)]
mod rigs;
mod sensors;
mod setting;
mod target;
mod twins;
mod unnamed;
mod wrong;

pub use kind::{JointKinds, Kind, Parameter, Scan, ScanRange, Senses, Targets};
pub use setting::Setting;
pub use target::Target;
pub use unnamed::UNNAMED;
pub use unnamed::central::{Central, OverDistance};
pub use unnamed::efforts::{Efforts, Over};
pub use unnamed::history::{History, OverTime};
pub use wrong::Wrong;

/// Every effect there is, in the order in which they are listed.
pub const ALL: &[&Kind] = &[
    &bodies::payload::KIND,
    &bodies::leg_density::KIND,
    &bodies::gravity::KIND,
    &drives::actuator_friction::KIND,
    &drives::stribeck_friction::KIND,
    &joints::journal_friction::KIND,
    &joints::anchor_offset::KIND,
    &joints::joint_wear::KIND,
    &joints::out_of_round::KIND,
    &joints::lubricant_film::KIND,
    &joints::contact_damping::KIND,
    &drives::command_delay::KIND,
    &drives::servo_lag::KIND,
    &drives::servo_gain::KIND,
    &drives::drive_backlash::KIND,
    &drives::drive_compliance::KIND,
    &sensors::sensor_offset::KIND,
    &sensors::actuator_scale::KIND,
    &drives::screw_ripple::KIND,
    &bodies::tether::KIND,
    &bodies::drag::KIND,
    &bodies::base_vibration::KIND,
    &bodies::unbalance::KIND,
    &unnamed::KIND,
    &drives::film_friction::KIND,
    &joints::pivot_friction::KIND,
    &joints::bristle_friction::KIND,
    &bodies::air_drag::KIND,
    &bodies::point_offset::KIND,
    &joints::joint_friction::KIND,
    &drives::torque_ripple::KIND,
    &sensors::encoder_zero::KIND,
    &sensors::encoder_scale::KIND,
    &sensors::encoder_eccentricity::KIND,
    &sensors::sensor_latency::KIND,
    &sensors::force_scale::KIND,
    &sensors::force_offset::KIND,
    &sensors::tracker_frame::KIND,
    &bodies::impulse::KIND,
    &bodies::load_change::KIND,
    &bodies::mass_properties::KIND,
    &drives::rotor_inertia::KIND,
    &drives::drive_lag::KIND,
    &joints::contact_law::KIND,
];

/// Effects of machines that a search is for which imitate a commoner one: an encoder's wrong zero looks
/// like an anchor moved along its leg. They are named only where they do clearly better.
pub const SELDOM: &[&Kind] = &[
    &bodies::leg_density::KIND,
    &drives::stribeck_friction::KIND,
    &joints::out_of_round::KIND,
    &joints::lubricant_film::KIND,
    &joints::contact_damping::KIND,
    &joints::contact_law::KIND,
    &drives::servo_gain::KIND,
    &drives::drive_backlash::KIND,
    &drives::drive_compliance::KIND,
    &sensors::sensor_offset::KIND,
];

/// Effects that take energy out of a rattle, which may be all that shows of them: a residual is noise without
/// them, only less noise than joints make that rattle on.
pub const CALMING: &[&Kind] = &[&joints::journal_friction::KIND, &bodies::drag::KIND];

/// Effects that contain another, which they become at some of their values: who rules that out rules them
/// out too.
pub const CONTAINS: &[(&Kind, &Kind)] =
    // With as much friction near rest as in motion.
    &[(&drives::stribeck_friction::KIND, &drives::actuator_friction::KIND)];

/// The effect called `name`.
pub fn named(name: &str) -> Option<&'static Kind> {
    ALL.iter().find(|kind| kind.name == name).copied()
}

#[cfg(test)]
mod tests {
    use super::rigs::{SLIDER_CRANK, closed};
    use super::*;
    use crate::mechanism::Bearing;

    /// Where an effect takes the place of what is declared, that is where it changes nothing.
    #[test]
    fn journals_that_are_declared_to_rub_are_as_declared_where_nothing_is_missing() {
        let neutral = |frictions: [f64; 2]| {
            let mut machine = closed(SLIDER_CRANK).mechanism.clone();
            for (joint, friction) in machine.revolutes.iter_mut().skip(1).zip(frictions) {
                joint.bearing =
                    Bearing::Native { bearing_radius: 0.01, journal_radius: 0.0099, friction };
            }
            let candidates = named("journal-friction").unwrap().candidates(&machine);
            candidates
                .iter()
                .map(Setting::to_string)
                .zip(candidates.iter().map(|c| c.value("mu")))
                .collect::<Vec<_>>()
        };
        let of = |target: &str, mu: f64| (format!("journal-friction{target}"), Some(mu));
        assert_eq!(neutral([0.1, 0.1]), [of(" at A", 0.1), of(" at B", 0.1), of("", 0.1)]);
        assert_eq!(neutral([0.1, 0.2]), [of(" at A", 0.1), of(" at B", 0.2)]);
    }

    /// What has parameters has one that says how large it is.
    #[test]
    fn every_effect_has_a_size() {
        for kind in ALL.iter().filter(|kind| !kind.parameters.is_empty()) {
            assert!(!kind.parameters.iter().all(Parameter::is_shape), "{}", kind.name);
        }
    }

    /// A search needs the catalogue alone: every target of a mechanism, every variant, values that change
    /// nothing.
    #[test]
    fn every_candidate_on_a_mechanism_can_be_applied_and_is_neutral() {
        let machine = closed(SLIDER_CRANK);
        let mut targets = 0;
        for setting in ALL.iter().flat_map(|kind| kind.candidates(&machine.mechanism)) {
            targets += 1;
            let mut mechanism = machine.mechanism.clone();
            setting.apply(&mut mechanism).unwrap_or_else(|wrong| panic!("{setting}: {wrong:?}"));
            mechanism.close(0.0).unwrap();
            for (before, after) in machine.mechanism.bodies.iter().zip(&mechanism.bodies) {
                let moved = (after.start.position - before.start.position).norm();
                assert!(moved < 1e-9, "{setting}: {moved:e}");
            }
        }
        assert!(targets > 60, "{targets}");
        let of = |kind: &str| {
            let targets = named(kind).unwrap().targets_of(&machine.mechanism);
            targets.iter().map(Target::to_string).collect::<Vec<_>>().join("; ")
        };
        assert_eq!(of("payload"), "crank; rod; piston");
        assert_eq!(of("torque-ripple"), "O");
        // Pins that no drive turns are of one make.
        assert_eq!(of("joint-friction"), "O; A; B; S; A, B");
        // Its joints are ideal: nothing wears.
        assert_eq!(of("joint-wear"), "");
        assert_eq!(of("encoder-eccentricity"), "q_O; q_A; q_O, q_A");
        assert_eq!(of("force-scale"), "T_O");
        let points = "crank.A; crank.O; ground.O; ground.S; piston.P; rod.A; rod.B";
        assert_eq!(of("point-offset"), points);
        let groups =
            "q_O; q_A; T_O; x_A; y_A; phi_rod; x_B; x_P; q_O, q_A; x_A, y_A, phi_rod, x_B, x_P";
        assert_eq!(of("sensor-latency"), groups);
    }
}
