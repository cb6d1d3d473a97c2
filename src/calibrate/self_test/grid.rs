//! Which trials there are.

use super::LegsTrial;
use super::hidden::{kinds, uniform};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// Sizes of hidden effects, in units of about three floors.
const SIZES: [f64; 3] = [1.0, 3.0, 8.0];

/// Size at which effects are withheld and hidden in pairs.
const MIDDLE: f64 = 3.0;

/// Rigs that lack nothing, with gravity and without: as many as it takes to see false alarms of one in
/// ten.
const LACKING_NOTHING: u64 = 5;

/// Rigs that lack two effects, with gravity and without.
const PAIRS: u64 = 7;

/// Every effect at every size with gravity and without, the same withheld from the candidates at the
/// middle size, rigs that lack nothing, and rigs that lack two effects, drawn at random. `only` keeps
/// those that hide one of these kinds (`nothing` for none, `a+b` for both; everything if empty); another
/// `seed` gives other sizes, joints, motions, noise and pairs.
pub fn trials(only: &[String], seed: u64) -> Vec<LegsTrial> {
    let mut trials = Vec::new();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let kinds: Vec<&str> = kinds().collect();
    for gravity in [true, false] {
        let trial = |hidden: &[&str], size: f64, withheld: bool, number: u64| LegsTrial {
            hidden: hidden.iter().map(|&kind| kind.to_owned()).collect(),
            size,
            gravity,
            withheld,
            seed: seed * 1000 + number,
        };
        trials.extend((0..LACKING_NOTHING).map(|i| trial(&[], 0.0, false, 900 + i)));
        for (kind, number) in kinds.iter().zip((0..).step_by(10)) {
            let sizes = SIZES.iter().zip(number..);
            trials.extend(sizes.map(|(&size, number)| trial(&[kind], size, false, number)));
            trials.push(trial(&[kind], MIDDLE, true, number + 5));
        }
        for i in 0..PAIRS {
            let mut draw = |count: usize| (uniform(&mut random) * count as f64) as usize;
            let first = draw(kinds.len());
            let second = (first + 1 + draw(kinds.len() - 1)) % kinds.len();
            trials.push(trial(&[kinds[first], kinds[second]], MIDDLE, false, 700 + i));
        }
    }
    let name = |trial: &LegsTrial| match trial.hidden.as_slice() {
        [] => "nothing".to_owned(),
        hidden => hidden.join("+"),
    };
    trials.retain(|trial| only.is_empty() || only.contains(&name(trial)));
    trials
}
