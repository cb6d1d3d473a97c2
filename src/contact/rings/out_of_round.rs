//! A bearing ring with waves round it.

/// A harmonic departure of the clearance from its mean, fixed to the ring's body: with θ the direction
/// of the eccentricity in the body's own axes,
///
/// `c(θ) = c + a cos(n (θ − θ₀))`.
///
/// Two lobes are an oval, three what a three-jaw chuck leaves (roundness as a Fourier series, ISO
/// 12181-1).
///
/// [`RingShape`](crate::contact::RingShape) has an example.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutOfRound {
    /// Amplitude a in m, smaller than the clearance.
    pub amplitude: f64,
    /// Number n of lobes round the ring.
    pub lobes: f64,
    /// Direction θ₀ in rad of one of the widest places.
    pub direction: f64,
}

impl OutOfRound {
    /// What it adds to the clearance in m, and its first two derivatives by `theta` (rad).
    pub(in crate::contact) fn at(&self, theta: f64) -> [f64; 3] {
        let (sin, cos) = (self.lobes * (theta - self.direction)).sin_cos();
        let wider = self.amplitude * cos;
        [wider, -self.amplitude * self.lobes * sin, -self.lobes.powi(2) * wider]
    }
}
