//! What the paper claims, as comparisons with a limit, and what the simulations say of it.

use super::estimate::Estimate;
use super::items::Item;
use super::result::CaseResult;
use super::variants::{LARGE, SMALL};
use crate::report::{length, number};
use crate::study::compare::in_words;
use serde::Serialize;

/// One claim of the paper.
#[derive(Debug)]
pub struct Claim {
    /// Name in `paper.json`.
    pub key: &'static str,
    /// The claim in a few words.
    pub label: &'static str,
    /// The paper's words, or the figures that show it.
    pub quote: &'static str,
    /// Where in the paper.
    pub place: &'static str,
    /// What is asked of the simulations.
    pub test: Test,
    /// When it counts as true.
    pub limit: Limit,
}

/// A value that a claim is judged by.
#[derive(Clone, Copy, Debug)]
pub enum Test {
    /// A mean at a clearance in m.
    Mean(Item, f64),
    /// The ratio of two means, each at its clearance in m.
    Ratio([(Item, f64); 2]),
    /// The smallest ratio from one clearance of the study to the next larger one.
    EveryStep(Item),
    /// The power p of the clearance in value ∝ cᵖ between two clearances in m.
    Power(Item, [f64; 2]),
}

/// When a value makes a claim true. A claim is supported if the whole 95 % interval lies on that side,
/// contradicted if it lies on the other, undecided otherwise.
#[derive(Clone, Copy, Debug)]
pub enum Limit {
    /// It lies above.
    Above(f64),
    /// It lies below.
    Below(f64),
}

/// What the simulations say of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The interval agrees with it.
    Supported,
    /// The interval excludes it.
    Contradicted,
    /// The interval allows both, or there is none.
    Undecided,
}

/// A claim in the light of one variant.
#[derive(Clone, Debug, Serialize)]
pub struct Judged {
    /// Key of the claim.
    pub key: &'static str,
    /// What the simulations say.
    pub verdict: Verdict,
    /// The value that the claim is judged by; `null` for a ratio to nothing.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// The numbers behind it, in words.
    pub evidence: String,
}

/// A signal that jumps: a tenth of what uncorrelated samples have, 25 times a sine of 1 Hz.
const SHARP: f64 = 0.1;

/// Deviations below a tenth count as nearly ideal.
const NEARLY: f64 = 0.1;

/// "Clearly affected": at least twice the ideal value.
const CLEARLY: f64 = 2.0;

/// "Sensitive": a doubled clearance changes the value by more than a tenth, 2^0.1375 = 1.1.
const SENSITIVE: f64 = 0.1375;

use Item::{
    AccelerationJump, AngularJump, ForceJump, ForceShare, IdealForceJump, IdealPeakAcceleration,
    IdealPeakActuatorForce, Lyapunov, PathError, PeakAcceleration, PeakActuatorForce,
    PeakContactForce, SmoothForceShare,
};
use Limit::{Above, Below};
use Test::{EveryStep, Mean, Power, Ratio};

