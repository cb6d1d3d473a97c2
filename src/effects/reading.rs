//! An effect as a scenario's `[[effect]]` has it.

use super::{Central, Efforts, History, Kind, Setting, Target, Targets, Wrong, named};
use crate::measure::spelling::nearest;

fn wrong(key: &str, message: String, help: String) -> Wrong {
    Wrong { key: key.into(), message, help }
}

impl Setting {
    /// Reads the keys of an `[[effect]]`, all but `kind`.
    ///
    /// # Errors
    /// Unknown keys, values that are no numbers or out of bounds, a joint where none belongs.
    pub fn from_table(name: &str, table: &toml::Table) -> Result<Self, Wrong> {
        let Some(kind) = named(name) else {
            let names: Vec<&str> = super::ALL.iter().map(|kind| kind.name).collect();
            return Err(wrong(
                "kind",
                format!("\"{name}\" is not an effect"),
                format!("known: {} (`freeplay effects` explains them)", names.join(", ")),
            ));
        };
        if kind.name == super::unnamed::KIND.name {
            return Self::unnamed_from_table(table);
        }
        let mut setting = Self::on(kind, Target::Machine, &[]);
        for (key, value) in table {
            if kind.targets.key() == Some(key.as_str()) {
                setting.target = target(kind.targets, value)
                    .ok_or_else(|| wrong(key, format!("found {value}"), expected(kind.targets)))?;
            } else {
                setting.values.push(parameter(kind, name, key, value)?);
            }
        }
        if let Some(key) = kind.targets.key()
            && kind.targets.required()
            && setting.target == Target::Machine
        {
            let help = format!("write {key} = \"…\": the {key} that it acts on");
            return Err(wrong(key, format!("is missing for the effect {name}"), help));
        }
        Ok(setting)
    }

    /// The effect without a name: a history, a central force, or a table of efforts or forces.
    fn unnamed_from_table(table: &toml::Table) -> Result<Self, Wrong> {
        Ok(match table.get("depends_on").and_then(toml::Value::as_str) {
            Some("time") => Self::unnamed_history(History::from_table(table)?),
            Some("distance") => Self::unnamed_central(Central::from_table(table)?),
            _ => Self::unnamed_efforts(Efforts::from_table(table)?),
        })
    }
}

/// The parameter that a key and its value give an effect of this name.
fn parameter(
    kind: &Kind,
    name: &str,
    key: &str,
    value: &toml::Value,
) -> Result<(&'static str, f64), Wrong> {
    let Some(parameter) = kind.parameter(key) else {
        let known = kind.parameters.iter().map(|p| p.name);
        let known: Vec<&str> = known.chain(kind.targets.key()).collect();
        return Err(wrong(
            key,
            format!("`{key}` is not a key of the effect {name}"),
            match nearest(key, &known) {
                Some(near) => {
                    format!("did you mean `{near}`? known here: {}", known.join(", "))
                }
                None => format!("known here: {}", known.join(", ")),
            },
        ));
    };
    let number = value.as_float().or(value.as_integer().map(|i| i as f64));
    let Some(number) = number else {
        return Err(wrong(key, format!("found {value}"), "expected a number".to_owned()));
    };
    let [low, high] = parameter.bounds;
    if !(low..=high).contains(&number) {
        let help = format!("expected from {low} to {high} {}", parameter.unit);
        return Err(wrong(key, format!("is {number}"), help.trim_end().to_owned()));
    }
    Ok((parameter.name, number))
}

/// The target that a key's value names, if it does.
fn target(targets: Targets, value: &toml::Value) -> Option<Target> {
    let one = || value.as_str().map(str::to_owned);
    let several = || match value {
        toml::Value::Array(names) => {
            let names: Option<Vec<_>> =
                names.iter().map(|n| n.as_str().map(str::to_owned)).collect();
            names.filter(|names| !names.is_empty())
        }
        _ => one().map(|name| vec![name]),
    };
    match targets {
        Targets::Machine | Targets::Commands | Targets::Tracker => None,
        Targets::Joint(_) | Targets::JointOrAll(_) => several().map(Target::Joints),
        Targets::Sensor(_) => several().map(Target::Sensors),
        Targets::Body => one().map(Target::Body),
        Targets::Point => one().map(Target::Point),
    }
}

/// What such a value is.
fn expected(targets: Targets) -> String {
    match targets {
        Targets::Body => "expected the name of a body, in quotes",
        Targets::Point => "expected a point of a body or of the ground, \"body.point\"",
        Targets::Sensor(_) => "expected the column of a sensor, in quotes, or a list of some",
        _ => "expected the name of a joint, in quotes, or a list of some",
    }
    .to_owned()
}
