//! Motions of all drives of a machine, made of numbers so that whatever the numbers are, no limit is left.

use super::course::Course;
use super::limits::DriveLimits;
use super::present::Present;
use super::series::FourierSeries;
use crate::calibrate::sensed::recording::Recording;
use crate::mechanism::{JointIndex, Mechanism, Reads};

/// Waves of each drive: with a period of three seconds up to 2.7 Hz, as far as strokes and accelerations of machines of
/// some decimetres reach, and few enough numbers for a search by some hundred looks.
pub const WAVES: usize = 8;

/// Numbers of one drive: middle, size, drift, and its waves.
const NUMBERS: usize = 3 + 2 * WAVES;

/// Share of a limit that is used: rounding of what is written, and of what interpolates it, stays within.
const USED: f64 = 0.999;

/// How far from home in rad a drive that turns may begin: from its file's `start`, a machine closes on its own branch within
/// a part of a turn. Drives that slide may begin anywhere on their stroke.
const NEAR: f64 = 0.5;

/// A drift of this many times the stroke takes all of it in one direction; half the numbers that are drawn stay below a
/// half of it.
const DRIFT: f64 = 0.5;

/// A motion of all drives.
#[derive(Clone, Debug, PartialEq)]
pub struct DrivesMotion {
    /// Drive by drive.
    pub drives: Vec<Course>,
}

/// What motions are made for.
#[derive(Clone, Debug)]
pub struct Maker {
    /// Time in s of a motion.
    pub period: f64,
    /// Limits of each drive.
    pub limits: Vec<DriveLimits>,
    /// Coordinates (m, rad) around which motions are made smaller where they meet something else than these limits.
    pub home: Vec<f64>,
    /// The present motion, if it is a candidate.
    pub present: Option<Vec<Present>>,
}

impl Maker {
    /// How many numbers make a motion.
    pub fn numbers(&self) -> usize {
        self.limits.len() * NUMBERS
    }

    /// The present motion, as large as the limits allow; none where it is no candidate.
    pub fn present(&self) -> Option<DrivesMotion> {
        let present = self.present.as_ref()?.iter().cloned();
        Some(DrivesMotion { drives: present.map(Course::Present).collect() })
    }

    /// The motion that numbers (of the order of one) stand for, `share` (0 to 1) of its size about home: within strokes,
    /// speeds and accelerations whatever they are.
    pub fn motion(&self, numbers: &[f64], share: f64) -> DrivesMotion {
        let drives = numbers.chunks(NUMBERS).zip(&self.limits).zip(&self.home);
        let all = drives.map(|((numbers, limit), home)| self.series(numbers, limit, *home, share));
        DrivesMotion { drives: all.map(Course::New).collect() }
    }

    /// A motion of `share` of another one's size, about home.
    pub fn gentler(&self, motion: &DrivesMotion, share: f64) -> DrivesMotion {
        let drives = motion.drives.iter().zip(&self.limits).zip(&self.home);
        let one = |((course, limit), home): ((&Course, &DriveLimits), &f64)| {
            let small = course.scaled(share, 0.0);
            let reach = small.extremes().reach;
            let [low, high] = limit.stroke;
            let room = [low - reach[0], high - reach[1]];
            let start = home + share * (course.start() - home);
            small.scaled(1.0, start.max(room[0]).min(room[1]))
        };
        DrivesMotion { drives: drives.map(one).collect() }
    }

    fn series(&self, numbers: &[f64], limit: &DriveLimits, home: f64, share: f64) -> FourierSeries {
        let (middle, size) = (logistic(numbers[0]), logistic(numbers[1] + 1.0));
        let waves: Vec<[f64; 2]> = numbers[3..].chunks(2).map(|pair| [pair[0], pair[1]]).collect();
        // Rates are of the order of one; a drift of as many.
        let drift = DRIFT * self.period * numbers[2];
        let shape = FourierSeries::new(self.period, drift, waves);
        let extremes = shape.extremes();
        let [low, high] = limit.stroke;
        let width = extremes.reach[1] - extremes.reach[0];
        let largest = USED
            * ((high - low) / width)
                .min(limit.speed / extremes.speed)
                .min(limit.acceleration / extremes.acceleration);
        // Numbers that are all zero make no motion.
        let largest = if largest.is_finite() { largest } else { 0.0 };
        // Where a motion of that size may begin.
        let room = |factor: f64| {
            let margin = 0.5 * (1.0 - USED) * (high - low);
            let room = [
                low + margin - factor * extremes.reach[0],
                high - margin - factor * extremes.reach[1],
            ];
            if room[0] <= room[1] { room } else { [0.5 * (room[0] + room[1]); 2] }
        };
        let factor = size * largest;
        let mut reach = room(factor);
        if limit.unit == "rad" {
            let [first, last] = reach;
            reach = [home - NEAR, home + NEAR].map(|end| end.clamp(first, last));
        }
        let start = reach[0] + middle * (reach[1] - reach[0]);
        let [first, last] = room(share * factor);
        let start = (home + share * (start - home)).clamp(first, last);
        shape.scaled(share * factor, start)
    }
}