/// The claims, in the order of the paper.
pub const CLAIMS: [Claim; 14] = [
    Claim {
        key: "acceleration-sharp",
        label: "accelerations change sharply",
        quote: "the magnitudes of the accelerations change sharply in the presence of joints \
                clearances",
        place: "section 4, figures 4 and 5",
        test: Mean(AccelerationJump, LARGE),
        limit: Above(SHARP),
    },
    Claim {
        key: "angular-acceleration-sharp",
        label: "angular acceleration changes sharply",
        quote: "the angular accelerations of the EE for different clearance sizes are shown",
        place: "section 4, figure 6",
        test: Mean(AngularJump, LARGE),
        limit: Above(SHARP),
    },
    Claim {
        key: "acceleration-affected",
        label: "clearance clearly affects accelerations",
        quote: "the existence of joint clearance clearly affects the accelerations",
        place: "section 5",
        test: Ratio([(PeakAcceleration, LARGE), (IdealPeakAcceleration, LARGE)]),
        limit: Above(CLEARLY),
    },
    Claim {
        key: "acceleration-grows",
        label: "larger clearance, larger accelerations",
        quote: "the manipulator experiences higher accelerations for the higher clearance sizes",
        place: "section 4",
        test: EveryStep(PeakAcceleration),
        limit: Above(1.0),
    },
    Claim {
        key: "joint-force-grows",
        label: "larger clearance, larger forces in the joints",
        quote: "higher clearance sizes led to higher impulsive accelerations and higher forces in the \
                joints",
        place: "section 5",
        test: EveryStep(PeakContactForce),
        limit: Above(1.0),
    },
    Claim {
        key: "actuator-force-sharp",
        label: "actuator forces change sharply",
        quote: "the required forces experience sharp changes in the case of manipulator with clearance \
                at the joints",
        place: "section 4, figures 7 to 9",
        test: Mean(ForceJump, LARGE),
        limit: Above(SHARP),
    },
    Claim {
        key: "ideal-force-smooth",
        label: "ideal actuator forces are smooth",
        quote: "while in the ideal case they are very smooth",
        place: "section 4, figures 7 to 9",
        test: Mean(IdealForceJump, LARGE),
        limit: Below(SHARP),
    },
    Claim {
        key: "actuator-force-affected",
        label: "clearance clearly affects actuator forces",
        quote: "the existence of joint clearance clearly affects the accelerations and input required \
                forces",
        place: "section 5",
        test: Ratio([(PeakActuatorForce, LARGE), (IdealPeakActuatorForce, LARGE)]),
        limit: Above(CLEARLY),
    },
    Claim {
        key: "actuator-force-grows",
        label: "larger clearance, larger actuators",
        quote: "the bigger clearance size makes bigger linear actuators in the manipulator",
        place: "section 4",
        test: EveryStep(PeakActuatorForce),
        limit: Above(1.0),
    },
    Claim {
        key: "nearly-ideal",
        label: "nearly ideal at 0.00001 mm",
        quote: "(shown, not said: the curves at C = 0.00001 mm beside those without clearance)",
        place: "figures 7b, 8b, 9b",
        test: Mean(ForceShare, SMALL),
        limit: Below(NEARLY),
    },
    Claim {
        key: "nearly-ideal-smooth",
        label: "nearly ideal at 0.00001 mm, 10 ms means",
        quote: "(the same, with what is faster than 10 ms averaged out)",
        place: "figures 7b, 8b, 9b",
        test: Mean(SmoothForceShare, SMALL),
        limit: Below(NEARLY),
    },
    Claim {
        key: "sensitive",
        label: "dynamics are sensitive to the clearance",
        quote: "the robot dynamics is very sensitive to the magnitude of clearance size",
        place: "section 5",
        // Over the sizes that machines are built with.
        test: Power(PeakAcceleration, [1e-4, LARGE]),
        limit: Above(SENSITIVE),
    },
    Claim {
        key: "chaotic",
        label: "motion is chaotic",
        quote: "it leads to a chaotic behaviour including the impact loads which results in an \
                unpredictable response",
        place: "abstract",
        test: Mean(Lyapunov, LARGE),
        limit: Above(0.0),
    },
    Claim {
        key: "error",
        label: "clearance causes position error",
        quote: "clearance introduces an additional uncontrollable degree of freedom to the \
                manipulator, it causes error",
        place: "abstract",
        test: Ratio([(PathError, LARGE), (PathError, SMALL)]),
        limit: Above(1.0),
    },
];

impl Limit {
    /// The limit in words.
    pub fn in_words(self) -> String {
        match self {
            Above(limit) => format!("above {}", number(limit)),
            Below(limit) => format!("below {}", number(limit)),
        }
    }

    fn verdict(self, [low, high]: [f64; 2]) -> Verdict {
        let (holds, fails) = match self {
            Above(limit) => (low > limit, high < limit),
            Below(limit) => (high < limit, low > limit),
        };
        match (holds, fails) {
            (true, _) => Verdict::Supported,
            (_, true) => Verdict::Contradicted,
            _ => Verdict::Undecided,
        }
    }
}

