//! From cycle to cycle in adaptive jumps.
//!
//! Rings wear so slowly that what is rubbed in a cycle holds for many: a jump of n cycles grows the rings by n times what
//! one run rubs (Euler's method, with the cycles for time). Each jump is made twice, in one and in two halves with a run
//! between them; their distance is the error of the one, and twice that of the two, which are kept.

use super::request::WearRequest;
use super::rings::Ring;
use super::stage::Stage;
use crate::contact::Play;
use crate::study::StudyError;

/// Depth of the first jump tried, as a share of the clearance: a twentieth is surely seen, and hardly changes the motion.
const FIRST: f64 = 0.05;

/// The error of a jump falls with the square of its length: share of the length that would meet the tolerance, and
/// bounds of what a jump grows or shrinks by.
const SAFETY: f64 = 0.9;
const LARGEST_GROWTH: f64 = 4.0;
const LARGEST_SHRINKAGE: f64 = 0.2;

/// Shortest jump as a share of all cycles: a prediction that takes more runs than that has no end.
const SHORTEST: f64 = 1e-3;

/// What a run with rings that leave these rooms rubs, J per cycle; `cycles` is when, for what is said of it.
pub(super) type Rub<'a> = dyn FnMut(&[Play], f64) -> Result<Vec<Vec<f64>>, StudyError> + 'a;

/// The stages from the start to the last cycle.
///
/// # Errors
/// A run that fails, jumps that become too short.
pub(super) fn predict(
    rings: &[Ring],
    start: Vec<Play>,
    request: WearRequest,
    rub: &mut Rub,
    come: &dyn Fn(f64),
) -> Result<Vec<Stage>, StudyError> {
    let WearRequest { cycles, tolerance, .. } = request;
    let errors = vec![0.0; rings.len()];
    let rubbed = rub(&start, 0.0)?;
    let mut jump = first(rings, &start, &rubbed, cycles);
    let mut now = Stage { cycles: 0.0, plays: start, rubbed, errors };
    let mut stages = vec![now.clone()];
    while now.cycles < cycles {
        let left = cycles - now.cycles;
        let last = jump >= left * (1.0 - 1e-9);
        jump = if last { left } else { jump.min(0.5 * left) };
        let whole = worn(rings, &now.plays, &now.rubbed, jump);
        let half = worn(rings, &now.plays, &now.rubbed, 0.5 * jump);
        let rubbed = rub(&half, now.cycles + 0.5 * jump)?;
        let plays = worn(rings, &half, &rubbed, 0.5 * jump);
        let apart: Vec<f64> = whole.iter().zip(&plays).map(|(a, b)| a.apart(b)).collect();
        let shares = rings.iter().zip(&apart).map(|(ring, apart)| apart / ring.clearance);
        let ratio = shares.fold(0.0, f64::max) / tolerance;
        let factor = (SAFETY / ratio.sqrt()).clamp(LARGEST_SHRINKAGE, LARGEST_GROWTH);
        if ratio > 1.0 {
            jump *= factor;
            if jump < SHORTEST * cycles {
                return Err(StudyError::TooShort { cycles: now.cycles, jump });
            }
            continue;
        }
        let jumped = jump;
        let cycles = if last { cycles } else { now.cycles + jump };
        let errors = now.errors.iter().zip(apart).map(|(sum, apart)| sum + apart).collect();
        jump *= factor;
        // The last stage is the end: nothing starts from it, and the run before says what is rubbed there.
        let rubbed = if last { rubbed } else { rub(&plays, cycles)? };
        now = Stage { cycles, plays, rubbed, errors };
        come(jumped);
        stages.push(now.clone());
    }
    Ok(stages)
}

/// Each ring after so many cycles.
fn worn(rings: &[Ring], plays: &[Play], rubbed: &[Vec<f64>], cycles: f64) -> Vec<Play> {
    let all = rings.iter().zip(plays).zip(rubbed);
    all.map(|((ring, play), rubbed)| ring.worn(play, rubbed, cycles)).collect()
}

/// Cycles of the first jump: as many as wear the ring that wears most by [`FIRST`].
fn first(rings: &[Ring], start: &[Play], rubbed: &[Vec<f64>], cycles: f64) -> f64 {
    let mut jump = cycles;
    // Grooves widen as they deepen: a few rounds find the length from above.
    for _ in 0..20 {
        let worn = worn(rings, start, rubbed, jump);
        let pairs = rings.iter().zip(start.iter().zip(&worn));
        let deepest = pairs.map(|(ring, (new, worn))| new.apart(worn) / ring.clearance);
        let deepest = deepest.fold(0.0, f64::max);
        if deepest <= FIRST {
            break;
        }
        jump *= FIRST / deepest;
    }
    jump
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::WEAR_DIRECTIONS;

    const CYCLES: f64 = 1e6;

    fn ring() -> Ring {
        let (clearance, radius, length) = (1e-4, 0.01, 0.02);
        Ring { joint: 0, name: "A".to_owned(), clearance, radius, length, coefficient: 1e-14 }
    }

    fn request(tolerance: f64) -> WearRequest {
        WearRequest { cycles: CYCLES, period: 1.0, tolerance }
    }

    /// What is rubbed grows in proportion to the mean room, in all directions: the room grows exponentially.
    fn growing(tolerance: f64) -> (f64, Stage, usize) {
        let ring = ring();
        let per_direction = 0.035;
        let rate = 1e-14 / ring.length * per_direction * WEAR_DIRECTIONS as f64
            / (std::f64::consts::TAU * ring.radius * ring.clearance);
        let rub = &mut |plays: &[Play], _: f64| {
            let grown = plays[0].mean() / 1e-4;
            Ok(vec![vec![per_direction * grown; WEAR_DIRECTIONS]])
        };
        let start = vec![Play::of(ring.clearance, None, WEAR_DIRECTIONS)];
        let stages = predict(&[ring], start, request(tolerance), rub, &|_| {}).unwrap();
        let exact = 1e-4 * (rate * CYCLES).exp();
        (exact, stages.last().unwrap().clone(), stages.len())
    }

    #[test]
    fn the_error_is_what_halving_says() {
        let mut before = f64::INFINITY;
        for tolerance in [1e-2, 1e-3, 1e-4] {
            let (exact, end, stages) = growing(tolerance);
            let error = (end.plays[0].mean() - exact).abs();
            println!("{tolerance:e}: {error:e} m, said {:e}, {stages} stages", end.errors[0]);
            assert!(error <= 1.1 * end.errors[0], "{error:e} {:e}", end.errors[0]);
            assert!(error < 0.6 * before);
            before = error;
        }
        // A thousandth of the clearance that it grows to, 2.7e-4 m.
        assert!(before < 2.7e-7, "{before:e}");
    }

    #[test]
    fn what_never_settles_is_told() {
        let mut turn = 0u32;
        let rub = &mut |_: &[Play], _: f64| {
            turn += 1;
            let mut rubbed = vec![0.0; WEAR_DIRECTIONS];
            rubbed[(97 * turn as usize) % WEAR_DIRECTIONS] = 1e6;
            Ok(vec![rubbed])
        };
        let start = vec![Play::of(1e-4, None, WEAR_DIRECTIONS)];
        let ended = predict(&[ring()], start, request(1e-4), rub, &|_| {});
        assert!(matches!(ended, Err(StudyError::TooShort { .. })), "{ended:?}");
    }
}