fn logistic(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

impl DrivesMotion {
    /// Whether it is the present one as it is.
    pub fn is_present(&self) -> bool {
        let whole = |course: &Course| matches!(course, Course::Present(of) if of.share == 1.0);
        self.drives.iter().all(whole)
    }

    /// What a machine is recorded like along this motion: its commands, to nine decimals as logs have them, and for what
    /// sensors will show where the machine stands at the start.
    pub fn like(
        &self,
        mechanism: &Mechanism,
        name: &str,
        interval: f64,
        samples: usize,
    ) -> Recording {
        let first = |joint: JointIndex| {
            let drive = mechanism.actuators.iter().position(|drive| drive.joint == joint);
            drive.map_or_else(
                || mechanism.start_coordinate(joint),
                |drive| self.drives[drive].start(),
            )
        };
        let columns = mechanism.sensors.iter().map(|sensor| {
            let value = |row: usize| match sensor.reads {
                Reads::Command(drive) => rounded(self.drives[drive].at(row as f64 * interval)[0]),
                Reads::Position(joint) => first(joint),
                _ => 0.0,
            };
            Some((0..samples).map(value).collect())
        });
        Recording::of(name, interval, samples, columns.collect())
    }
}

/// To nine decimals.
pub fn rounded(value: f64) -> f64 {
    (value * 1e9).round() * 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    fn maker() -> Maker {
        let limit = |stroke: [f64; 2], speed, acceleration| DriveLimits {
            joint: "O".into(),
            unit: "rad",
            stroke,
            speed,
            acceleration,
            force: None,
            stroke_from: "given",
            from: "given",
        };
        Maker {
            period: 3.0,
            limits: vec![
                limit([-0.4, 0.9], 3.0, 40.0),
                limit([0.0, 30.0], 15.0, 100.0),
                limit([0.25, 0.35], 1.0, 0.3),
            ],
            home: vec![0.1, 0.0, 0.3],
            present: None,
        }
    }

    /// A present motion that asks for twice the speed that it may have is made half as large, and begins where it fits.
    #[test]
    fn the_present_motion_is_taken_as_large_as_the_limits_allow() {
        let told: Vec<f64> = (0..=3000).map(|row| 0.9 * (1e-3 * f64::from(row)).sin()).collect();
        let present = |share: f64| Present {
            rows: std::sync::Arc::new(ToldRows::new(&told, 1e-3)),
            start: 0.05,
            share,
        };
        let maker = Maker { present: Some(vec![present(1.0)]), ..maker() };
        let motion = maker.present().unwrap();
        assert!(motion.is_present());
        let [position, rate, _] = motion.drives[0].at(0.5);
        assert!(
            (position - 0.05 - told[500]).abs() < 1e-12 && (rate - 0.9 * 0.5f64.cos()).abs() < 1e-6
        );
        let half = maker.gentler(&motion, 0.5);
        assert!(!half.is_present() && (half.drives[0].at(0.5)[1] - 0.5 * rate).abs() < 1e-12);
    }

    /// 10 000 motions of random numbers, small and absurd ones: none leaves a limit at any of 4000 instants, nor between
    /// rows that are written to nine decimals, by second differences of these.
    #[test]
    fn no_numbers_make_a_motion_outside_the_limits() {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let maker = maker();
        for trial in 0..10_000 {
            let size = [0.1, 1.0, 10.0, 1e3][trial % 4];
            let draw = |random: &mut ChaCha8Rng| -> f64 { StandardNormal.sample(random) };
            let numbers: Vec<f64> =
                (0..maker.numbers()).map(|_| size * draw(&mut random)).collect();
            let share = [1.0, 0.6, 0.1][trial % 3];
            let motion = maker.motion(&numbers, share);
            for (series, limit) in motion.drives.iter().zip(&maker.limits) {
                // A few instants of each motion, others in each trial.
                for k in 0..40 {
                    let t = 3.0 * (f64::from(k) + (trial as f64 * 0.618).fract()) / 40.0;
                    let [position, rate, acceleration] = series.at(t);
                    assert!(limit.stroke[0] <= position && position <= limit.stroke[1], "{trial}");
                    assert!(rate.abs() <= limit.speed, "{trial}: {rate}");
                    assert!(acceleration.abs() <= limit.acceleration, "{trial}: {acceleration}");
                }
                let extremes = series.extremes();
                assert!(
                    extremes.speed <= limit.speed && extremes.acceleration <= limit.acceleration
                );
                assert!(
                    limit.stroke[0] <= extremes.reach[0] && extremes.reach[1] <= limit.stroke[1]
                );
            }
        }
    }

    /// Limits are used: the largest motions come near one of them in each drive.
    #[test]
    fn motions_use_what_they_may() {
        let maker = maker();
        let mut numbers = vec![0.5; maker.numbers()];
        for drive in numbers.chunks_mut(NUMBERS) {
            drive[1] = 30.0;
        }
        for (series, limit) in maker.motion(&numbers, 1.0).drives.iter().zip(&maker.limits) {
            let Extremes { reach: [low, high], speed, acceleration } = series.extremes();
            let used = ((high - low) / (limit.stroke[1] - limit.stroke[0]))
                .max(speed / limit.speed)
                .max(acceleration / limit.acceleration);
            assert!((0.99..=1.0).contains(&used), "{used}");
        }
    }

    use super::super::present::ToldRows;
    use super::super::series::Extremes;
}
