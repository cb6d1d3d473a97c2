//! A point of a body that is not where it was declared: a link drilled too long, a mount beside its place.

use crate::effects::kind::{defaults, linear};
use crate::effects::{Kind, Parameter, Setting, Targets, Wrong};
use crate::mechanism::Mechanism;
use nalgebra::Vector2;

/// More than 50 mm would be seen; 10 µm is what a machinist works to.
const fn component(name: &'static str, about: &'static str) -> Parameter {
    Parameter { name, unit: "m", about, bounds: [-0.05, 0.05], step: 1e-5, default: Some(0.0) }
}

pub(in crate::effects) const KIND: Kind = Kind {
    name: "point-offset",
    summary: "a named point of a body, or of the ground, beside its declared place: joints, spring ends and \
              sensors there move with it",
    equation: "p = p declared + (dx, dy) in the axes of the body",
    source: "geometry",
    trace: "measured coordinates of joints against each other: with the pose, whatever the speed",
    targets: Targets::Point,
    parameters: &[
        component("dx_m", "where it really is along the body's x axis, less declared"),
        component("dy_m", "where it really is along the body's y axis, less declared"),
    ],
    variants: &[&["dx_m"], &["dy_m"], &["dx_m", "dy_m"]],
    neutral: defaults,
    starts: linear,
    scan: None,
    apply,
};

fn apply(setting: &Setting, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let name = setting.point(mechanism)?;
    let by = Vector2::new(setting.number("dx_m"), setting.number("dy_m"));
    mechanism.move_point(name, by);
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::effects::rigs::{SLIDER_CRANK, closed};

    /// x = r cos q + √(L² − r² sin² q), with the rod L as long as it really is.
    #[test]
    fn a_longer_rod_pushes_the_piston_on() {
        for (dx, dy) in [(0.0, 0.0), (2e-3, 0.0), (-1e-3, 3e-3)] {
            let effect = format!(
                "[[effect]]\nkind = \"point-offset\"\npoint = \"rod.B\"\ndx_m = {dx}\ndy_m = {dy}\n"
            );
            let machine = closed(&format!("{SLIDER_CRANK}{effect}"));
            let length = f64::hypot(0.15 + dx, dy);
            let (sin, cos) = 0.5f64.sin_cos();
            let expected = 0.05 * cos + (length * length - (0.05 * sin).powi(2)).sqrt();
            let piston = machine.mechanism.bodies[2].start.position;
            assert!((piston.x - expected).abs() < 1e-11, "{dx} {dy}: {} {expected}", piston.x);
            // The sensor of the point sees where the pin is.
            let [at_rod, at_piston] = ["x_B", "x_P"].map(|column| machine.reads(column));
            assert!((at_rod - at_piston).abs() < 1e-11 && (at_rod - expected).abs() < 1e-11);
            // What is written of the point is what is there.
            let output = &machine.layout.outputs[1];
            let states = machine.states();
            let reference = machine.mechanism.bodies[output.body].reference;
            assert!((output.state(&states, reference).position.x - expected).abs() < 1e-11);
        }
    }
}
