//! Mass, centre of mass and inertia that are not the declared ones.

use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::Mechanism;
use nalgebra::Vector2;

const fn change(
    name: &'static str,
    unit: &'static str,
    about: &'static str,
    step: f64,
) -> Parameter {
    Parameter { name, unit, about, bounds: [-1e3, 1e3], step, default: Some(0.0) }
}

pub(in crate::effects) const KIND: Kind = Kind {
    name: "mass-properties",
    summary: "mass, first moments and inertia of a body that differ from the declared ones, in sum with what is \
              fixed to it",
    equation: "m' = m + mass_kg, m' c' = m c + moment, J' = J + inertia_kg_m2, c and J about the origin of the \
               body's axes",
    source: "Atkeson, An, Hollerbach, Int. J. Robotics Research 5 (1986) 101-119: forces are linear in these",
    trace: "efforts of drives and free swings: with accelerations and gravity",
    targets: Targets::Body,
    parameters: &[
        change("mass_kg", "kg", "mass beyond the declared one", 1e-3),
        change("moment_x_kg_m", "kg m", "first moment along x beyond the declared one", 1e-4),
        change("moment_y_kg_m", "kg m", "first moment along y beyond the declared one", 1e-4),
        change(
            "inertia_kg_m2",
            "kg m^2",
            "inertia about the origin of the body's axes beyond the declared one",
            1e-5,
        ),
    ],
    // Rigs with clearance are searched for a payload, which is the commoner cause; this is fitted where windows
    // of a free or force-driven machine are.
    variants: &[],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let [mass, x, y, inertia] = ["mass_kg", "moment_x_kg_m", "moment_y_kg_m", "inertia_kg_m2"]
        .map(|name| setting.number(name));
    let (index, axes) = setting.body(mechanism)?;
    let body = &mechanism.bodies[index];
    let origin = body.reference + axes.origin.point;
    let total = body.mass + mass;
    let wrong = |key: &str, message: String| Wrong {
        key: key.to_owned(),
        message,
        help: "a body has a positive mass, and about its centre of mass a positive inertia".into(),
    };
    if total <= 0.0 {
        return Err(wrong("mass_kg", format!("leaves a mass of {total} kg")));
    }
    let centre = (axes.turned(Vector2::new(x, y)) - origin * body.mass) / total;
    let about_origin = body.inertia + body.mass * origin.norm_squared() + inertia;
    let about_centre = about_origin - total * centre.norm_squared();
    if about_centre <= 0.0 {
        let message = format!("leaves an inertia of {about_centre} kg m² about the centre of mass");
        return Err(wrong("inertia_kg_m2", message));
    }
    mechanism.set_mass(index, total, origin + centre, about_centre);
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{TURNTABLE, closed};

    /// A payload of 0.3 kg at (0.02, 0.03) is so much mass, moment and inertia.
    #[test]
    fn a_point_mass_is_a_change_of_mass_moments_and_inertia() {
        let payload = "[[effect]]\nkind = \"payload\"\nbody = \"table\"\nmass_kg = 0.3\ncom_x_m = 0.02\n\
                       com_y_m = 0.03\n";
        let change = format!(
            "[[effect]]\nkind = \"mass-properties\"\nbody = \"table\"\nmass_kg = 0.3\n\
             moment_x_kg_m = 0.006\nmoment_y_kg_m = 0.009\ninertia_kg_m2 = {}\n",
            0.3 * (0.02f64.powi(2) + 0.03f64.powi(2))
        );
        let [a, b] = [payload, &change].map(|effect| closed(&format!("{TURNTABLE}{effect}")));
        let [a, b] = [&a, &b].map(|rig| rig.mechanism.bodies[0].clone());
        assert!((a.mass - b.mass).abs() < 1e-12 && (a.inertia - b.inertia).abs() < 1e-12);
        assert!((a.reference - b.reference).norm() < 1e-12);
        assert!((a.start.position - b.start.position).norm() < 1e-12);
    }
}
