//! Oil in the gap between journal and ring: the short bearing.
//!
//! Where the bearing is short against its diameter, oil leaves it along the axis, and Reynolds' equation becomes
//! `∂/∂z (h³ ∂p/∂z) = 12 μ ∂h/∂t` in axes that turn with the mean of both bodies, with h = c (1 − ε cos θ), θ from the
//! line of centres. Its solution `p = 6 μ (L²/4 − z²)(v_r cos θ + v_t sin θ)/h³` (v the velocity of the journal's centre
//! in these axes) pushes the journal by
//!
//! `F = −(C/π) ∫ (v_r cos θ + v_t sin θ)/(1 − ε cos θ)³ (cos θ, sin θ) dθ`, `C = π μ R L³/c³`
//!
//! (F. W. Ocvirk, NACA TN 2808 (1952); J. F. Booker, J. Basic Eng. 87 (1965) 537–546). Sommerfeld's substitution
//! `cos θ = (ε + cos γ)/(1 + ε cos γ)` makes all of it elementary.

use nalgebra::Vector2;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Where the film presses.
///
/// [`Film`] has an example.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// All round: it pulls as much as it presses, which oil stands at slow motion and under pressure.
    Full,
    /// Where it presses only: what would pull is torn, at the pressure of the surroundings (Gümbel's condition).
    Pressing,
}

/// The film of one bearing.
///
/// ```
/// use freeplay::contact::{Extent, Film};
/// use nalgebra::Vector2;
///
/// let damping = Film::damping_of(0.1, 10e-3, 20e-3, 0.1e-3);
/// let film = Film { damping, extent: Extent::Full, eccentricity_max: 0.95, fades: false };
/// let [slow, fast] = [0.01, 0.02].map(|speed| film.force(0.0, Vector2::new(speed, 0.0)).x);
/// assert!(slow < 0.0, "a film holds against the motion");
/// assert!((fast / slow - 2.0).abs() < 1e-9);
/// assert!(film.full(0.8)[0] > film.full(0.0)[0], "stiffer near the wall");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// C in N·s/m: the damping of a centred journal in a full film.
    pub damping: f64,
    /// Where it presses.
    pub extent: Extent,
    /// ε from which the film grows no stiffer, below 1: surfaces are rough.
    pub eccentricity_max: f64,
    /// Whether the film ends where surfaces touch: its force fades from ε = 1 on, where the dry contact begins, and is
    /// gone at 2 − `eccentricity_max`, where the roughness is pressed flat.
    pub fades: bool,
}

impl Film {
    /// C in N·s/m of oil of a viscosity (Pa·s) in a bearing of radius and length (m), with a radial clearance (m).
    pub fn damping_of(viscosity: f64, radius: f64, length: f64, clearance: f64) -> f64 {
        PI * viscosity * radius * (length / clearance).powi(3)
    }

    /// Largest suction in Pa of a full film round a centred journal that moves at `speed` (m/s): in the middle of the
    /// bearing, `3 μ L² v/(2 c³)`.
    pub fn suction(viscosity: f64, length: f64, clearance: f64, speed: f64) -> f64 {
        1.5 * viscosity * length * length * speed / clearance.powi(3)
    }

    /// Force in N on the journal along the line of centres and across (turned by +90°), where its centre has the
    /// eccentricity ratio `ratio` and moves at `velocity` (m/s, along and across).
    pub fn force(&self, ratio: f64, velocity: Vector2<f64>) -> Vector2<f64> {
        let resistance = match self.extent {
            Extent::Full => {
                let [along, across] = self.full(ratio);
                Vector2::new(along * velocity.x, across * velocity.y)
            }
            Extent::Pressing => self.pressing(ratio.min(self.eccentricity_max), velocity),
        };
        -resistance * self.left(ratio)
    }

    /// Damping in N·s/m of a full film along and across the line of centres: `C (1 + 2ε²)/(1 − ε²)^(5/2)` and
    /// `C/(1 − ε²)^(3/2)`.
    pub fn full(&self, ratio: f64) -> [f64; 2] {
        let square = ratio.min(self.eccentricity_max).powi(2);
        let closing = 1.0 - square;
        let across = self.damping / (closing * closing.sqrt());
        [across * (1.0 + 2.0 * square) / closing, across]
    }

