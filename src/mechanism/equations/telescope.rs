//! A prismatic joint at one state, and the motion of the two bodies that it alone connects.

use crate::mechanism::{Body, BodyState, Prismatic};
use nalgebra::{UnitComplex, Vector2, Vector3};

/// Geometry of a prismatic joint. With u the joint's axis, n = u turned by +90°, ω the angular
/// velocity that both bodies share (`u̇ = ω n`, `ṅ = −ω u`), d from the base's centre of mass to
/// the slider's: `L = d·u`, `w = d·n`, and the joint's length is L plus a constant.
#[derive(Clone, Copy, Debug)]
pub(in crate::mechanism) struct Telescope {
    pub u: Vector2<f64>,
    pub n: Vector2<f64>,
    /// L and w in m.
    pub offset: [f64; 2],
    /// ḋ in m/s.
    pub rate: Vector2<f64>,
    /// ω in rad/s.
    pub spin: f64,
    /// Length q in m.
    pub length: f64,
    /// q̇ in m/s.
    pub length_rate: f64,
}

impl Prismatic {
    /// Length of the joint in m at the given states.
    pub fn length(&self, states: &[BodyState]) -> f64 {
        self.telescope(states).length
    }

    /// How far the slider has come off the axis, in m, and what the angle between the two makes over the
    /// joint's length.
    pub fn drift(&self, states: &[BodyState]) -> f64 {
        let [across, turned] = self.come_off(states);
        across.abs() + turned.abs() * self.length(states).abs()
    }

    /// How far the slider has come off the axis, in m along its normal, and turned against the base, in rad (its
    /// sine).
    pub(in crate::mechanism) fn come_off(&self, states: &[BodyState]) -> [f64; 2] {
        let [base, slider] = self.points();
        let across = self.telescope(states).offset[1] + slider.y - base.y;
        let rotation =
            |body: Option<usize>, axis| body.map_or(axis, |i: usize| states[i].rotation * axis);
        let [base, slider] =
            [rotation(self.base.body, self.axes[0]), rotation(self.slider.body, self.axes[1])];
        [across, base.re * slider.im - base.im * slider.re]
    }

    pub(in crate::mechanism) fn telescope(&self, states: &[BodyState]) -> Telescope {
        Telescope::new(self, states)
    }
}

/// What of a prismatic joint does not depend on the state.
#[derive(Clone, Copy, Debug)]
pub(in crate::mechanism) struct Slideway {
    bodies: [Option<usize>; 2],
    axis: UnitComplex<f64>,
    /// Points of base and slider from their centres of mass, along and across the axis, in m.
    pub points: [Vector2<f64>; 2],
}

/// What of the masses of two bodies on one axis their accelerations depend on.
#[derive(Clone, Copy, Debug)]
pub(in crate::mechanism) struct PairMasses {
    /// Of base and slider in kg.
    masses: [f64; 2],
    /// 1/(m₁ + m₂) in 1/kg.
    inverse_sum: f64,
    /// μ = m₁m₂/(m₁ + m₂) in kg.
    reduced: f64,
    /// I₁ + I₂ in kg m².
    inertia: f64,
}

impl PairMasses {
    pub fn new(bodies: [&Body; 2]) -> Self {
        let masses = bodies.map(|body| body.mass);
        let [m1, m2] = masses;
        let inertia = bodies[0].inertia + bodies[1].inertia;
        let inverse_sum = 1.0 / (m1 + m2);
        Self { masses, inverse_sum, reduced: m1 * m2 / (m1 + m2), inertia }
    }

    /// Shares of the masses of slider and base in their sum: with d from the base's centre of mass to the slider's,
    /// their common one is `s₀ d` from the base's and `s₁ d` from the slider's.
    pub fn shares(&self) -> [f64; 2] {
        [self.masses[1] * self.inverse_sum, self.masses[0] * self.inverse_sum]
    }

    /// Radius in m of gyration of both about their common centre of mass, `length` m apart: `√((I₁ + I₂ + μL²)/m)`.
    pub fn radius(&self, length: f64) -> f64 {
        ((self.inertia + self.reduced * length * length) * self.inverse_sum).sqrt()
    }
}

impl Slideway {
    pub fn new(joint: &Prismatic) -> Self {
        Self { bodies: joint.bodies(), axis: joint.axes[0], points: joint.points() }
    }
}

impl Telescope {
    pub fn new(joint: &Prismatic, states: &[BodyState]) -> Self {
        Self::on(&Slideway::new(joint), states)
    }

    pub fn on(way: &Slideway, states: &[BodyState]) -> Self {
        let ground = BodyState::ground();
        let [base, slider] = way.bodies.map(|body| body.map_or(&ground, |i| &states[i]));
        Self::between(way, base, slider)
    }

    /// The same from the states of base and slider.
    #[inline(always)]
    pub fn between(way: &Slideway, base: &BodyState, slider: &BodyState) -> Self {
        let axis = base.rotation * way.axis;
        let spin = base.twist.z;
        let (u, n) = (Vector2::new(axis.re, axis.im), Vector2::new(-axis.im, axis.re));
        let d = slider.position - base.position;
        let rate = slider.twist.xy() - base.twist.xy();
        let offset = [d.dot(&u), d.dot(&n)];
        let [base, slider] = way.points;
        Self {
            u,
            n,
            offset,
            rate,
            spin,
            length: offset[0] + slider.x - base.x,
            length_rate: rate.dot(&u) + spin * offset[1],
        }
    }

