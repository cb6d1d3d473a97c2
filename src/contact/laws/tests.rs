use super::*;
use crate::contact::impact;

const MASS: f64 = 0.1;
const SPEED: f64 = 0.1;

#[test]
fn names_are_unique_and_texts_are_there() {
    for (i, kind) in ALL.iter().enumerate() {
        assert!(ALL[..i].iter().all(|other| other.name != kind.name), "{}", kind.name);
        assert_eq!(named(kind.name), Some(*kind));
        for text in [kind.summary, kind.equation, kind.source, kind.validity] {
            assert!(text.is_ascii() && !text.is_empty(), "{}: {text}", kind.name);
        }
        assert!(!(kind.takes("restitution") && kind.takes("damping")), "{}", kind.name);
        assert_eq!(kind.takes("restitution"), kind.losses == Losses::Restitution, "{}", kind.name);
        assert_eq!(kind.takes("damping"), kind.losses == Losses::Damping, "{}", kind.name);
    }
}

#[test]
fn what_is_written_as_default_is_the_default() {
    for kind in ALL {
        for parameter in kind.parameters {
            let Ok(value) = parameter.default.parse::<f64>() else { continue };
            let told = match parameter.name {
                "restitution" => Given { restitution: Some(value), ..Given::default() },
                "damping" => Given { damping: Some(value), ..Given::default() },
                _ => continue,
            };
            let [a, b] = [Given::default(), told].map(|given| (kind.build)(&given));
            let force =
                |law: &dyn crate::contact::ForceLaw| law.normal_force_after(5e-6, 0.05, SPEED);
            assert_eq!(force(&*a), force(&*b), "{}: {}", kind.name, parameter.name);
        }
    }
}

#[test]
fn forces_begin_at_zero_where_laws_are_continuous_and_never_pull() {
    for kind in ALL {
        let law = (kind.build)(&Given::default());
        let first = law.normal_force_after(1e-15, SPEED, SPEED);
        if kind.name == "kelvin-voigt" {
            assert!(first > 1.0, "the jump of a linear damper: {first}");
        } else {
            assert!(first < 1e-5, "{}: {first}", kind.name);
        }
        assert_eq!(law.normal_force_after(1e-7, -1e3, SPEED).min(0.0), 0.0, "{}", kind.name);
        assert_eq!(law.normal_force_after(-1e-9, SPEED, SPEED), 0.0, "{}", kind.name);
        assert!(law.normal_force(1e-6, 0.0).is_finite(), "{}", kind.name);
    }
}

#[test]
fn laws_after_hertz_reduce_to_it() {
    let hertz = (hertz::KIND.build)(&Given::default());
    let lossless =
        Given { restitution: Some(1.0), damping: Some(0.0), c_max: 0.0, ..Given::default() };
    for kind in ALL.iter().filter(|kind| kind.takes("exponent")) {
        let law = (kind.build)(&lossless);
        for (depth, rate) in [(1e-7, 0.1), (5e-6, -0.2), (2e-5, 0.0)] {
            let expected = hertz.normal_force(depth, rate);
            let force = law.normal_force_after(depth, rate, 0.1);
            assert_eq!(force, expected, "{} at {depth}", kind.name);
        }
    }
    // The linear spring reduces to Hertz of exponent 1.
    let linear = Given { stiffness: Some(1e7), exponent: 1.0, ..lossless };
    let [a, b] = [&kelvin_voigt::KIND, &hertz::KIND].map(|kind| (kind.build)(&linear));
    assert_eq!(a.normal_force(5e-6, 0.1), b.normal_force(5e-6, 0.1));
}

#[test]
fn resting_penetration_bears_the_force() {
    for kind in ALL {
        let law = (kind.build)(&Given::default());
        for force in [1e-3, 1.0, 50.0, 1e4] {
            let depth = law.resting_penetration(force);
            let back = law.normal_force_after(depth, 0.0, SPEED);
            assert!((back / force - 1.0).abs() < 1e-9, "{} at {force} N: {back}", kind.name);
        }
    }
}

#[test]
fn defaults_return_about_what_the_default_law_returns() {
    let returned =
        |kind: &LawKind| impact(&*(kind.build)(&Given::default()), MASS, SPEED).rebound / SPEED;
    assert!((returned(&HERTZ_STEP) - RESTITUTION).abs() < 0.01, "{}", returned(&HERTZ_STEP));
    for kind in [&kelvin_voigt::KIND, &hunt_crossley::KIND] {
        let e = returned(kind);
        assert!((e - RESTITUTION).abs() < 0.06, "{}: {e}", kind.name);
    }
}

/// The five laws with a logarithm in the form in which they are published, at a force.
#[test]
fn conformal_laws_solve_their_published_equations() {
    use std::f64::consts::PI;
    let given = Given::default();
    let [ri, rj, l] = [given.bearing_radius, given.journal_radius, given.length()];
    let h = 2.0 * (1.0 - 0.3f64.powi(2)) / (PI * 73e9);
    let modulus = 73e9 / (2.0 * (1.0 - 0.3f64.powi(2)));
    for force in [0.1, 10.0, 300.0] {
        let width = 1.6 * (force / l * 2.0 * ri * rj / (ri - rj) / modulus).sqrt();
        let published = [
            (&johnson::KIND, (4.0 * PI * modulus * (ri - rj) * l / force).ln() - 1.0, 1e-9),
            // Roark's 1.60 has three digits.
            (
                &radzimovsky::KIND,
                2.0 / 3.0 + (4.0 * ri / width).ln() + (4.0 * rj / width).ln(),
                1e-3,
            ),
            (&goldsmith::KIND, (l.powi(3) * (ri + rj) / (force * ri * rj * h)).ln() + 1.0, 1e-9),
            (
                &dubowsky_freudenstein::KIND,
                (l.powi(3) * (ri - rj) / (force * ri * rj * h)).ln() + 1.0,
                1e-9,
            ),
            (&esdu_78035::KIND, (4.0 * l * (ri - rj) / (force * h)).ln() + 1.0, 1e-9),
        ];
        for (kind, logarithm, tolerance) in published {
            let depth = force * h / l * logarithm;
            let back = (kind.build)(&given).normal_force(depth, 0.0);
            assert!((back / force - 1.0).abs() < tolerance, "{} at {force} N: {back}", kind.name);
        }
    }
}
