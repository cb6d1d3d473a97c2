//! What is to be told apart, or seen: as users write it, and as a report left it open.

use super::separation::sized;
use crate::effects::{ALL, Kind, Setting, Target, Targets, named};
use crate::measure::spelling::nearest;
use crate::mechanism::Mechanism;
use serde_json::Value;

/// Effects of a report whose limits are largest that a motion is planned for: each costs as much as the first.
const LARGEST: usize = 3;

/// What a motion is to show.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// Which of two effects it is. The first has values where a report or a user gave some.
    Between(Setting, Setting),
    /// Whether an effect is there; of a size, where somebody gave one.
    Detect(Setting, Option<f64>),
}

impl Question {
    /// In words.
    pub fn words(&self) -> String {
        match self {
            Self::Between(a, b) => format!("{a} or {b}"),
            Self::Detect(effect, _) => format!("{effect}"),
        }
    }
}

/// The questions of `--between`: each of the effects that it lists against each other one.
///
/// # Errors
/// What is wrong with it.
pub fn between(text: &str, mechanism: &Mechanism) -> Result<Vec<Question>, String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    if parts.len() < 2 {
        return Err(format!(
            "--between {text}: expected two effects or more, with a comma between them, such as \
             payload,anchor-offset:A1"
        ));
    }
    let mut rivals = Vec::new();
    for part in parts {
        let told = |wrong: String| format!("--between {part}: {wrong}");
        let (effect, size) = of_size(part).map_err(told)?;
        let mut found = effects(effect, mechanism).map_err(told)?;
        if found.len() > 1 {
            let names: Vec<String> = found.iter().map(|one| one.target.to_string()).collect();
            return Err(told(format!(
                "can act on {}; say on which, as in {effect}:{}",
                names.join("; "),
                names[0].replace(", ", "+")
            )));
        }
        match size {
            Some(size) if rivals.is_empty() => {
                within(&found[0], size).map_err(told)?;
                found = sized(mechanism, &found[0], size);
            }
            Some(_) => {
                let wrong =
                    "a size belongs to the first effect: those of its rivals follow from it";
                return Err(told(wrong.to_owned()));
            }
            None => {}
        }
        rivals.extend(found.into_iter().next());
    }
    let mut questions = Vec::new();
    for (i, a) in rivals.iter().enumerate() {
        for b in &rivals[i + 1..] {
            if a.is(b) {
                return Err(format!("--between {text}: {a} and {b} are the same"));
            }
            questions.push(Question::Between(a.clone(), b.clone()));
        }
    }
    Ok(questions)
}

/// The questions of `--detect`: `KIND`, `KIND:TARGET`, either with `=SIZE`.
///
/// ```
/// use freeplay::calibrate::plan::asked::detect;
/// use freeplay::prelude::*;
///
/// let mechanism = assemble(&Scenario::load(None, &[])?)?.mechanism;
/// let questions = detect("payload", &mechanism).unwrap();
/// assert!(questions[0].words().contains("payload"));
/// assert!(detect("payloda", &mechanism).unwrap_err().contains("payload"), "what was meant");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// What is wrong with it.
pub fn detect(text: &str, mechanism: &Mechanism) -> Result<Vec<Question>, String> {
    let told = |wrong: String| format!("--detect {text}: {wrong}");
    let (effect, size) = of_size(text).map_err(told)?;
    let found = effects(effect, mechanism).map_err(told)?;
    for effect in &found {
        size.map_or(Ok(()), |size| within(effect, size)).map_err(told)?;
    }
    Ok(found.into_iter().map(|effect| Question::Detect(effect, size)).collect())
}

/// An effect and the size behind its `=`, if there is one.
fn of_size(text: &str) -> Result<(&str, Option<f64>), String> {
    let Some((effect, size)) = text.split_once('=') else { return Ok((text.trim(), None)) };
    let size = size.trim().parse::<f64>().ok().filter(|size| size.is_finite() && *size != 0.0);
    let wrong = || "expected a number other than 0 behind the =, in SI units".to_owned();
    Ok((effect.trim(), Some(size.ok_or_else(wrong)?)))
}

