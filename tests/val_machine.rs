//! The whole machine against the curves of an independent solver (minimal coordinates, adaptive
//! Dormand–Prince 5(4), no physics engine): `assets/reference/README.md`.

mod common;

use common::{Case, Curve, SERVO, platform_error};
use freeplay::engine::StepControl;

/// Case, curve, time up to which digits are comparable, and the error allowed at a step.
fn check(case: Case, curve: &str, until: f64, limits: &[(f64, f64)]) {
    let curve_data = Curve::read(curve);
    for &(step, limit) in limits {
        let (error, _) =
            platform_error(&case.mechanism(), StepControl::Fixed(step), &curve_data, until);
        println!("{curve} to {until} s, step {step:.0e} s: {error:.2e} m (limit {limit:.0e})");
        assert!(error <= limit, "{curve} step {step:e}: platform off by {error:e} m > {limit:e}");
    }
}

#[test]
fn prescribed_half_millimetre() {
    check(Case::default(), "prescribed_c5e-4.csv", 0.04, &[(1e-5, 2e-7), (2e-6, 2e-8)]);
}

#[test]
fn servo_with_gravity() {
    let case = Case { drive: SERVO, gravity: -9.81, ..Case::default() };
    check(case, "servo_c5e-4_gravity.csv", 0.06, &[(1e-5, 5e-7), (2e-6, 5e-8)]);
}

#[test]
fn nearly_no_clearance() {
    let case = Case { clearance: 1e-8, ..Case::default() };
    check(case, "prescribed_c1e-8.csv", 1.0, &[(1e-5, 1e-6)]);
}
