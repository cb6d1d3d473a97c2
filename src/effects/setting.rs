//! An effect with its numbers.

use super::{Joints, Kind, Map, Parameter, named};
use crate::mechanism::{Actuator, JointIndex, Mechanism};
use serde::ser::{Serialize, SerializeMap, Serializer};
use std::sync::Arc;

/// What is wrong with a [`Setting`]: the key, what it is, what would be right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wrong {
    /// `kind`, `joint` or a parameter.
    pub key: String,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: String,
}

/// An effect, the joint it is given, and its numbers: one `[[effect]]` of a scenario.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Which effect.
    pub kind: &'static Kind,
    /// The joint it is given; none where it acts on the whole machine or on all joints.
    pub joint: Option<String>,
    values: Vec<(&'static str, f64)>,
    /// What an effect without a name does.
    pub(super) map: Option<Arc<Map>>,
}

impl PartialEq for Setting {
    fn eq(&self, other: &Self) -> bool {
        self.kind.name == other.kind.name
            && self.joint == other.joint
            && self.values == other.values
            && self.map == other.map
    }
}

impl Setting {
    /// The effect `kind` of a joint, if it is given one, with these values of its parameters.
    pub fn new(kind: &'static Kind, joint: Option<&str>, values: &[(&'static str, f64)]) -> Self {
        Self { kind, joint: joint.map(str::to_owned), values: values.to_vec(), map: None }
    }

    /// A fitted map of forces that have no name.
    pub fn unnamed(map: Map) -> Self {
        let kind = &super::unnamed::KIND;
        Self { kind, joint: None, values: Vec::new(), map: Some(Arc::new(map)) }
    }

    /// The map of an effect without a name.
    pub fn map(&self) -> Option<&Map> {
        self.map.as_deref()
    }

    /// Reads the keys of an `[[effect]]`, all but `kind`.
    ///
    /// # Errors
    /// Unknown keys, values that are no numbers or out of bounds, a joint where none belongs.
    pub fn from_table(name: &str, table: &toml::Table) -> Result<Self, Wrong> {
        let wrong =
            |key: &str, message: String, help: String| Wrong { key: key.into(), message, help };
        let Some(kind) = named(name) else {
            let names: Vec<&str> = super::ALL.iter().map(|kind| kind.name).collect();
            return Err(wrong(
                "kind",
                format!("\"{name}\" is not an effect"),
                format!("known: {} (`freeplay effects` explains them)", names.join(", ")),
            ));
        };
        let mut setting = Self { kind, joint: None, values: Vec::new(), map: None };
        if kind.name == super::unnamed::KIND.name {
            setting.map = Some(Arc::new(Map::from_table(table)?));
            return Ok(setting);
        }
        for (key, value) in table {
            if key == "joint" && kind.joints != Joints::None {
                let Some(joint) = value.as_str() else {
                    let help = "expected the name of a joint, in quotes".to_owned();
                    return Err(wrong(key, format!("found {value}"), help));
                };
                setting.joint = Some(joint.to_owned());
                continue;
            }
            let Some(parameter) = kind.parameter(key) else {
                let known: Vec<&str> = kind.parameters.iter().map(|p| p.name).collect();
                let joint = if kind.joints == Joints::None { "" } else { "joint, " };
                return Err(wrong(
                    key,
                    format!("`{key}` is not a key of the effect {name}"),
                    format!("known here: {joint}{}", known.join(", ")),
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
            setting.values.push((parameter.name, number));
        }
        let joint_needed =
            matches!(kind.joints, Joints::Prismatic | Joints::Anchor | Joints::Revolute);
        if joint_needed && setting.joint.is_none() {
            let help = "write joint = \"…\": the joint that it acts on".to_owned();
            return Err(wrong("joint", format!("is missing for the effect {name}"), help));
        }
        Ok(setting)
    }

    /// The value of a parameter: as given, or its default.
    pub fn value(&self, name: &str) -> Option<f64> {
        let given = self.values.iter().find(|(n, _)| *n == name).map(|(_, value)| *value);
        given.or_else(|| self.kind.parameter(name).and_then(|p| p.default))
    }

    /// The value of a parameter that has a default or is always given; 0 where it is not.
    pub(super) fn number(&self, name: &str) -> f64 {
        self.value(name).unwrap_or(0.0)
    }

    /// The values that were given, by name.
    pub fn values(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        self.values.iter().copied()
    }

    /// The same effect with every value that it takes, defaults included.
    pub fn filled(&self) -> Self {
        let value = |p: &Parameter| Some((p.name, self.value(p.name)?));
        Self { values: self.kind.parameters.iter().filter_map(value).collect(), ..self.clone() }
    }

    /// Whether this is the same effect at the same joint, whatever the values.
    pub fn is(&self, other: &Self) -> bool {
        self.kind.name == other.kind.name && self.joint == other.joint
    }

    /// The same effect with other values of the parameters that were given.
    pub fn with(&self, values: &[f64]) -> Self {
        let values = self.values.iter().zip(values).map(|((name, _), v)| (*name, *v)).collect();
        Self { values, ..self.clone() }
    }

    /// Changes `mechanism` as the effect does.
    ///
    /// # Errors
    /// A joint that the machine has not, a value that it cannot take.
    pub fn apply(&self, mechanism: &mut Mechanism) -> Result<(), Wrong> {
        (self.kind.apply)(self, mechanism)
    }

    /// Indices of the joints that the effect is given, out of `names`.
    pub(super) fn chosen<'a>(
        &self,
        names: impl Iterator<Item = &'a str>,
    ) -> Result<Vec<usize>, Wrong> {
        let names: Vec<&str> = names.collect();
        let Some(joint) = &self.joint else { return Ok((0..names.len()).collect()) };
        match names.iter().position(|name| name == joint) {
            Some(index) => Ok(vec![index]),
            None => Err(Wrong {
                key: "joint".to_owned(),
                message: format!("\"{joint}\" is not a joint that {} can be given", self.kind.name),
                help: format!("this machine has {}", names.join(", ")),
            }),
        }
    }

    /// Indices of the prismatic joints that the effect is given.
    pub(super) fn prismatics(&self, mechanism: &Mechanism) -> Result<Vec<usize>, Wrong> {
        self.chosen(mechanism.prismatics.iter().map(|joint| joint.name.as_str()))
    }

    /// Indices of the drives of the prismatic joints that the effect is given.
    pub(super) fn slide_drives(&self, mechanism: &Mechanism) -> Result<Vec<usize>, Wrong> {
        let slides = |actuator: &Actuator| matches!(actuator.joint, JointIndex::Prismatic(_));
        let drives = mechanism.actuators.iter().enumerate();
        let drives: Vec<_> = drives.filter(|(_, actuator)| slides(actuator)).collect();
        let chosen = self.chosen(drives.iter().map(|(_, actuator)| actuator.name.as_str()))?;
        Ok(chosen.into_iter().map(|i| drives[i].0).collect())
    }

    /// Indices of the revolute joints that the effect is given.
    pub(super) fn revolutes(&self, mechanism: &Mechanism) -> Result<Vec<usize>, Wrong> {
        self.chosen(mechanism.revolutes.iter().map(|joint| joint.name.as_str()))
    }
}

impl Serialize for Setting {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("kind", self.kind.name)?;
        if let Some(joint) = &self.joint {
            map.serialize_entry("joint", joint)?;
        }
        for (name, value) in &self.values {
            map.serialize_entry(name, value)?;
        }
        if let Some(unnamed) = &self.map {
            map.serialize_entry("depends_on", &unnamed.depends_on)?;
            map.serialize_entry("middle", &unnamed.middle)?;
            map.serialize_entry("reach", &unnamed.reach)?;
            map.serialize_entry("lengths", &unnamed.lengths)?;
            map.serialize_entry("coefficients", &unnamed.coefficients)?;
        }
        map.end()
    }
}