    /// Wrenches on base and slider of a drive force (N, positive when it extends).
    #[inline(always)]
    pub fn drive(&self, force: f64) -> [Vector3<f64>; 2] {
        let f = self.u * force;
        [Vector3::new(-f.x, -f.y, self.offset[1] * force), Vector3::new(f.x, f.y, 0.0)]
    }

    /// The same from the direction of the base and where the joint stands: L in m and L̇ in m/s, with the
    /// joint's spin in rad/s; off the axis by nothing.
    #[inline(always)]
    pub fn reaching(
        way: &Slideway,
        rotation: UnitComplex<f64>,
        [length, length_rate]: [f64; 2],
        spin: f64,
    ) -> Self {
        let axis = rotation * way.axis;
        let (u, n) = (Vector2::new(axis.re, axis.im), Vector2::new(-axis.im, axis.re));
        let [base, slider] = way.points;
        let side = base.y - slider.y;
        Self {
            u,
            n,
            offset: [length, side],
            rate: u * (length_rate - spin * side) + n * (spin * length),
            spin,
            length: length + slider.x - base.x,
            length_rate,
        }
    }

    /// d, from the base's centre of mass to the slider's, in m.
    #[inline(always)]
    pub fn between_centres(&self) -> Vector2<f64> {
        let [length, side] = self.offset;
        self.u * length + self.n * side
    }

    /// q̈ in m/s² from d̈ (m/s²) and the angular acceleration α (rad/s²): `d̈·u + α w + 2ω ḋ·n − ω² L`.
    #[inline(always)]
    pub fn extension(&self, apart: Vector3<f64>, alpha: f64) -> f64 {
        let Self { u, n, offset: [length, side], rate, spin, .. } = *self;
        apart.xy().dot(&u) + alpha * side + 2.0 * spin * rate.dot(&n) - spin * spin * length
    }

    /// How the two bodies go on under the given wrenches, if no other rigid joint holds them. `extension` is the
    /// prescribed q̈, if the drive prescribes it.
    ///
    /// The rod's force R is what `b = d̈` takes: `R = μ (b − f₂/m₂ + f₁/m₁)`, μ = m₁m₂/(m₁ + m₂);
    /// both turn with α, `(I₁ + I₂) α = τ₁ + τ₂ − d × R`. Prescribed, b is known but for α,
    /// `b = (q̈ − ω²L − αw) u + (αL + 2q̇'ω − ω²w) n` with q̇' = ḋ·u + ωw, so that
    ///
    /// `α (I₁ + I₂ + μ(L² + w²)) = τ₁ + τ₂ − μ d × (b₀ − f₂/m₂ + f₁/m₁)`, b₀ = b at α = 0;
    ///
    /// free along the axis, R has no part along u, and L² stands for L² + w².
    #[inline(always)]
    pub fn motion(
        &self,
        masses: &PairMasses,
        wrenches: &[Vector3<f64>; 2],
        extension: Option<f64>,
    ) -> PairMotion {
        let Self { u, n, offset: [length, side], spin, .. } = *self;
        let PairMasses { masses: [m1, m2], reduced, inertia, .. } = *masses;
        let free = wrenches[1].xy() / m2 - wrenches[0].xy() / m1;
        let (free_u, free_n) = (free.dot(&u), free.dot(&n));
        let b_n = 2.0 * self.length_rate * spin - spin * spin * side;
        let inertia = inertia + reduced * length * length;
        let torque = wrenches[0].z + wrenches[1].z - reduced * length * (b_n - free_n);
        let (alpha, extension, force) = match extension {
            Some(extension) => {
                let b_u = extension - spin * spin * length;
                let alpha =
                    (torque + reduced * side * (b_u - free_u)) / (inertia + reduced * side * side);
                (alpha, extension, reduced * (b_u - alpha * side - free_u))
            }
            None => {
                let alpha = torque / inertia;
                (alpha, free_u + spin * spin * length + alpha * side, 0.0)
            }
        };
        let reaction = u * force + n * (reduced * (b_n + alpha * length - free_n));
        PairMotion { alpha, extension, force, reaction }
    }
}

/// How two bodies on one slide go on.
#[derive(Clone, Copy, Debug)]
pub(in crate::mechanism) struct PairMotion {
    /// Angular acceleration of both in rad/s².
    pub alpha: f64,
    /// q̈ in m/s².
    pub extension: f64,
    /// Force of a drive that prescribes it, in N.
    pub force: f64,
    /// Force of the base on the slider, that drive's included, in N.
    reaction: Vector2<f64>,
}

impl PairMotion {
    /// Accelerations of base and slider under those wrenches.
    #[inline(always)]
    pub fn of_bodies(
        &self,
        masses: &PairMasses,
        wrenches: &[Vector3<f64>; 2],
    ) -> [Vector3<f64>; 2] {
        let [m1, m2] = masses.masses;
        let a1 = (wrenches[0].xy() - self.reaction) / m1;
        let a2 = (wrenches[1].xy() + self.reaction) / m2;
        [a1.push(self.alpha), a2.push(self.alpha)]
    }

    /// Acceleration of their common centre of mass (m/s²) under those wrenches.
    #[inline(always)]
    pub fn of_centre(masses: &PairMasses, wrenches: &[Vector3<f64>; 2]) -> Vector2<f64> {
        (wrenches[0].xy() + wrenches[1].xy()) * masses.inverse_sum
    }
}
