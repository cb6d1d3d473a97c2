//! Noise of sensors that is not what is declared.
//!
//! Near half the rate of sampling machines hardly move, and what a sensor shows there is noise: the power
//! in a band in short blocks, less that of a simulated recording without noise, beside what the declared noise has there
//! (Welch, *IEEE Trans. Audio Electroacoust.* 15 (1967) 70–73, averages a spectrum over a band alike).

use crate::calibrate::quantity;
use crate::calibrate::sensed::motion::simulate::{deviation, with_noise};
use crate::calibrate::sensed::recorded::recording::Recording;
use crate::calibrate::sensed::residuals::problem::RigProblem;
use crate::calibrate::sensed::thresholds::{
    MEDIAN, NOISE_BAND, NOISE_DRAWS, OTHER_NOISE, SURE, SURE_NOISE,
};
use crate::calibrate::values::spectrum::{Signal, fast_length, transform};
use crate::mechanism::{Mechanism, Reads, Sensor};
use crate::scenario::Scenario;

/// A sensor whose noise is not what is declared.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct OtherNoise {
    /// Its column.
    pub column: String,
    /// Standard deviation as declared, rounding among it, in its unit; 0 where none is.
    pub declared: f64,
    /// The same as measured.
    pub measured: f64,
    /// Its unit.
    pub unit: &'static str,
    /// The white part of what is declared, in the same.
    #[serde(skip)]
    white: f64,
}

/// Sensors whose noise differs from what is declared by more than chance and by more than it matters; `simulated`
/// are noiseless recordings of the declared machine, run by run. The problem goes on with what was measured.
///
/// Sensors that declare none are given that of the first recording beforehand, and are among what is found.
pub fn correct(problem: &mut RigProblem, simulated: &[Vec<Recording>]) -> Vec<OtherNoise> {
    let before = problem.declared.sensors.clone();
    if let Some(run) = problem.runs.first() {
        measured(&mut problem.declared.sensors, &run.recording);
    }
    let mut found = beside(problem, simulated, &|_| true);
    let silent = before.iter().map(is_silent).zip(&problem.declared.sensors);
    for (_, sensor) in silent.filter(|(silent, sensor)| *silent && !is_silent(sensor)) {
        found.retain(|other| other.column != sensor.column);
        let (measured, unit) = (deviation(sensor, &[]), sensor.unit(&problem.declared));
        let (column, declared) = (sensor.column.clone(), 0.0);
        found.push(OtherNoise { column, declared, measured, unit, white: 0.0 });
    }
    found
}

/// Which of `noises`, found beside the declared machine, are other than declared beside noiseless recordings of the calibrated
/// one, too: what shakes that was no sensor's noise. Other sensors have the noise again that they declare.
pub fn borne_out(
    problem: &mut RigProblem,
    noises: Vec<OtherNoise>,
    simulated: &[Vec<Recording>],
) -> Vec<OtherNoise> {
    let (other, silent): (Vec<_>, Vec<_>) =
        noises.into_iter().partition(|noise| noise.declared > 0.0);
    let of = |sensor: &Sensor| other.iter().find(|noise| noise.column == sensor.column);
    for sensor in &mut problem.declared.sensors {
        sensor.std = of(sensor).map_or(sensor.std, |noise| noise.white);
    }
    let mut found = beside(problem, simulated, &|sensor| of(sensor).is_some());
    found.extend(silent);
    found
}

