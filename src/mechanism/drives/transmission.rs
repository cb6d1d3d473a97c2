//! What stands between the drive of a joint and its rod or link, where that is not rigid. Units are those of a
//! prismatic joint; of a revolute one angles in rad stand for lengths, torques in N·m for forces.

/// A link without mass between a drive and its rod: play, then give. Both are zero in a rigid one.
///
/// The drive's end of the link stands where servo and link pull it equally hard, so that no state is
/// added. With e = q_cmd − q and the rod free between the flanks at ±play/2,
///
/// `F = K p + D ė` for p = e less what of it lies within ±play/2, and F = 0 at p = 0;
///
/// `D ė` is taken as at most `K |p|` either way: a flank pushes and never pulls, and its damping takes
/// hold with its pressure, without a jump where it is met. Without play `D ė` has no limit. K and D are
/// those of the servo in series with the link, both as spring and damper, to first order in the
/// frequency: k the link's stiffness and d its damping,
///
/// `K = k k_p/(k + k_p)`, `D = (k² k_d + k_p² d)/(k + k_p)²`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Transmission {
    /// How far the rod can move between the flanks, in m.
    pub play: f64,
    /// Give 1/k of the link in m/N.
    pub compliance: f64,
    /// Damping d of the link in N·s/m.
    pub damping: f64,
}

impl Transmission {
    /// K in N/m and D in N·s/m of a servo of these gains behind the link.
    pub(in crate::mechanism) fn gains(&self, [stiffness, damping]: [f64; 2]) -> [f64; 2] {
        let give = stiffness * self.compliance;
        let sum = 1.0 + give;
        [stiffness / sum, (damping + self.damping * give * give) / (sum * sum)]
    }

    /// Force in N on the rod, from the gains of the servo, q_cmd − q in m and its rate in m/s.
    pub(in crate::mechanism) fn force(&self, gains: [f64; 2], error: f64, rate: f64) -> f64 {
        let [stiffness, damping] = self.gains(gains);
        if self.play == 0.0 {
            return stiffness * error + damping * rate;
        }
        let pressed = error - self.gap(error);
        let spring = stiffness * pressed;
        // Not `clamp`, which refuses a limit that is no number: a run that breaks down says so itself.
        spring + (damping * rate).min(spring.abs()).max(-spring.abs())
    }

    /// How far in m the drive's end of the link is ahead of the rod while q_cmd − q is `error` (m) and
    /// the drive pushes with `force` N.
    pub(in crate::mechanism) fn ahead(&self, error: f64, force: f64) -> f64 {
        self.gap(error) + self.compliance * force
    }

    /// How far in m the drive's end is ahead of a rod that is known to be pushed with `force` N: it lies
    /// at one flank or the other. Where the force is no larger than its `noise` (N), that decides. Of a revolute joint
    /// rad and N·m.
    pub fn pressed(&self, force: f64, noise: f64) -> f64 {
        0.5 * self.play * (force / noise).tanh() + self.compliance * force
    }

    /// The part of `error` that lies between the flanks.
    fn gap(&self, error: f64) -> f64 {
        error.clamp(-0.5 * self.play, 0.5 * self.play)
    }
}
