//! The verdict of a calibration in plain words.

use super::outcome::{LegsOutcome, MET, Verdict};
use crate::calibrate::rounds::left::is_noise;
use crate::calibrate::rounds::way::name;
use crate::calibrate::values::errors::{ChannelError, worst};

/// What is to be said of an explained recording that simulations miss by so much.
fn unforeseen(worst: &ChannelError) -> String {
    let floors = worst.after / worst.floor;
    if floors < MET {
        return String::new();
    }
    format!(
        " Yet a simulation with these values misses {} of {} by {floors:.1} floors: joints rattle so \
         seldom that replicas stay together for a second or more, and what values are still wrong by grows \
         over the run.",
        worst.channel, worst.run
    )
}

/// The verdict in plain words.
pub fn summary(outcome: &LegsOutcome) -> String {
    let named: Vec<String> = outcome
        .effects
        .iter()
        .filter(|(effect, _)| effect.efforts().is_none())
        .map(|(effect, _)| name(effect))
        .collect();
    let list = named.join(" and ");
    match outcome.verdict {
        Verdict::NothingMissing => {
            "The declared model explains the recordings to within noise: nothing is missing."
                .to_owned()
        }
        Verdict::Explained => format!(
            "The declared model lacks {list}. With {} the recordings are explained to within noise.{}",
            if named.len() == 1 { "it" } else { "them" },
            worst(&outcome.errors).map_or_else(String::new, unforeseen)
        ),
        Verdict::Unexplained if is_noise(&outcome.after) => {
            let misses = worst(&outcome.errors).map_or(f64::NAN, |e| e.after / e.floor);
            let tried = if named.is_empty() { "the declared model" } else { &list };
            format!(
                "The declared model lacks something. Looked at without simulation, {tried} leaves nothing \
                 but noise of the recordings; simulated with its own swing it misses them by up to \
                 {misses:.1} floors. It is something else, or more."
            )
        }
        Verdict::Unexplained => {
            let certain = if named.is_empty() {
                String::new()
            } else {
                format!(" Certain is {list}; more is missing.")
            };
            let described = match &outcome.described {
                Some(described) => format!(
                    " What remains depends on {}: a fitted table of forces stands in for it. It \
                     predicts, it explains nothing.",
                    described.words()
                ),
                None => " Nor does what remains depend on position or velocity in a way \
                         that a table could hold."
                    .to_owned(),
            };
            format!(
                "The declared model lacks something that no effect with a name here explains.\
                 {certain}{described}"
            )
        }
    }
}