/// Of `asked` sensors those whose noise differs from what they have by now.
fn beside(
    problem: &mut RigProblem,
    simulated: &[Vec<Recording>],
    asked: &dyn Fn(&Sensor) -> bool,
) -> Vec<OtherNoise> {
    let mut found = Vec::new();
    for i in 0..problem.declared.sensors.len() {
        let sensor = problem.declared.sensors[i].clone();
        let noisy = sensor.std > 0.0 || sensor.resolution > 0.0;
        if sensor.tells() || !noisy || !asked(&sensor) {
            continue;
        }
        // Of each quiet block the ratio of its power to what noise as declared has there, for the recording and for draws
        // of such noise.
        let mut quiet: Vec<Vec<f64>> = vec![Vec::new(); 1 + NOISE_DRAWS as usize];
        let mut lines = 0;
        for (run, simulated) in problem.runs.iter().zip(simulated) {
            let (Some(clean), Some(log)) = (simulated.first(), run.recording.get(i)) else {
                continue;
            };
            let Some(values) = clean.get(i) else { continue };
            let block = (BLOCK / run.recording.interval).ceil() as usize;
            let own = powers(values, block);
            let drawn = (0..NOISE_DRAWS).filter_map(|seed| {
                let noisy = with_noise(clean, &problem.declared.sensors, 3000 + seed);
                noisy.get(i).map(|noisy| powers(noisy, block))
            });
            let all: Vec<Vec<(f64, usize)>> =
                std::iter::once(powers(log, block)).chain(drawn).collect();
            for (b, (own, count)) in own.iter().enumerate() {
                let expected = all[1..].iter().map(|draw| draw[b].0 - own).sum::<f64>()
                    / (all.len() - 1) as f64;
                if *own < CLEAR * expected {
                    let pairs = quiet.iter_mut().zip(&all);
                    pairs.for_each(|(ratios, all)| ratios.push((all[b].0 - own) / expected));
                    lines += count;
                }
            }
        }
        let Some(ratio) = ratio(&quiet, lines) else { continue };
        // The lowest tenth of powers of noise in n lines of a spectrum scatters by 1.71 √(2/n) of itself, and the median by
        // less.
        let chance = SURE_NOISE * 1.71 * (2.0 / lines as f64).sqrt();
        let other = !(1.0 / OTHER_NOISE.powi(2)..=OTHER_NOISE.powi(2)).contains(&ratio);
        if !ratio.is_finite() || ratio <= 0.0 || !other || (ratio - 1.0).abs() < chance {
            continue;
        }
        let std = white(&sensor, ratio);
        let declared = deviation(&sensor, &[]);
        let unit = sensor.unit(&problem.declared);
        problem.declared.sensors[i].std = std;
        let measured = deviation(&problem.declared.sensors[i], &[]);
        found.push(OtherNoise {
            column: sensor.column,
            declared,
            measured,
            unit,
            white: sensor.std,
        });
    }
    found
}

/// White noise beside its rounding with which a sensor's noise has `ratio` times its power; 0 where rounding alone has
/// more.
fn white(sensor: &Sensor, ratio: f64) -> f64 {
    let rounding = sensor.resolution.powi(2) / 12.0;
    (ratio * (sensor.std.powi(2) + rounding) - rounding).max(0.0).sqrt()
}

/// What speaks against the noise that a rig declares: more than all that a column ever shows.
pub fn wrong(rig: &Scenario, machine: &Mechanism, recordings: &[Recording]) -> Vec<String> {
    let range = |i: usize| {
        let own = recordings.iter().filter_map(|recording| recording.get(i));
        let ranges = own.map(|values| {
            let (least, most) = values
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
            most - least
        });
        ranges.fold(0.0, f64::max)
    };
    let sensors = machine.sensors.iter().enumerate();
    let too_much = sensors.filter_map(|(i, sensor)| {
        let range = range(i);
        let Sensor { column, std, .. } = sensor;
        if range <= 0.0 || *std <= range {
            return None;
        }
        let key = match rig.mechanism.has_sensors() {
            true => format!("sensor.{i}.std"),
            false => "sensors".to_owned(),
        };
        let unit = sensor.unit(machine);
        let [std, range] = [*std, range].map(|value| quantity(value, unit));
        let message = format!("noise of {column} is {std}, and all that it shows spans {range}");
        let help = "is it in the unit of the column? Without std and resolution it is measured";
        Some(rig.problem(&key, message, help).to_string())
    });
    too_much.collect()
}

/// Whether a sensor declares no noise at all.
fn is_silent(sensor: &Sensor) -> bool {
    sensor.std == 0.0 && sensor.resolution == 0.0
}

/// Gives sensors that declare no noise that of a recording, so that what it leaves to any model is known; outputs of
/// controllers have none of their own.
pub fn measured(sensors: &mut [Sensor], recording: &Recording) {
    for (i, sensor) in sensors.iter_mut().enumerate() {
        let silent = is_silent(sensor);
        let own = !sensor.tells() && !matches!(sensor.reads, Reads::Output(_));
        if let (true, Some(values)) = (silent && own, recording.get(i)) {
            sensor.std = white_of(values);
        }
    }
}

/// Standard deviation of a column's white noise, from its third differences: what moves smoothly has next
/// to none at the rates that are read here, and those of white noise have `√(1 + 9 + 9 + 1)` times its
/// deviation. The median, so that hits do not count; at least what rounding to the column's own steps
/// makes, a step over √12.
fn white_of(values: &[f64]) -> f64 {
    let third = |w: &[f64]| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs();
    let mut sizes: Vec<f64> = values.windows(4).map(third).collect();
    sizes.sort_by(f64::total_cmp);
    let median = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    let steps = values.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|step| *step > 0.0);
    let step = steps.fold(f64::INFINITY, f64::min);
    let rounding = if step.is_finite() { step / 12f64.sqrt() } else { 0.0 };
    (median / (MEDIAN * 20f64.sqrt())).max(rounding)
}

/// Length in s of the blocks that noise is looked at in: machines rest, turn round or rattle for such times.
const BLOCK: f64 = 0.1;