/// Refuses a size that takes an effect's value out of its bounds; above the upper one it counts downwards.
fn within(effect: &Setting, size: f64) -> Result<(), String> {
    let value = effect.values().next();
    let Some((name, neutral)) = value else { return Ok(()) };
    let Some(parameter) = effect.kind.parameter(name) else { return Ok(()) };
    let [low, high] = parameter.bounds;
    let reached = if neutral + size > high { neutral - size } else { neutral + size };
    if (low..=high).contains(&reached) {
        return Ok(());
    }
    Err(format!(
        "{name} would be {} {unit}, out of its bounds; expected a size with which it is from {low} to {high} {unit}",
        neutral + size,
        unit = parameter.unit
    ))
}

/// That there is no effect of this name.
fn no_effect(name: &str) -> String {
    let names: Vec<&str> = ALL.iter().filter(|k| k.lasts()).map(|kind| kind.name).collect();
    let near =
        nearest(name, &names).map_or_else(String::new, |near| format!("did you mean {near}? "));
    format!("\"{name}\" is not an effect; {near}`freeplay effects` lists them")
}

/// Effects at their neutral values that a text names: of the target that it names, else of all single ones.
fn effects(text: &str, mechanism: &Mechanism) -> Result<Vec<Setting>, String> {
    let (name, target) = match text.split_once(':') {
        Some((name, target)) => (name.trim(), Some(target.trim())),
        None => (text, None),
    };
    let Some(kind) = named(name).filter(|kind| kind.lasts() && !kind.variants.is_empty()) else {
        return Err(no_effect(name));
    };
    let targets = kind.targets_of(mechanism);
    if targets.is_empty() {
        return Err(format!(
            "{name} cannot act on this machine: it has nothing that {name} acts on"
        ));
    }
    let all = || {
        targets
            .iter()
            .map(Target::to_string)
            .filter(|t| !t.is_empty())
            .collect::<Vec<_>>()
            .join("; ")
    };
    let chosen: Vec<&Target> = match target {
        Some(target) => {
            let asked = target.replace('+', ", ");
            let found = targets.iter().find(|known| known.to_string() == asked);
            let wrong = || match all() {
                known if known.is_empty() => {
                    format!("{name} acts on the whole machine; leave out :{target}")
                }
                known => format!("{name} cannot act on \"{target}\"; here it can act on {known}"),
            };
            vec![found.ok_or_else(wrong)?]
        }
        // What holds where a file names nothing.
        None if kind.targets == Targets::Body => {
            let output =
                mechanism.bodies.get(mechanism.output).map(|body| Target::Body(body.name.clone()));
            let own = targets.iter().find(|target| Some(*target) == output.as_ref());
            vec![own.unwrap_or(&targets[0])]
        }
        None if targets.contains(&Target::Machine) => vec![&Target::Machine],
        None => {
            let single: Vec<&Target> =
                targets.iter().filter(|target| target.names().len() == 1).collect();
            if single.is_empty() { targets.iter().collect() } else { single }
        }
    };
    Ok(chosen.into_iter().filter_map(|target| simplest(kind, target, mechanism)).collect())
}

/// The variant of an effect with the fewest values, at neutral ones.
fn simplest(kind: &'static Kind, target: &Target, mechanism: &Mechanism) -> Option<Setting> {
    let variants = kind.variants_of(mechanism, target);
    let variant = variants.into_iter().min_by_key(|variant| variant.len())?;
    Setting::neutral(kind, target.clone(), variant, mechanism)
}

