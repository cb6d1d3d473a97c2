//! Effects that are forces and masses on the bodies.

use super::common::{
    GRAVITY, INSTANTS, balance, forces_change, ideal, platform_feels, reduced, same_run, turned,
    wrench,
};
use freeplay::mechanism::motion::PathPoint;
use nalgebra::{Rotation2, Vector2, Vector3};
use std::f64::consts::TAU;

#[test]
fn a_payload_weighs_and_resists_where_it_sits() {
    let (mass, local) = (0.3, Vector2::new(0.02, -0.013));
    platform_feels("payload", "mass_kg = 0.3; com_x_m = 0.02; com_y_m = -0.013", |_, point| {
        let r = Rotation2::new(point.pose.z) * local;
        let (omega, alpha) = (point.rate.z, point.acceleration.z);
        let a = point.acceleration.xy() + turned(r) * alpha - r * (omega * omega);
        let force = (GRAVITY - a) * mass;
        wrench(force, r.perp(&force))
    });
}

#[test]
fn a_payload_at_the_centre_is_platform_mass() {
    let declared = ["mechanism.platform_mass=0.5"];
    let common = ["mechanism.platform_inertia=2e-4"];
    same_run("payload", "mass_kg = 0.3", &common, &declared);
}

#[test]
fn heavier_legs_weigh_and_resist_everywhere() {
    forces_change("leg-density", "relative = 0.25", |_, point, declared, before| {
        let mut wrenches: Vec<_> = declared
            .bodies
            .iter()
            .zip(&before.accelerations)
            .map(|(b, a)| wrench((GRAVITY - a.xy()) * b.mass, -a.z * b.inertia) * 0.25)
            .collect();
        wrenches[declared.output] = Vector3::zeros();
        balance(point.pose, reduced(point.pose, &wrenches))
    });
}

#[test]
fn gravity_is_the_environments() {
    same_run("gravity", "gx_m_s2 = 1.5; gy_m_s2 = -3", &[], &["environment.gravity=[1.5,-3]"]);
    // What is not given stays as declared.
    same_run("gravity", "gx_m_s2 = 1.5", &[], &["environment.gravity=[1.5,-9.81]"]);
}

#[test]
fn a_shaking_base_moves_legs_and_platform() {
    let keys = "ax_m_s2 = 2; ay_m_s2 = -1; frequency_Hz = 7; phase_rad = 0.4";
    forces_change("base-vibration", keys, |t, point, declared, _| {
        let a = Vector2::new(2.0, -1.0) * (TAU * 7.0 * t + 0.4).sin();
        let wrenches: Vec<_> = declared.bodies.iter().map(|b| wrench(-a * b.mass, 0.0)).collect();
        balance(point.pose, reduced(point.pose, &wrenches))
    });
}

#[test]
fn tether_drag_and_rotor_act_on_the_platform() {
    let anchor = Vector2::new(0.3, 0.1);
    let keys = "stiffness_N_m = 40; anchor_x_m = 0.3; anchor_y_m = 0.1; rest_length_m = 0.29";
    let pull = |point: &PathPoint| {
        let d = anchor - point.pose.xy();
        d.normalize() * (40.0 * (d.norm() - 0.29).max(0.0))
    };
    platform_feels("tether", keys, |_, point| wrench(pull(point), 0.0));
    let machine = ideal("", &[]);
    let taut = INSTANTS.map(|t| pull(&machine.motion.at(t)).norm() > 0.0);
    assert!(taut.contains(&true) && taut.contains(&false), "taut and slack: {taut:?}");

    platform_feels("drag", "force_Ns_m = 12; torque_Nms = 0.05", |_, point| {
        wrench(-12.0 * point.rate.xy(), -0.05 * point.rate.z)
    });
    let keys = "mass_radius_kg_m = 2e-3; frequency_Hz = 9; phase_rad = 0.2";
    platform_feels("unbalance", keys, |t, _| {
        let omega = TAU * 9.0;
        let (sin, cos) = (omega * t + 0.2).sin_cos();
        wrench(Vector2::new(cos, sin) * (2e-3 * omega * omega), 0.0)
    });
}