/// Share of a block's noise up to which it may hold what the machine does: an error of all of that is no other noise.
const CLEAR: f64 = 1.0 - 1.0 / (OTHER_NOISE * OTHER_NOISE);

/// Fewest blocks.
const BLOCKS: usize = 5;

/// Share of a recording's blocks that only noise is in where a machine rattles otherwise than its model: noise is in
/// all of them, the quietest too, and hits come in bursts (Martin, *IEEE Trans. Speech Audio Process.* 9 (2001) 504–512,
/// takes noise under speech from minima alike).
const QUIETEST: f64 = 0.1;

/// Ratio of powers by which the median may stand out of that for it to be one and the same noise: half again, which counts
/// as [other noise](OTHER_NOISE) by itself. What has more is mostly bursts, and nobody knows the noise under them.
const EVEN: f64 = OTHER_NOISE * OTHER_NOISE;

/// Power of a recording's noise, its blocks the first list, in units of that of draws; none where bursts hide it. In so many
/// `lines` of spectra the lowest tenth scatters by 1.71 √(2/n) of itself and the median by 1.25 √(2/n): their ratio by
/// 2.1 √(2/n).
fn ratio(lists: &[Vec<f64>], lines: usize) -> Option<f64> {
    let (median, quietest) = (usual(lists, 0.5)?, usual(lists, QUIETEST)?);
    let even = EVEN * (1.0 + SURE * 2.1 * (2.0 / lines.max(1) as f64).sqrt());
    (median <= 1.0 || median < even * quietest).then_some(median)
}

/// The ratio that so large a share of a recording's blocks, the first list, stays below, beside the mean of those of
/// draws: the median, as what rounding makes of slow motion is not like noise in every block. None of too few blocks.
fn usual(lists: &[Vec<f64>], share: f64) -> Option<f64> {
    let quantile = |list: &Vec<f64>| {
        let mut list = list.clone();
        list.sort_by(f64::total_cmp);
        list.get((list.len() as f64 * share) as usize).copied()
    };
    let [recorded, drawn @ ..] = lists else { return None };
    let drawn: Vec<f64> = drawn.iter().filter_map(quantile).collect();
    let mean = drawn.iter().sum::<f64>() / drawn.len().max(1) as f64;
    (recorded.len() >= BLOCKS).then(|| quantile(recorded)).flatten().map(|own| own / mean)
}

/// Powers of a signal's second differences in [`NOISE_BAND`] and the number of lines of their spectrum there, block by block
/// of so many rows: what a machine does in a short block leaks into that band, and next to nothing of its differences does
/// (prewhitening; Blackman, Tukey, *The Measurement of Power Spectra*, 1958, §11).
fn powers(values: &[f64], block: usize) -> Vec<(f64, usize)> {
    let differences: Vec<f64> = values.windows(3).map(|w| w[0] - 2.0 * w[1] + w[2]).collect();
    differences.chunks_exact(block.max(1)).map(power).collect()
}

/// Power of a signal in [`NOISE_BAND`], and the number of lines of its spectrum there.
fn power(values: &[f64]) -> (f64, usize) {
    // A window that ends at zero keeps what is slow out of the band: Hann's.
    let count = fast_length(values.len());
    let window = |k: usize| (std::f64::consts::PI * k as f64 / count as f64).sin().powi(2);
    let values = values.iter().take(count).enumerate().map(|(k, v)| v * window(k)).collect();
    // Frequencies as shares of the rate of sampling: k/(2 N).
    let [low, band] = NOISE_BAND;
    let spectrum = transform(&[Signal { values, band }], 1.0).concat();
    let lines = &spectrum[((low * 2.0 * count as f64) as usize).min(spectrum.len())..];
    (lines.iter().map(|line| line * line).sum(), lines.len())
}

