//! The force in one clearance joint: Hertz, damping with a STEP, never pulling, and Coulomb friction.

use super::machine::contact_stiffness;

/// Slip at which friction reaches tanh 1 of its full value, in m/s.
const SLIP_SPEED: f64 = 1e-3;

pub struct ContactLaw {
    pub clearance: f64,
    stiffness: f64,
    c_max: f64,
    inverse_d_max: f64,
    friction: f64,
    journal_radius: f64,
}

/// A journal beyond its clearance: where it is and how it moves in the bearing.
pub struct Meeting {
    /// Journal centre less bearing centre.
    pub e: [f64; 2],
    /// Its rate.
    pub v: [f64; 2],
    pub journal_spin: f64,
    pub bearing_spin: f64,
}

/// What acts in a joint: the force on the journal at its centre, and the moments friction adds.
pub struct Load {
    pub normal: f64,
    pub on_journal: [f64; 2],
    pub journal_moment: f64,
    pub bearing_moment: f64,
}

impl ContactLaw {
    /// Damping `c_max` in N·s/m of a contact deeper than `d_max` m; `friction` is Coulomb's coefficient.
    pub fn new(
        bearing_radius: f64,
        clearance: f64,
        [c_max, d_max]: [f64; 2],
        friction: f64,
    ) -> Self {
        let journal_radius = bearing_radius - clearance;
        Self {
            clearance,
            stiffness: contact_stiffness(bearing_radius, journal_radius),
            c_max,
            inverse_d_max: 1.0 / d_max,
            friction,
            journal_radius,
        }
    }

    /// `F = max(0, K δ^1.5 + STEP(δ) δ̇)`, `−F n` on the journal.
    #[inline(always)]
    pub fn load(&self, meeting: &Meeting) -> Load {
        let ([ex, ey], [vx, vy]) = (meeting.e, meeting.v);
        let distance = (ex * ex + ey * ey).sqrt();
        let inverse = 1.0 / distance;
        let (nx, ny) = (ex * inverse, ey * inverse);
        let depth = distance - self.clearance;
        let s = (depth * self.inverse_d_max).min(1.0);
        let damping = self.c_max * s * s * (3.0 - 2.0 * s);
        let hertz = self.stiffness * depth * depth.sqrt();
        let normal = (hertz + damping * (vx * nx + vy * ny)).max(0.0);
        let mut load = Load {
            normal,
            on_journal: [-normal * nx, -normal * ny],
            journal_moment: 0.0,
            bearing_moment: 0.0,
        };
        if self.friction > 0.0 {
            self.add_friction(&mut load, meeting, [nx, ny], distance);
        }
        load
    }

    /// `μ F tanh(v_t/v_s)` at the journal's surface point, along t = n turned by a right angle;
    /// arms `R_j` from the journal's centre, `R_j + |e|` from the bearing's.
    fn add_friction(&self, load: &mut Load, meeting: &Meeting, [nx, ny]: [f64; 2], distance: f64) {
        let journal_arm = self.journal_radius;
        let bearing_arm = self.journal_radius + distance;
        let slip = meeting.v[1] * nx - meeting.v[0] * ny + journal_arm * meeting.journal_spin
            - bearing_arm * meeting.bearing_spin;
        let force = self.friction * load.normal * (slip / SLIP_SPEED).tanh();
        load.on_journal[0] += force * ny;
        load.on_journal[1] -= force * nx;
        load.journal_moment = -force * journal_arm;
        load.bearing_moment = force * bearing_arm;
    }
}