/// What a report left open: effects that explain the recordings as well as those that were found; else, where nothing is
/// missing or everything explained, the effects whose detection limits are largest.
///
/// # Errors
/// A text that is no report, or one that leaves nothing open that a motion could answer.
pub fn left_open(text: &str, path: &str, mechanism: &Mechanism) -> Result<Vec<Question>, String> {
    let report: Value = serde_json::from_str(text)
        .map_err(|error| format!("{path}: is no report.json: {error}"))?;
    let no_report = || {
        format!(
            "{path}: is no report of a calibration: expected `verdict` and `effects`, as report.json has them"
        )
    };
    let list = |key: &str| report.get(key).and_then(Value::as_array);
    let found =
        list("effects").filter(|_| report.get("verdict").is_some()).ok_or_else(no_report)?;
    let mut questions = Vec::new();
    for effect in found {
        let kind = effect.get("kind").and_then(Value::as_str).unwrap_or_default();
        if named(kind).is_none() {
            let unknown = no_effect(kind);
            return Err(format!("{path}: effects: {unknown}; is it a report of this version?"));
        }
        let Some(own) = setting_of(effect) else { continue };
        let rivals =
            ["as_good", "not_ruled_out"].into_iter().filter_map(|key| effect.get(key)?.as_array());
        for rival in rivals.flatten().filter_map(Value::as_str) {
            let spelt = rival.replacen(" at ", ":", 1).replace(", ", "+");
            let mut others = effects(&spelt, mechanism).map_err(|wrong| {
                format!(
                    "{path}: names {rival} in place of {own}: {wrong}; is it a report of this rig?"
                )
            })?;
            questions.extend(
                others.drain(..).filter(|o| !o.is(&own)).map(|o| Question::Between(own.clone(), o)),
            );
        }
    }
    if !questions.is_empty() {
        return Ok(questions);
    }
    let mut limits: Vec<(f64, Setting)> = list("limits")
        .into_iter()
        .flatten()
        .filter_map(|limit| limit_of(limit, mechanism))
        .collect();
    if limits.is_empty() {
        return Err(format!(
            "{path}: leaves nothing open that a motion could answer: no effect is as good as those found, and no \
             detection limits are known; say what is asked with --between or --detect"
        ));
    }
    limits.sort_by(|a, b| b.0.total_cmp(&a.0));
    Ok(limits.into_iter().take(LARGEST).map(|(_, effect)| Question::Detect(effect, None)).collect())
}

/// The effect of an entry of a report, with the values that were fitted.
fn setting_of(entry: &Value) -> Option<Setting> {
    let kind = named(entry.get("kind")?.as_str()?).filter(|kind| kind.lasts())?;
    let params = entry.get("params")?.as_object()?;
    let values = params.iter().filter_map(|(name, fitted)| {
        Some((kind.parameter(name)?.name, fitted.get("value")?.as_f64()?))
    });
    let values: Vec<(&'static str, f64)> = values.collect();
    (!values.is_empty()).then(|| Setting::on(kind, target_of(kind, entry), &values))
}

fn target_of(kind: &Kind, entry: &Value) -> Target {
    let names: Vec<String> = match kind.targets.key().and_then(|key| entry.get(key)) {
        Some(Value::String(name)) => vec![name.clone()],
        Some(Value::Array(names)) => {
            names.iter().filter_map(Value::as_str).map(str::to_owned).collect()
        }
        _ => Vec::new(),
    };
    match (kind.targets, names.first()) {
        (_, None) => Target::Machine,
        (Targets::Body, Some(name)) => Target::Body(name.clone()),
        (Targets::Point, Some(name)) => Target::Point(name.clone()),
        (Targets::Sensor(_), _) => Target::Sensors(names),
        _ => Target::Joints(names),
    }
}

/// An effect of a report's limits and how large its limit is beside a small value of it; not at any size is larger than
/// any.
fn limit_of(entry: &Value, mechanism: &Mechanism) -> Option<(f64, Setting)> {
    let kind = named(entry.get("kind")?.as_str()?).filter(|kind| kind.lasts())?;
    let target = target_of(kind, entry);
    let known = kind.targets_of(mechanism).contains(&target);
    let parameter = kind.parameter(entry.get("parameter")?.as_str()?)?;
    let smallest = entry.get("smallest")?.as_f64()?;
    known.then(|| Some((smallest / parameter.step, simplest(kind, &target, mechanism)?)))?
}
