//! What a declared pendulum lacks: friction of several kinds, chosen by windows that a model was not
//! fitted to.

use super::calibration::{Adjusted, Found, Ranked};
use crate::calibrate::report::{ActsOn, EffectReport, Fitted};
use crate::calibrate::result::CalibrateError;
use crate::effects::Setting;
use crate::identify::Recorded;
use crate::identify::arm::{self, Declared, PLAN, STEPS, Sought, Swinger};
use crate::identify::paired::Ratio;
use crate::identify::swings::{self, Window};
use crate::measure::log::Channel;
use crate::scenario::{Law, Scenario};

/// Fewest windows of 2.5 s that a search takes: every other one judges the rest.
const FEWEST: usize = 4;

/// Kinds of effects by the place of their number in a [`Swinger`].
const KINDS: [(usize, &str); 3] = [(2, "pivot-friction"), (3, "bristle-friction"), (4, "air-drag")];

fn windows(run: &Recorded) -> Vec<Window> {
    let angles = run.log.get(Channel::Pose(2)).unwrap_or_default();
    swings::windows(angles, run.log.interval, PLAN)
}

/// What speaks against a rig and its recordings beforehand.
pub(super) fn ready(rig: &Scenario, runs: &[Recorded]) -> Vec<String> {
    let mut wrong = Vec::new();
    if rig.contact.law != Law::Ideal {
        let help = "write law = \"ideal\": the friction of a pivot is sought without its clearance";
        wrong.push(rig.problem("contact.law", "is not \"ideal\"", help).to_string());
    }
    for (i, effect) in rig.effects.iter().enumerate() {
        if !KINDS.iter().any(|(_, kind)| *kind == effect.kind.name) {
            let help = "take it out, or use `freeplay predict`";
            let message =
                format!("\"{}\" is not what calibrate knows of a pendulum", effect.kind.name);
            wrong.push(rig.problem(&format!("effect.{i}.kind"), message, help).to_string());
        }
    }
    if let Some(run) = runs.first()
        && windows(run).len() < FEWEST
    {
        wrong.push(format!(
            "{}: holds {:.1} s; calibrate takes at least {} s of a swing",
            run.path,
            run.log.duration(),
            FEWEST as f64 * PLAN.window
        ));
    }
    wrong
}

/// Searches for what the declared pendulum lacks.
///
/// # Errors
/// A rig that is none.
pub(super) fn search(
    rig: &Scenario,
    runs: &[Recorded],
    without: &[&str],
    tell: &dyn Fn(&str),
) -> Result<Found, CalibrateError> {
    let (Some(declared), Some(data)) = (Declared::of(rig), runs.first()) else {
        return Err(CalibrateError::Input(vec!["no pendulum, or no recording".to_owned()]));
    };
    let allowed = |sought: Sought| {
        !KINDS.iter().any(|(place, kind)| sought.contains(place) && without.contains(kind))
    };
    let data = windows(data);
    let held: Vec<Window> = runs[1..].iter().flat_map(windows).collect();
    let judged = (!held.is_empty()).then_some(&held[..]);
    let (tried, chosen) = arm::search(declared, &data, judged, &allowed, tell);
    let Some(best) = tried.get(chosen) else {
        let help = "leave something to be looked for";
        return Err(CalibrateError::Input(vec![format!("--without excludes every model; {help}")]));
    };
    let first = &tried[0];
    let mut order: Vec<usize> = (0..tried.len()).collect();
    order.sort_by(|a, b| tried[*a].chosen_by.total_cmp(&tried[*b].chosen_by));
    let ranking = order.iter().map(|&i| {
        let model = &tried[i];
        let ratio = Ratio::of(&model.each, &first.each);
        let last = KINDS.iter().rev().find(|(place, _)| model.sought.contains(place));
        Ranked {
            kind: last.map_or("", |(_, kind)| kind),
            joint: last.and_then(|(place, _)| (*place != 4).then_some("A1")),
            what: model.name.to_owned(),
            validation_score: (1.0 - (model.chosen_by / first.chosen_by).powi(2)).clamp(0.0, 1.0),
            kept: i == chosen,
            round: 1,
            ratio: ratio.mean,
            ratio_ci95: ratio.ci95,
        }
    });
    let ranking = ranking.collect();
    tell("how certain its numbers are");
    let swinger = best.swinger;
    let stds = spread(&swinger, best.sought, &data);
    let std =
        |place: usize| best.sought.iter().position(|p| *p == place).map_or(f64::NAN, |i| stds[i]);
    let top = &tried[order[0]];
    let against = |model: &arm::Tried| {
        let ratio = Ratio::of(&model.each, &top.each);
        format!("{:.2} (95 %: {:.2} to {:.2})", ratio.mean, ratio.ci95[0], ratio.ci95[1])
    };
    let evidence = if chosen == order[0] {
        format!(
            "belongs to the model that is best on windows that it was not fitted to; {} has {} of its error there",
            first.name,
            against(first)
        )
    } else {
        format!(
            "belongs to the model with fewest numbers that is not certainly worse than the best on windows \
             that it was not fitted to: {} of the best one's error there, where {} has {}",
            against(best),
            first.name,
            against(first)
        )
    };
    let inertia = swinger.arm().about_pivot();
    let effects: Vec<EffectReport> =
        swinger.effects().iter().map(|setting| report(setting, inertia, &std, &evidence)).collect();
    let had = |kind: &str| rig.effects.iter().any(|effect| effect.kind.name == kind);
    let added = effects.iter().filter(|e| !had(e.kind)).map(|e| e.kind.to_owned()).collect();
    let parameters = vec![
        Adjusted::new(
            "mechanism.inertia",
            "kg m²",
            declared.arm.inertia,
            // J = m a g/K.
            Fitted::new(swinger.arm().inertia, inertia / swinger.stiffness * std(0)),
        ),
        Adjusted::new(
            "environment.gravity, its direction",
            "rad",
            0.0,
            Fitted::new(swinger.offset, std(1)),
        ),
    ];
    Ok(Found { scenario: swinger.scenario(rig), effects, parameters, ranking, added })
}

fn report(
    setting: &Setting,
    inertia: f64,
    std: &dyn Fn(usize) -> f64,
    evidence: &str,
) -> EffectReport {
    let place = |name: &str| match name {
        "viscous_Nms" => Some(2),
        "coulomb_Nm" => Some(3),
        "torque_Nms2" => Some(4),
        _ => None,
    };
    let param = |(name, value)| {
        let std = place(name).map_or(f64::NAN, |place| inertia * std(place));
        (name, Fitted::new(value, std))
    };
    EffectReport {
        kind: setting.kind.name,
        on: ActsOn::of(setting),
        depends_on: None,
        params: setting.values().map(param).collect(),
        evidence: evidence.to_owned(),
        as_good: Vec::new(),
        equation: setting.kind.equation,
    }
}

/// Standard deviations of the numbers that were sought.
fn spread(swinger: &Swinger, sought: Sought, windows: &[Window]) -> Vec<f64> {
    let numbers = swinger.numbers();
    let pick = |all: [f64; 5]| -> Vec<f64> { sought.iter().map(|place| all[*place]).collect() };
    let build = |values: &[f64], at: [f64; 2]| swinger.with(sought, values).released(at);
    swings::spread(&build, &pick(numbers), &pick(STEPS), windows, PLAN)
}
