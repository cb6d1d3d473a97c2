//! What a recording's own noise leaves to any model of a drive stage.

use crate::calibrate::errors::rms;
use crate::identify::stage::{cascade, controller_force};
use crate::measure::log::{Channel, Log};
use crate::scenario::Scenario;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, Normal};
use rayon::prelude::*;

/// Draws of noise that a floor is taken from: its own error is a sixth then.
const DRAWS: u64 = 8;

/// Median of the size of a normal variable in standard deviations.
const MEDIAN: f64 = 0.674_49;

/// Standard deviation of a column's white noise, from its third differences: what moves smoothly has next
/// to none at the rates that are read here, and those of white noise have `√(1 + 9 + 9 + 1)` times its
/// deviation. The median, so that hits do not count; at least what rounding to the column's own steps
/// makes, a step over √12.
pub fn white(values: &[f64]) -> f64 {
    let third = |w: &[f64]| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs();
    let mut sizes: Vec<f64> = values.windows(4).map(third).collect();
    sizes.sort_by(f64::total_cmp);
    let median = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    let steps = values.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|step| *step > 0.0);
    let step = steps.fold(f64::INFINITY, f64::min);
    let rounding = if step.is_finite() { step / 12f64.sqrt() } else { 0.0 };
    (median / (MEDIAN * 20f64.sqrt())).max(rounding)
}

/// Root mean square error that each measured channel would show against the very machine that made it: a
/// simulated recording with the recording's own white noise on its position, predicted by the same model.
pub fn floors(model: &Scenario, recorded: &Log, clean: &Log) -> Vec<(Channel, f64)> {
    let position = Channel::Length(0);
    let Some(values) = recorded.get(position) else { return Vec::new() };
    let Ok(normal) = Normal::new(0.0, white(values)) else { return Vec::new() };
    let exact = clean.get(position).unwrap_or_default();
    let drawn = (0..DRAWS).into_par_iter().map(|draw| {
        let mut random = ChaCha8Rng::seed_from_u64(7000 + draw);
        let noisy: Vec<f64> = exact.iter().map(|x| x + normal.sample(&mut random)).collect();
        let mut channels = vec![(position, noisy)];
        if let Some(cascade) = cascade(model) {
            let force = controller_force(&cascade, recorded, &channels[0].1);
            channels.push((Channel::Force(0), force));
        }
        let noisy = Log::new(&recorded.name, recorded.start, recorded.interval, channels);
        let error = |channel| Some((channel, rms(&noisy, clean, channel)?));
        noisy.channels().filter_map(error).collect()
    });
    let drawn = drawn.collect::<Vec<Vec<(Channel, f64)>>>();
    let mean = |channel: Channel| {
        let of = drawn.iter().flatten().filter(|(c, _)| *c == channel);
        (of.map(|(_, error)| error * error).sum::<f64>() / DRAWS as f64).sqrt()
    };
    drawn[0].iter().map(|(channel, _)| (*channel, mean(*channel))).collect()
}
