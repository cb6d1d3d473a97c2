//! Which values each run takes: lists and ranges as a product, random keys as one joint sample.
//!
//! The sample is the additive recurrence R_d of M. Roberts, "The Unreasonable Effectiveness of
//! Quasirandom Sequences" (2018): u_n = frac(s + n α), α_j = 1/φ_d^(j+1), φ_d the positive root of
//! x^(d+1) = x + 1 (for d = 1 the golden ratio), with a random shift s from the scenario's seed. It
//! fills the cube evenly at every n, in any number of keys, and run n follows from n alone.

use super::vary::Values;
use crate::study::StudyError;
use crate::study::sweep::Vary;

/// Most runs of a sweep. Checking that many takes minutes, running them weeks: more is a slip.
pub(in crate::study::sweep) const MOST_RUNS: usize = 1_000_000;

/// All runs of a sweep, by number.
///
/// ```
/// use freeplay::study::sweep::{Design, Vary};
///
/// let varied = ["joints.clearance=1e-6..1e-4:log:3", "contact.friction=0,0.1"].map(Vary::parse);
/// let design = Design::new(varied.into_iter().collect::<Result<_, _>>()?, 1)?;
/// assert_eq!(design.runs(), 6, "each value of the one with each of the other");
/// assert_ne!(design.values(0), design.values(5));
/// # Ok::<(), freeplay::study::StudyError>(())
/// ```
#[derive(Debug)]
pub struct Design {
    varied: Vec<Vary>,
    /// What the product is made of, slowest first.
    factors: Vec<Factor>,
    sample: RSequence,
    runs: usize,
}

/// A list or a range, or all random keys together.
#[derive(Debug)]
struct Factor {
    /// Which keys, as indices.
    keys: Vec<usize>,
    levels: usize,
}

impl Design {
    /// The runs that `varied` asks for; `seed` is that of the random sample.
    ///
    /// # Errors
    /// [`StudyError::Input`]: nothing varied, a key varied twice, random keys that disagree about the
    /// number of values, or too many runs.
    pub fn new(varied: Vec<Vary>, seed: u64) -> Result<Design, StudyError> {
        if varied.is_empty() {
            return Err(StudyError::input(
                "nothing is varied; give --vary PATH=…, such as --vary joints.clearance=1e-4,5e-4",
            ));
        }
        let mut factors: Vec<Factor> = Vec::new();
        let mut random: Option<usize> = None;
        for (key, vary) in varied.iter().enumerate() {
            if varied[..key].iter().any(|before| before.path == vary.path) {
                let path = &vary.path;
                return Err(StudyError::input(format!(
                    "--vary {path} is given twice; write all values into one"
                )));
            }
            match random {
                Some(at) if vary.is_random() => {
                    let levels = factors[at].levels;
                    if levels != vary.count() {
                        return Err(StudyError::input(format!(
                            "--vary {vary}: all random keys are one joint sample and need the same \
                             number of values; another one has {levels}"
                        )));
                    }
                    factors[at].keys.push(key);
                }
                _ => {
                    if vary.is_random() {
                        random = Some(factors.len());
                    }
                    factors.push(Factor { keys: vec![key], levels: vary.count() });
                }
            }
        }
        let product = factors.iter().try_fold(1usize, |runs, f| runs.checked_mul(f.levels));
        let Some(runs) = product.filter(|runs| *runs <= MOST_RUNS) else {
            let levels: Vec<String> = factors.iter().map(|f| f.levels.to_string()).collect();
            return Err(StudyError::input(format!(
                "--vary asks for {} runs, one for each combination; expected at most {MOST_RUNS}: \
                 vary fewer values, or draw them together (:random:)",
                levels.join(" × ")
            )));
        };
        let dimensions = random.map_or(0, |at| factors[at].keys.len());
        Ok(Design { varied, factors, sample: RSequence::new(dimensions, seed), runs })
    }

    /// Number of runs.
    pub fn runs(&self) -> usize {
        self.runs
    }

    /// What is varied.
    pub fn varied(&self) -> &[Vary] {
        &self.varied
    }