#[cfg(test)]
mod tests {
    /// White noise beside the declared machine that the calibrated one makes by itself is told no longer, and what a sensor adds
    /// still is.
    #[test]
    fn what_shakes_the_calibrated_machine_is_no_noise() {
        use super::*;
        use rand_chacha::ChaCha8Rng;
        use rand_chacha::rand_core::SeedableRng;
        use rand_distr::{Distribution, StandardNormal};
        let mut random = ChaCha8Rng::seed_from_u64(4);
        let mut problem = RigProblem::planar("planar-2");
        problem.runs.truncate(1);
        let sensors = problem.declared.sensors.clone();
        let torque = sensors.iter().position(|sensor| sensor.std > 0.0).unwrap();
        let recording = problem.runs[0].recording.clone();
        let mut shaken = |from: &Recording, times: f64| {
            let std = times * sensors[torque].std;
            let own = from.get(torque).unwrap().iter();
            let shaken = own.map(|value| {
                let noise: f64 = StandardNormal.sample(&mut random);
                value + std * noise
            });
            let shaken: Vec<f64> = shaken.collect();
            let column = |i| {
                if i == torque { Some(shaken.clone()) } else { from.get(i).map(<[f64]>::to_vec) }
            };
            from.with((0..sensors.len()).map(column).collect())
        };
        let still = recording
            .with((0..sensors.len()).map(|_| Some(vec![0.0; recording.samples])).collect());
        let rattling = shaken(&still, 5.0);
        problem.runs[0].recording = shaken(&rattling, 1.0);
        let found = beside(&mut problem, &[vec![still.clone()]], &|sensor| sensor.std > 0.0);
        let columns: Vec<&str> = found.iter().map(|noise| noise.column.as_str()).collect();
        assert_eq!(columns, [&sensors[torque].column], "{found:?}");
        assert!((found[0].measured / found[0].declared - 26f64.sqrt()).abs() < 0.5, "{found:?}");
        let kept = borne_out(&mut problem, found.clone(), &[vec![still]]);
        assert_eq!(kept.len(), 1);
        assert!(borne_out(&mut problem, found, &[vec![rattling]]).is_empty());
        assert_eq!(problem.declared.sensors[torque].std, sensors[torque].std);
    }

    /// What rattles now and then is no noise of the sensor; noise that is twice as large everywhere is.
    #[test]
    fn what_comes_now_and_then_is_no_noise() {
        use rand_chacha::ChaCha8Rng;
        use rand_chacha::rand_core::SeedableRng;
        use rand_distr::{Distribution, StandardNormal};
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let mut blocks = |size: f64, bursts: usize| -> Vec<f64> {
            let noise: Vec<f64> = (0..10_000)
                .map(|k| {
                    let burst = if k / 100 % 5 < bursts { 10.0 } else { 1.0 };
                    let own: f64 = StandardNormal.sample(&mut random);
                    size * burst * own
                })
                .collect();
            let all = super::powers(&noise, 100);
            all.iter().map(|(power, _)| *power).collect()
        };
        let drawn: Vec<Vec<f64>> = (0..8).map(|_| blocks(1.0, 0)).collect();
        let mut ratio = |size, bursts| {
            let lists = [vec![blocks(size, bursts)], drawn.clone()].concat();
            super::ratio(&lists, 1600)
        };
        for size in [1.0f64, 2.0] {
            // A tenth of all blocks is an eighth of the quiet ones.
            let ratio = ratio(size, 1).unwrap() / size.powi(2);
            assert!((0.85..1.45).contains(&ratio), "{size}: {ratio}");
        }
        assert_eq!(ratio(1.0, 3), None);
        assert!(super::usual(&vec![vec![1.0; 4]; 9], 0.5).is_none());
    }

    /// A crank that swings through 2 rad four times a second, its encoder's step of 1e-5 rad, in blocks of 50 rows: what leaked
    /// into the band was larger than the noise there.
    #[test]
    fn fast_motion_leaves_the_band_to_noise() {
        let turn = |k: usize| 2.0 * (std::f64::consts::TAU * 4.0 * k as f64 / 500.0).sin();
        let clean: Vec<f64> = (0..1500).map(turn).collect();
        let noisy: Vec<f64> = clean.iter().map(|q| (q / 1e-5).round() * 1e-5).collect();
        let noise: Vec<f64> = noisy.iter().zip(&clean).map(|(noisy, q)| noisy - q).collect();
        let sum = |values: &[f64]| super::powers(values, 50).iter().map(|p| p.0).sum::<f64>();
        let (own, all, expected) = (sum(&clean), sum(&noisy), sum(&noise));
        assert!(own < 0.1 * expected, "{own:e} {expected:e}");
        assert!((all / expected - 1.0).abs() < 0.3, "{all:e} {expected:e}");
    }

    /// Of white noise as much lies in the band as the band is wide.
    #[test]
    fn power_of_white_noise_is_that_of_its_share_of_the_band() {
        use rand_chacha::ChaCha8Rng;
        use rand_chacha::rand_core::SeedableRng;
        use rand_distr::{Distribution, StandardNormal};
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let count = 20_000;
        let slow = |k: usize| (k as f64 * 0.01).sin() * 100.0;
        let noise: Vec<f64> = (0..count).map(|_| StandardNormal.sample(&mut random)).collect();
        let with: Vec<f64> = noise.iter().enumerate().map(|(k, n)| n + slow(k)).collect();
        let (power, lines) = super::power(&with);
        // The mean of w² is 3/8.
        let expected = 0.375 * lines as f64;
        assert!((power / expected - 1.0).abs() < 0.1, "{}", power / expected);
    }
}
