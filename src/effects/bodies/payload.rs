//! A mass on a body that nobody declared.

use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::Mechanism;
use nalgebra::Vector2;

/// Farthest place in m along an axis: what a large robot reaches.
const FAR: f64 = 3.0;

pub(in crate::effects) const KIND: Kind = Kind {
    name: "payload",
    summary: "a point mass on a body: the platform, where none is named",
    equation: "mass and centre of mass of the body become those of both; \
               I += m M/(M + m) |r|^2 about the common centre",
    source: "parallel axis theorem",
    trace: "actuator forces: with acceleration, and with gravity where there is any",
    targets: Targets::Body,
    parameters: &[
        Parameter::size("mass_kg", "kg", "mass m", 20.0, 2e-3),
        Parameter {
            name: "com_x_m",
            unit: "m",
            about: "where it sits, along the x axis of the body's own axes, from their origin",
            bounds: [-FAR, FAR],
            step: 2e-3,
            default: Some(0.0),
        },
        Parameter {
            name: "com_y_m",
            unit: "m",
            about: "where it sits, along the y axis of the body's own axes, from their origin",
            bounds: [-FAR, FAR],
            step: 2e-3,
            default: Some(0.0),
        },
    ],
    variants: &[&["mass_kg", "com_x_m", "com_y_m"]],
    neutral: crate::effects::kind::defaults,
    starts,
    scan: None,
    apply,
};

/// A tenth of the body's mass in its centre of mass, where it turns nothing, and two radii of gyration from there, about where a
/// bar ends: least squares come from there to wherever it sits.
fn starts(mechanism: &Mechanism, setting: &Setting) -> Vec<Vec<f64>> {
    let Ok((body, axes)) = setting.body(mechanism) else { return Vec::new() };
    let (body, centre) = (&mechanism.bodies[body], axes.centred());
    let far = 2.0 * (body.inertia / body.mass).sqrt();
    [0.0, far].map(|along| vec![0.1 * body.mass, centre.x + along, centre.y]).to_vec()
}

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let point = Vector2::new(setting.number("com_x_m"), setting.number("com_y_m"));
    let (body, axes) = setting.body(mechanism)?;
    let point = axes.origin.point + axes.turned(point);
    mechanism.add_point_mass(body, setting.number("mass_kg"), point);
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{TURNTABLE, closed};

    /// A bracket fixed to the table at (0.1, 0) and turned by 0.7 rad carries the mass: in the table's axes it
    /// sits at `(0.1, 0) + R(0.7) (0.02, 0.03)`.
    #[test]
    fn a_mass_sits_in_the_axes_of_the_body_that_is_named() {
        let bracket = "[[body]]\nname = \"bracket\"\nmass = 0.5\ninertia = 1e-3\ncenter_of_mass = [0.04, 0.0]\n\
                       points = { A = [0.0, 0.0] }\nstart = [0.1, 0.05, 1.2]\n[[joint]]\nname = \"F\"\n\
                       kind = \"fixed\"\nbase = \"table.A\"\npart = \"bracket.A\"\nangle = 0.7\n";
        let effect = "[[effect]]\nkind = \"payload\"\nbody = \"bracket\"\nmass_kg = 0.3\ncom_x_m = 0.02\n\
                      com_y_m = 0.03\n";
        let loaded = closed(&format!("{TURNTABLE}{bracket}{effect}"));
        let body = &loaded.mechanism.bodies[0];
        let (sin, cos) = 0.7f64.sin_cos();
        let masses = [
            (1.0, 0.01, [0.0, 0.0]),
            (0.5, 1e-3, [0.1 + 0.04 * cos, 0.04 * sin]),
            (0.3, 0.0, [0.1 + 0.02 * cos - 0.03 * sin, 0.02 * sin + 0.03 * cos]),
        ];
        let total: f64 = masses.iter().map(|(mass, ..)| mass).sum();
        let centre = [0, 1].map(|i| masses.iter().map(|(m, _, at)| m * at[i]).sum::<f64>() / total);
        let about = |at: &[f64; 2]| (at[0] - centre[0]).powi(2) + (at[1] - centre[1]).powi(2);
        let inertia: f64 = masses.iter().map(|(m, own, at)| own + m * about(at)).sum();
        assert!((body.mass - total).abs() < 1e-12);
        assert!((body.inertia - inertia).abs() < 1e-12, "{} {inertia}", body.inertia);
        // The joint is where the centre of mass is not: at the table's origin.
        let journal = loaded.mechanism.revolutes[0].journal.point;
        assert!((journal.x + centre[0]).abs() < 1e-12 && (journal.y + centre[1]).abs() < 1e-12);
    }
}