    /// The value of each varied key in run `run`, as TOML. The factor named last changes fastest.
    pub fn values(&self, run: usize) -> Vec<String> {
        let mut values = vec![String::new(); self.varied.len()];
        let mut rest = run;
        for factor in self.factors.iter().rev() {
            let level = rest % factor.levels;
            rest /= factor.levels;
            for (dimension, key) in factor.keys.iter().enumerate() {
                let vary = &self.varied[*key];
                values[*key] = match &vary.values {
                    Values::Range(range) if range.random => {
                        range.at(self.sample.coordinate(level, dimension))
                    }
                    _ => vary.value(level),
                };
            }
        }
        values
    }
}

/// The shifted R-sequence in the unit cube.
#[derive(Debug)]
struct RSequence {
    /// α and shift of each dimension.
    dimensions: Vec<[f64; 2]>,
}

impl RSequence {
    fn new(dimensions: usize, seed: u64) -> Self {
        let power = 1.0 / (dimensions as f64 + 1.0);
        // The iteration contracts by at most 1/(2 φ): 60 turns leave nothing but rounding.
        let phi = (0..60).fold(1.5f64, |x, _| (1.0 + x).powf(power));
        let mut state = seed;
        let dimension = |j: i32| [phi.powi(-j), unit(split_mix(&mut state))];
        Self { dimensions: (1..=dimensions as i32).map(dimension).collect() }
    }

    fn coordinate(&self, n: usize, dimension: usize) -> f64 {
        let [alpha, shift] = self.dimensions[dimension];
        (shift + n as f64 * alpha).fract()
    }
}

/// SplitMix64 (Steele, Lea, Flood 2014): any seed, also a small one, gives well mixed bits.
fn split_mix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (*state ^ (*state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// The upper 53 bits as a number from 0 to below 1.
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn design(varied: &[&str]) -> Result<Design, StudyError> {
        let varied = varied.iter().map(|text| Vary::parse(text)).collect::<Result<_, _>>()?;
        Design::new(varied, 1)
    }

    #[test]
    fn lists_and_ranges_multiply_and_random_keys_go_together() {
        let design =
            design(&["a=1,2", "b=0..1:random:3", "c=5..6:2", "d=0..1:random:3"]).expect("right");
        assert_eq!(design.runs(), 12);
        let all: Vec<_> = (0..12).map(|run| design.values(run)).collect();
        assert_eq!([&all[0][0], &all[5][0], &all[6][0]], ["1", "1", "2"]);
        assert_eq!([&all[0][2], &all[1][2], &all[2][2]], ["5", "6", "5"]);
        for run in [1, 6, 7] {
            assert_eq!((&all[run][1], &all[run][3]), (&all[0][1], &all[0][3]));
        }
        assert_ne!(all[0][1], all[2][1]);
    }

    #[test]
    fn samples_fill_the_square_evenly() {
        for seed in [1, 2, u64::MAX] {
            let sample = RSequence::new(2, seed);
            let mut cells = [0; 16];
            for n in 0..1600 {
                let [x, y] = [0, 1].map(|d| (4.0 * sample.coordinate(n, d)) as usize);
                cells[4 * y + x] += 1;
            }
            // 100 each; independent random points would leave a spread of 10.
            assert!(cells.iter().all(|count| (95..=105).contains(count)), "{cells:?}");
        }
        assert_ne!(RSequence::new(1, 1).coordinate(0, 0), RSequence::new(1, 2).coordinate(0, 0));
    }

    #[test]
    fn mistakes_are_refused() {
        for (varied, fragment) in [
            (&["a=1", "a=2"][..], "given twice"),
            (&[], "nothing is varied"),
            (&["a=0..1:random:3", "b=0..1:random:4"], "same number of values"),
            (&["a=0..1:1001", "b=0..1:1000"], "1001 × 1000 runs"),
            (&["a=0..1:9999999999", "b=0..1:9999999999"], "at most 1000000"),
        ] {
            let said = design(varied).expect_err(fragment).to_string();
            assert!(said.contains(fragment), "{said}");
        }
    }
}