impl Verdict {
    /// In one word.
    pub fn in_words(self) -> &'static str {
        match self {
            Verdict::Supported => "supported",
            Verdict::Contradicted => "contradicted",
            Verdict::Undecided => "undecided",
        }
    }
}

impl Test {
    /// What its value is.
    pub fn in_words(self) -> String {
        match self {
            Mean(item, c) => format!("{} at {}", item.quantity().label, length(c)),
            Ratio([(a, c), (b, d)]) => format!(
                "{} at {} over {} at {}",
                a.quantity().label,
                length(c),
                b.quantity().label,
                length(d)
            ),
            EveryStep(item) => format!(
                "{}: smallest ratio from one clearance to the next larger one",
                item.quantity().label
            ),
            Power(item, [from, to]) => format!(
                "{}: power of the clearance from {} to {}",
                item.quantity().label,
                length(from),
                length(to)
            ),
        }
    }
}

/// Judges a claim by the cases of one variant, which has one for each clearance of the study.
pub fn judge(claim: &Claim, cases: &[CaseResult]) -> Judged {
    let (estimate, evidence) = match claim.test {
        Mean(item, c) => (mean_of(cases, item, c).estimate(), said(cases, item, c)),
        Ratio([(a, c), (b, d)]) => (
            mean_of(cases, a, c).over(mean_of(cases, b, d)),
            format!("{} against {}", said(cases, a, c), said(cases, b, d)),
        ),
        EveryStep(item) => every_step(cases, item),
        Power(item, between) => power(cases, item, between),
    };
    let verdict = match claim.test {
        // One pair that surely falls contradicts; all must surely rise to support.
        EveryStep(item) => steps(cases, item)
            .map(|(_, ratio)| claim.limit.verdict(ratio.ci95))
            .reduce(worse)
            .unwrap_or(Verdict::Undecided),
        _ => claim.limit.verdict(estimate.ci95),
    };
    Judged { key: claim.key, verdict, estimate, evidence }
}

fn worse(a: Verdict, b: Verdict) -> Verdict {
    use Verdict::{Contradicted, Supported, Undecided};
    match (a, b) {
        (Contradicted, _) | (_, Contradicted) => Contradicted,
        (Undecided, _) | (_, Undecided) => Undecided,
        (Supported, Supported) => Supported,
    }
}

/// The mean of an item at a clearance of the study.
fn mean_of(cases: &[CaseResult], item: Item, clearance: f64) -> &super::estimate::RunMean {
    // Claims name clearances of the study only.
    let case = cases.iter().find(|case| case.clearance_m == clearance).unwrap_or(&cases[0]);
    case.mean(item)
}

/// "platform acceleration, peak at 500 µm: 178 m/s² ± 9 m/s²".
fn said(cases: &[CaseResult], item: Item, clearance: f64) -> String {
    let quantity = item.quantity();
    let mean = mean_of(cases, item, clearance);
    let at = match item {
        Item::IdealForceJump | Item::IdealPeakAcceleration | Item::IdealPeakActuatorForce => {
            String::new()
        }
        _ => format!(" at {}", length(clearance)),
    };
    format!("{}{at}: {}", quantity.label, mean.in_words(quantity))
}

/// Each pair of neighbouring clearances: the smaller one in m, and the ratio of the larger one's value
/// to its own.
fn steps(cases: &[CaseResult], item: Item) -> impl Iterator<Item = (f64, Estimate)> {
    cases
        .windows(2)
        .map(move |pair| (pair[0].clearance_m, pair[1].mean(item).over(pair[0].mean(item))))
}

fn every_step(cases: &[CaseResult], item: Item) -> (Estimate, String) {
    let least = steps(cases, item).min_by(|a, b| a.1.value.total_cmp(&b.1.value));
    let nothing = Estimate { value: f64::NAN, ci95: [f64::NAN; 2] };
    let (from, least) = least.unwrap_or((f64::NAN, nothing));
    let quantity = item.quantity();
    let means: Vec<String> = cases
        .iter()
        .map(|case| {
            format!("{} at {}", in_words(quantity, case.mean(item).mean), length(case.clearance_m))
        })
        .collect();
    let whole = mean_of(cases, item, LARGE).over(mean_of(cases, item, SMALL));
    let evidence = format!(
        "{}: {}; {} times from {} to {}; least from {} to the next",
        quantity.label,
        means.join(", "),
        number(whole.value),
        length(SMALL),
        length(LARGE),
        length(from)
    );
    (least, evidence)
}

