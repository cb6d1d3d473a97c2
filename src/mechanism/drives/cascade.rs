//! A position controller as machine tools have it: computed at instants, held in between.

use crate::mechanism::Command;

/// A cascade of a position and a velocity loop that is sampled every `interval`, with a drive whose
/// force is proportional to the controller's output. At sample k, with q the read length,
///
/// `u = clip(K_V (K_P (q_ref − q) − q̇_f), ± u_max) + u_added`, `q_f(k) = (q(k) + q(k−1))/2`,
/// `q̇_f = (q_f(k) − q_f(k−1))/T`
///
/// (Janot, Gautier, Brunot, *Data Set and Reference Models of EMPS*, Nonlinear System Identification
/// Benchmarks 2019). u is held until the next sample; the force follows it with the lag τ of the
/// drive's current loop, `τ Ḟ + F = G u`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cascade {
    /// K_P in 1/s.
    pub position_gain: f64,
    /// K_V in V/(m/s).
    pub velocity_gain: f64,
    /// T in s.
    pub interval: f64,
    /// u_max in V.
    pub limit: f64,
    /// G in N/V.
    pub force_gain: f64,
    /// τ in s; 0 is a drive without lag.
    pub lag: f64,
}

/// What a sampled controller remembers from sample to sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Held {
    /// Read length and q_f of the last sample, in m; none before the first.
    last: Option<[f64; 2]>,
    /// Time of the last sample in s.
    since: f64,
    /// Force in N that the drive had then, and the one that it is told.
    from: f64,
    to: f64,
}

impl Cascade {
    /// Takes a sample at time `t` (s) of the read length (m), and returns u in V. `added` is u_added.
    pub fn sample(
        &self,
        held: &mut Held,
        t: f64,
        command: &Command,
        length: f64,
        added: f64,
    ) -> f64 {
        // Before the first sample the machine was where it is.
        let [before, mean_before] = held.last.unwrap_or([length; 2]);
        let mean = 0.5 * (length + before);
        let rate = (mean - mean_before) / self.interval;
        let asked = self.velocity_gain * (self.position_gain * (command.position - length) - rate);
        let voltage = asked.clamp(-self.limit, self.limit) + added;
        *held = Held {
            last: Some([length, mean]),
            since: t,
            from: self.force(held, t),
            to: self.force_gain * voltage,
        };
        voltage
    }

    /// Force of the drive in N at time `t` (s), not before the last sample.
    pub fn force(&self, held: &Held, t: f64) -> f64 {
        if self.lag == 0.0 {
            return held.to;
        }
        held.to + (held.from - held.to) * (-(t - held.since) / self.lag).exp()
    }

    /// What the controller asks of its drive at samples one after another, `G u` in N, from the commands, the read
    /// lengths (both in m) and what is added to its output (V; nothing where nobody says).
    pub fn outputs(&self, commands: &[f64], read: &[f64], added: Option<&[f64]>) -> Vec<f64> {
        let mut held = Held::default();
        (commands.iter().zip(read).enumerate())
            .map(|(k, (position, length))| {
                let command = Command { position: *position, ..Command::default() };
                let added = added.and_then(|added| added.get(k)).copied().unwrap_or(0.0);
                let t = k as f64 * self.interval;
                self.force_gain * self.sample(&mut held, t, &command, *length, added)
            })
            .collect()
    }

    /// Force of the drive in N at samples that come every `interval` s, when it is asked for `outputs` (N) there: what
    /// is held comes half a sample late, `y(t) = G u(t − T/2)`, and the drive follows it, `τ Ḟ + F = y`, exactly
    /// so where y goes along straight lines. Right for what moves slowly against T.
    pub fn forces(&self, outputs: &[f64], interval: f64) -> Vec<f64> {
        let late = 0.5 * self.interval / interval;
        let held = |k: usize| {
            let place = (k as f64 - late).max(0.0);
            let (i, share) = (place as usize, place.fract());
            let next = outputs.get(i + 1).unwrap_or(&outputs[i]);
            outputs[i] + (next - outputs[i]) * share
        };
        let decay = if self.lag > 0.0 { (-interval / self.lag).exp() } else { 0.0 };
        // The answer to a slope from sample to sample is late by τ, less what it has forgotten.
        let behind = self.lag / interval * (1.0 - decay);
        let mut last: Option<[f64; 2]> = None;
        (0..outputs.len())
            .map(|k| {
                let now = held(k);
                let force = last.map_or(now, |[before, force]| {
                    now + (force - before) * decay - (now - before) * behind
                });
                last = Some([now, force]);
                force
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASCADE: Cascade = Cascade {
        position_gain: 100.0,
        velocity_gain: 200.0,
        interval: 1e-3,
        limit: 10.0,
        force_gain: 30.0,
        lag: 2e-3,
    };

    #[test]
    fn output_is_that_of_the_difference_equation() {
        let mut held = Held::default();
        let command = Command { position: 1e-3, ..Command::default() };
        let lengths = [0.0, 1e-6, 4e-6, 9e-6];
        let mut before = [0.0, 0.0];
        for (k, q) in lengths.into_iter().enumerate() {
            let mean = 0.5 * (q + before[0]);
            let expected = 200.0 * (100.0 * (1e-3 - q) - (mean - before[1]) / 1e-3);
            let u = CASCADE.sample(&mut held, k as f64 * 1e-3, &command, q, 0.5);
            assert!((u - expected.clamp(-10.0, 10.0) - 0.5).abs() < 1e-12, "{k}: {u} {expected}");
            before = [q, mean];
        }
    }

    /// What outputs say of a force that varies slowly is what the drive gives in between.
    #[test]
    fn forces_of_outputs_are_those_that_the_drive_gives() {
        let command =
            |k: usize| Command { position: 4e-4 * (0.02 * k as f64).sin(), ..Command::default() };
        let references: Vec<f64> = (0..400).map(|k| command(k).position).collect();
        let outputs = CASCADE.outputs(&references, &vec![0.0; 400], None);
        let told = CASCADE.forces(&outputs, CASCADE.interval);
        let (mut held, mut largest) = (Held::default(), 0.0f64);
        for k in 0..399 {
            CASCADE.sample(&mut held, k as f64 * 1e-3, &command(k), 0.0, 0.0);
            let middle = CASCADE.force(&held, (k as f64 + 0.5) * 1e-3);
            let expected = 0.5 * (told[k] + told[k + 1]);
            largest = largest.max(middle.abs());
            assert!(k < 20 || (middle - expected).abs() < 0.5, "{k}: {middle} {expected}");
        }
        assert!(largest > 200.0);
    }

    #[test]
    fn force_follows_with_its_lag_and_without_jumps() {
        let mut held = Held::default();
        let command = Command { position: 1e-4, ..Command::default() };
        let u = CASCADE.sample(&mut held, 0.0, &command, 0.0, 0.0);
        assert_eq!(CASCADE.force(&held, 0.0), 0.0);
        let later = CASCADE.force(&held, 2e-3);
        assert!((later - 30.0 * u * (1.0 - (-1f64).exp())).abs() < 1e-12, "{later}");
        CASCADE.sample(&mut held, 2e-3, &Command::default(), 0.0, 0.0);
        assert_eq!(CASCADE.force(&held, 2e-3), later);
    }
}
