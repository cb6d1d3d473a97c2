//! What pulls a point of a mechanism towards a fixed place, or pushes it away, by a law that nobody can name: a magnet, a rubber
//! band, a stop with a soft face.

use super::efforts::gaussians;
use crate::effects::Wrong;
use crate::mechanism::{Load, Mark, Mechanism, Situation};
use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What a central force is a function of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OverDistance {
    /// The distance of the point from the place.
    Distance,
}

/// A force along the line from a point of the machine to a fixed place, as a fitted table over the distance of the two: a
/// central force (Goldstein, *Classical Mechanics*, §3.1).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Central {
    /// Always the distance.
    pub depends_on: OverDistance,
    /// The point, as `body.point`; none: the output's reference point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<String>,
    /// The place (m).
    pub place: [f64; 2],
    /// The nearest and the farthest distance (m) where it was fitted; beyond, the force is as there.
    pub reach: [f64; 2],
    /// N for each Gaussian from the nearest distance to the farthest, positive towards the place.
    pub coefficients: Vec<f64>,
}

impl Central {
    /// A table of so many numbers that is no force yet, on a point that was between these distances from a place.
    pub fn empty(point: Option<String>, place: [f64; 2], reach: [f64; 2], count: usize) -> Self {
        let coefficients = vec![0.0; count];
        Self { depends_on: OverDistance::Distance, point, place, reach, coefficients }
    }

    /// A distance (m) as a share of the range where it was fitted, 0 to 1.
    fn share(&self, distance: f64) -> f64 {
        let [near, far] = self.reach;
        ((distance - near) / (far - near)).clamp(0.0, 1.0)
    }

    /// The force (N) towards the place at a distance (m) from it.
    pub fn force(&self, distance: f64) -> f64 {
        let rings = gaussians(2.0 * self.share(distance) - 1.0, self.coefficients.len());
        rings.zip(&self.coefficients).map(|(ring, coefficient)| ring * coefficient).sum()
    }

    /// Where the point is.
    pub fn mark(&self, mechanism: &Mechanism) -> Option<Mark> {
        let Some(name) = &self.point else {
            return Some(Mark { body: Some(mechanism.output), point: Vector2::zeros() });
        };
        mechanism.names.points.get(name).map(|point| point.mark)
    }

    /// Reads the keys of an `[[effect]]` of this kind.
    pub(in crate::effects) fn from_table(table: &toml::Table) -> Result<Self, Wrong> {
        let wrong = |message: &str| Wrong::torn("coefficients", message);
        let read = Self::deserialize(table.clone()).map_err(|error| wrong(error.message()))?;
        let [near, far] = read.reach;
        if !(0.0 <= near && near < far) {
            return Err(Wrong::torn("reach", "is not from one distance to a larger one"));
        }
        if read.coefficients.len() < 2 {
            return Err(wrong("has fewer than two numbers"));
        }
        Ok(read)
    }
}

/// A central force at work in a machine.
#[derive(Debug)]
struct AppliedCentral {
    table: Arc<Central>,
    mark: Mark,
}

impl Load for AppliedCentral {
    fn add(&self, at: Situation, wrenches: &mut [Vector3<f64>]) {
        let towards = Vector2::from(self.table.place) - at.point(self.mark).position;
        let distance = towards.norm();
        if distance > 0.0 {
            let force = towards * (self.table.force(distance) / distance);
            at.push_point(self.mark, force, 0.0, wrenches);
        }
    }
}

pub(super) fn apply(table: &Arc<Central>, mechanism: &mut Mechanism) -> Result<(), Wrong> {
    let Some(mark) = table.mark(mechanism) else {
        let name = table.point.as_deref().unwrap_or("");
        let known = mechanism.names.points.keys().map(String::as_str);
        return Err(Wrong::of_another_machine("point", "point", name, known));
    };
    mechanism.loads.push(Arc::new(AppliedCentral { table: Arc::clone(table), mark }));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::rigs::{WHEEL_AND_SLIDE, ended};

    /// Far from the place the force is constant: `v(t) = v₀ + F t/m`.
    #[test]
    fn a_central_force_pulls_at_its_point() {
        let mut table = Central::empty(None, [100.0, 1.0], [1.0, 2.0], 4);
        table.coefficients = vec![1.0; 4];
        let force = table.force(100.0);
        let effect = format!(
            "[[output]]\nbody = \"slide\"\n[[effect]]\nkind = \"unnamed\"\ndepends_on = \"distance\"\n\
             place = [100.0, 1.0]\nreach = [1.0, 2.0]\ncoefficients = {:?}\n",
            table.coefficients
        );
        let slide = ended(&format!("{WHEEL_AND_SLIDE}{effect}"), 0.1)[1].twist.x;
        assert!((slide - (0.5 + force / 2.0 * 0.1)).abs() < 1e-6, "{slide} {force}");
    }

    /// Between the distances where it was fitted it is smooth; beyond them it is as there.
    #[test]
    fn a_force_goes_on_beyond_its_reach_as_at_its_end() {
        let mut table = Central::empty(None, [0.0, 0.0], [0.1, 0.2], 8);
        table.coefficients[7] = 3.0;
        assert!((table.force(0.2) - 3.0).abs() < 1e-12 && table.force(5.0) == table.force(0.2));
        assert!(table.force(0.1).abs() < 1e-9 && table.force(0.0) == table.force(0.1));
    }

    #[test]
    fn tables_that_do_not_fit_are_refused() {
        let read = |text: &str| {
            let head = "depends_on = \"distance\"\nplace = [0.0, 0.0]\n";
            Central::from_table(&toml::from_str(&format!("{head}{text}")).unwrap_or_default())
        };
        for bad in [
            "reach = [0.2, 0.1]\ncoefficients = [1.0, 2.0]",
            "reach = [-0.2, 0.1]\ncoefficients = [1.0, 2.0]",
            "reach = [0.1, 0.2]\ncoefficients = [1.0]",
            "reach = [0.1, 0.2]\ncoefficients = [1.0, 2.0]\njoints = [\"O\"]",
        ] {
            assert!(read(bad).is_err(), "{bad}");
        }
        assert!(read("reach = [0.1, 0.2]\ncoefficients = [1.0, 2.0]").is_ok());
    }
}