/// ln(value ratio)/ln(clearance ratio), with the interval of the ratio.
fn power(cases: &[CaseResult], item: Item, [from, to]: [f64; 2]) -> (Estimate, String) {
    let ratio = mean_of(cases, item, to).over(mean_of(cases, item, from));
    let power = |ratio: f64| ratio.ln() / (to / from).ln();
    let estimate = Estimate { value: power(ratio.value), ci95: ratio.ci95.map(power) };
    let evidence = format!(
        "{}, {}; a clearance twice as large changes it by {} %",
        said(cases, item, from),
        said(cases, item, to),
        number(100.0 * (estimate.value.exp2() - 1.0))
    );
    (estimate, evidence)
}

#[cfg(test)]
mod tests {
    use super::super::items::COUNT;
    use super::super::variants::CLEARANCES;
    use super::*;

    /// Cases whose values are all `value(clearance)`, from eight starts that differ by ±`spread`.
    fn cases(value: impl Fn(f64) -> f64, spread: f64) -> Vec<CaseResult> {
        let case = |c: f64| {
            let runs: Vec<Option<_>> = (0..8)
                .map(|k| if k % 2 == 0 { 1.0 + spread } else { 1.0 - spread })
                .map(|factor| Some([factor * value(c); COUNT]))
                .collect();
            CaseResult::new(c, &runs)
        };
        CLEARANCES.map(case).into()
    }

    fn judged(test: Test, limit: Limit, cases: &[CaseResult]) -> Judged {
        let claim = Claim { key: "", label: "", quote: "", place: "", test, limit };
        judge(&claim, cases)
    }

    #[test]
    fn an_interval_decides() {
        let cases = cases(|_| 10.0, 0.2);
        let verdict = |limit| judged(Mean(PathError, LARGE), limit, &cases).verdict;
        assert_eq!(verdict(Above(5.0)), Verdict::Supported);
        assert_eq!(verdict(Above(10.5)), Verdict::Undecided);
        assert_eq!(verdict(Above(20.0)), Verdict::Contradicted);
        assert_eq!(verdict(Below(20.0)), Verdict::Supported);
        assert_eq!(verdict(Below(5.0)), Verdict::Contradicted);
    }

    #[test]
    fn growth_must_hold_at_every_step() {
        let grows = cases(f64::sqrt, 0.1);
        let j = judged(EveryStep(PathError), Above(1.0), &grows);
        assert_eq!(j.verdict, Verdict::Supported);
        assert!((j.estimate.value - 5f64.sqrt()).abs() < 1e-9, "1e-4 to 5e-4: {j:?}");
        let dips = cases(|c| if c == 1e-5 { 1e-9 } else { c }, 0.1);
        assert_eq!(judged(EveryStep(PathError), Above(1.0), &dips).verdict, Verdict::Contradicted);
        let level = cases(|_| 1.0, 0.1);
        assert_eq!(judged(EveryStep(PathError), Above(1.0), &level).verdict, Verdict::Undecided);
    }

    #[test]
    fn powers_are_found() {
        let cases = cases(|c| 3.0 * c.powf(0.4), 0.01);
        let j = judged(Power(PathError, [1e-6, LARGE]), Above(SENSITIVE), &cases);
        assert!((j.estimate.value - 0.4).abs() < 1e-9 && j.verdict == Verdict::Supported);
    }

    #[test]
    fn without_data_nothing_is_decided() {
        let nothing: Vec<_> =
            CLEARANCES.iter().map(|&c| CaseResult::new(c, &[None, None])).collect();
        for claim in &CLAIMS {
            assert_eq!(judge(claim, &nothing).verdict, Verdict::Undecided, "{}", claim.key);
        }
    }
}