    /// The same integrals over the half where `v_r cos θ + v_t sin θ` is positive: from a quarter turn before the
    /// direction of the velocity to a quarter turn behind it.
    fn pressing(&self, ratio: f64, velocity: Vector2<f64>) -> Vector2<f64> {
        if velocity == Vector2::zeros() {
            return velocity;
        }
        let root = (1.0 - ratio * ratio).sqrt();
        let towards = velocity.y.atan2(velocity.x);
        let [from, to] = [towards - FRAC_PI_2, towards + FRAC_PI_2].map(|theta| {
            let (sin, cos) = theta.sin_cos();
            let thickness = 1.0 - ratio * cos;
            [root * sin / thickness, (cos - ratio) / thickness]
        });
        let arc = (to[0].atan2(to[1]) - from[0].atan2(from[1])).rem_euclid(TAU);
        let [sines, products] = [to[0] - from[0], to[0] * to[1] - from[0] * from[1]];
        // ∫ (ε + cos γ)² dγ, ∫ (ε + cos γ) sin γ dγ, ∫ sin² γ dγ.
        let along = ratio * ratio * arc + 2.0 * ratio * sines + 0.5 * (arc + products);
        let mixed = 0.5 * ((ratio + from[1]).powi(2) - (ratio + to[1]).powi(2));
        let across = 0.5 * (arc - products);
        let unit = self.damping / (PI * root.powi(3));
        Vector2::new(
            (along / root * velocity.x + mixed * velocity.y) / root,
            mixed / root * velocity.x + across * velocity.y,
        ) * unit
    }

    /// Share of the force that is left at an eccentricity ratio: 1 up to the contact, with level ends.
    fn left(&self, ratio: f64) -> f64 {
        if !self.fades || ratio <= 1.0 {
            return 1.0;
        }
        let s = ((ratio - 1.0) / (1.0 - self.eccentricity_max)).min(1.0);
        1.0 - s * s * (3.0 - 2.0 * s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FULL: Film =
        Film { damping: 7.0, extent: Extent::Full, eccentricity_max: 0.999, fades: true };
    const PRESSING: Film = Film { extent: Extent::Pressing, ..FULL };

    /// Reynolds' integral by the midpoint rule.
    fn integral(ratio: f64, v: Vector2<f64>, pressing: bool) -> Vector2<f64> {
        const N: usize = 200_000;
        let mut sum = Vector2::zeros();
        for k in 0..N {
            let (sin, cos) = (TAU * (k as f64 + 0.5) / N as f64).sin_cos();
            let squeeze = v.x * cos + v.y * sin;
            if squeeze > 0.0 || !pressing {
                sum += Vector2::new(cos, sin) * (squeeze / (1.0 - ratio * cos).powi(3));
            }
        }
        -sum * (FULL.damping / PI * TAU / N as f64)
    }

    #[test]
    fn forces_are_the_integral_of_reynolds_pressure() {
        for ratio in [0.0, 0.3, 0.8, 0.95] {
            for k in 0..12 {
                let v = Vector2::new(0.1, 0.0) * (1.0 + 0.1 * f64::from(k));
                let v = nalgebra::Rotation2::new(0.55 * f64::from(k)) * v;
                for (film, pressing) in [(FULL, false), (PRESSING, true)] {
                    let (found, sum) = (film.force(ratio, v), integral(ratio, v, pressing));
                    let off = (found - sum).norm() / sum.norm();
                    assert!(off < 1e-8, "{ratio} {v:?} {pressing}: {found:?} {sum:?}");
                }
            }
        }
        assert_eq!(PRESSING.force(0.4, Vector2::zeros()), Vector2::zeros());
    }

    /// `W = μ ω R L³ ε √(16 ε² + π² (1 − ε²))/(4 c² (1 − ε²)²)` at the attitude `tan φ = π √(1 − ε²)/(4 ε)` (G. B. DuBois,
    /// F. W. Ocvirk, NACA Report 1157 (1953)).
    #[test]
    fn a_turning_journal_carries_ocvirks_load() {
        let (viscosity, radius, length, clearance, spin) = (0.05, 0.02, 0.02, 5e-5, 100.0);
        let damping = Film::damping_of(viscosity, radius, length, clearance);
        let film = Film { damping, ..PRESSING };
        for ratio in [0.05f64, 0.3, 0.6, 0.9, 0.98] {
            let rest = Vector2::new(0.0, -ratio * clearance * 0.5 * spin);
            let force = film.force(ratio, rest);
            let square = ratio * ratio;
            let load = viscosity * spin * radius * length.powi(3) * ratio
                / (4.0 * clearance.powi(2) * (1.0 - square).powi(2))
                * (16.0 * square + PI * PI * (1.0 - square)).sqrt();
            assert!((force.norm() / load - 1.0).abs() < 1e-12, "{} {load}", force.norm());
            let attitude = force.y / -force.x;
            let published = PI * (1.0 - square).sqrt() / (4.0 * ratio);
            assert!((attitude / published - 1.0).abs() < 1e-12, "{attitude} {published}");
        }
    }

    #[test]
    fn the_film_ends_smoothly_where_the_roughness_is_pressed_flat() {
        let film = Film { eccentricity_max: 0.9, ..FULL };
        let along = |ratio: f64| -film.force(ratio, Vector2::x()).x;
        assert_eq!(along(0.95), along(1.0));
        assert!(along(1.1) < 1e-9 * along(1.0) && along(1.2) == 0.0);
        let half = along(1.05) / along(1.0);
        assert!((half - 0.5).abs() < 1e-12, "{half}");
        let rest = Film { fades: false, ..film };
        assert_eq!(rest.force(3.0, Vector2::x()), rest.force(0.9, Vector2::x()));
    }
}
