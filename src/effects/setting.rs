//! An effect with its numbers.

use super::unnamed::FittedTable;
use super::{Central, Efforts, History, Kind, Parameter, Target, Targets, Wrong};
use crate::measure::spelling::nearest;
use crate::mechanism::{Axes, JointIndex, Mark, Mechanism};
use nalgebra::Vector2;
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use std::fmt;
use std::sync::Arc;

/// An effect, what it acts on, and its numbers: one `[[effect]]` of a scenario.
///
/// ```
/// use freeplay::effects::named;
/// use freeplay::prelude::*;
///
/// let mut mechanism = assemble(&Scenario::load(None, &[])?)?.mechanism;
/// let kind = named("joint-wear").unwrap();
/// let name = kind.parameters[0].name;
/// let worn = Setting::new(kind, Some("A1"), &[(name, 1e-4)]);
/// assert_eq!((worn.target.to_string(), worn.value(name)), ("A1".to_owned(), Some(1e-4)));
/// worn.apply(&mut mechanism).unwrap();
/// let wrong = Setting::new(kind, Some("A9"), &[(name, 1e-4)]).apply(&mut mechanism).unwrap_err();
/// assert!(wrong.help.contains("A1"), "what this machine has");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Setting {
    /// Which effect.
    pub kind: &'static Kind,
    /// What it acts on.
    pub target: Target,
    pub(super) values: Vec<(&'static str, f64)>,
    /// What an effect without a name does.
    pub(super) table: Option<FittedTable>,
}

impl PartialEq for Setting {
    fn eq(&self, other: &Self) -> bool {
        self.is(other) && self.values == other.values && self.table == other.table
    }
}

/// The effect and what it acts on, as in `joint-wear at A2`.
impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.target {
            Target::Machine => f.write_str(self.kind.name),
            _ => write!(f, "{} at {}", self.kind.name, self.target),
        }
    }
}

impl Setting {
    /// The effect `kind` of a joint, if it is given one, with these values of its parameters.
    pub fn new(kind: &'static Kind, joint: Option<&str>, values: &[(&'static str, f64)]) -> Self {
        let joints = |joint: &str| Target::Joints(vec![joint.to_owned()]);
        Self::on(kind, joint.map_or(Target::Machine, joints), values)
    }

    /// The effect `kind` of a target, with these values of its parameters.
    pub fn on(kind: &'static Kind, target: Target, values: &[(&'static str, f64)]) -> Self {
        Self { kind, target, values: values.to_vec(), table: None }
    }

    /// The effect `kind` of a target of `mechanism`, where a variant's values change nothing; none where none do.
    pub fn neutral(
        kind: &'static Kind,
        target: Target,
        variant: &[&'static str],
        mechanism: &Mechanism,
    ) -> Option<Self> {
        let zero: Vec<(&'static str, f64)> = variant.iter().map(|name| (*name, 0.0)).collect();
        let setting = Self::on(kind, target, &zero);
        let neutral = (kind.neutral)(mechanism, &setting);
        (neutral.len() == variant.len()).then(|| setting.with(&neutral))
    }

    /// Where a search on `mechanism` starts beside where it changes nothing: lists of its values, in order. Empty where that is
    /// enough.
    pub fn starts(&self, mechanism: &Mechanism) -> Vec<Vec<f64>> {
        (self.kind.starts)(mechanism, self)
    }

    /// Places of the values that say how large an effect with a list of starts is: the first, and what has its unit goes with it, as
    /// friction near rest with friction in motion.
    pub fn sizes(&self) -> Vec<usize> {
        let unit = |name: &str| self.kind.parameter(name).map(|parameter| parameter.unit);
        let units: Vec<_> = self.values().map(|(name, _)| unit(name)).collect();
        (0..units.len()).filter(|&i| units[i] == units[0]).collect()
    }

    /// The values of a start, whose first is not zero, with that made `size` (in its own unit) and the other [sizes](Self::sizes) in
    /// proportion.
    pub fn sized(&self, start: &[f64], size: f64) -> Vec<f64> {
        let mut values = start.to_vec();
        for i in self.sizes() {
            values[i] *= size / start[0];
        }
        values
    }

    /// The joint that it is given, if it is given one alone.
    pub fn joint(&self) -> Option<&str> {
        match &self.target {
            Target::Joints(names) if names.len() == 1 => Some(&names[0]),
            _ => None,
        }
    }

    /// A fitted table of efforts or forces that have no name.
    pub fn unnamed_efforts(table: Efforts) -> Self {
        Self::unnamed(FittedTable::Efforts(Arc::new(table)), Target::Machine)
    }

    /// A fitted central force that has no name.
    pub fn unnamed_central(table: Central) -> Self {
        Self::unnamed(FittedTable::Central(Arc::new(table)), Target::Machine)
    }

    /// A history of efforts in joints that has no name.
    pub fn unnamed_history(history: History) -> Self {
        let target = Target::Joints(vec![history.joint.clone()]);
        Self::unnamed(FittedTable::History(Arc::new(history)), target)
    }

    fn unnamed(table: FittedTable, target: Target) -> Self {
        Self { table: Some(table), ..Self::on(&super::unnamed::KIND, target, &[]) }
    }

    /// The history of an effect without a name that does not last.
    pub fn history(&self) -> Option<&History> {
        match &self.table {
            Some(FittedTable::History(history)) => Some(history),
            _ => None,
        }
    }

    /// The central force of an effect without a name.
    pub fn central(&self) -> Option<&Central> {
        match &self.table {
            Some(FittedTable::Central(table)) => Some(table),
            _ => None,
        }
    }

    /// Whether the effect acts in the recording of this name: a history belongs to the one that it was found in.
    pub fn acts_in(&self, run: &str) -> bool {
        let own = self.history().and_then(|history| history.run.as_deref());
        own.is_none_or(|own| own == run)
    }

    /// The table of efforts of an effect without a name.
    pub fn efforts(&self) -> Option<&Efforts> {
        match &self.table {
            Some(FittedTable::Efforts(table)) => Some(table),
            _ => None,
        }
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

    /// Whether this is the same effect of the same target, whatever the values.
    pub fn is(&self, other: &Self) -> bool {
        self.kind.name == other.kind.name && self.target == other.target
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

    /// What is wrong with a name of its target: `known` are the names of such `things` that the machine has.
    pub(super) fn stranger(&self, name: &str, things: &str, known: &[&str]) -> Wrong {
        let all = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        let article = if things.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
        Wrong {
            key: self.target.key().unwrap_or("kind").to_owned(),
            message: format!(
                "\"{name}\" is not {article} {things} that {} can be given",
                self.kind.name
            ),
            help: match nearest(name, known) {
                Some(near) => format!("did you mean \"{near}\"? this machine has {all}"),
                None => format!("this machine has {all}"),
            },
        }
    }

    /// Indices of what the effect is given, out of `known` names; all of them where none is named.
    fn chosen<'a>(
        &self,
        things: &str,
        known: impl Iterator<Item = &'a str>,
    ) -> Result<Vec<usize>, Wrong> {
        let known: Vec<&str> = known.collect();
        if self.target == Target::Machine {
            return Ok((0..known.len()).collect());
        }
        let place = |name: &String| {
            let found = known.iter().position(|known| known == name);
            found.ok_or_else(|| self.stranger(name, things, &known))
        };
        self.target.names().iter().map(place).collect()
    }

    /// The joints that the effect is given.
    pub(super) fn joints(&self, mechanism: &Mechanism) -> Result<Vec<JointIndex>, Wrong> {
        let Some(joints) = self.kind.targets.joints() else { return Ok(Vec::new()) };
        let taken: Vec<(&str, JointIndex)> =
            mechanism.joints().filter(|(_, joint)| joints.include(mechanism, *joint)).collect();
        let chosen = self.chosen("joint", taken.iter().map(|(name, _)| *name))?;
        Ok(chosen.into_iter().map(|i| taken[i].1).collect())
    }

    /// Indices of the prismatic joints that the effect is given.
    pub(super) fn prismatics(&self, mechanism: &Mechanism) -> Result<Vec<usize>, Wrong> {
        self.chosen("joint", mechanism.prismatics.iter().map(|joint| joint.name.as_str()))
    }

    /// Indices of the drives of the joints that the effect is given.
    pub(super) fn drives(&self, mechanism: &Mechanism) -> Result<Vec<usize>, Wrong> {
        let joints = self.joints(mechanism)?;
        let of = |joint| mechanism.actuators.iter().position(|drive| drive.joint == joint);
        Ok(joints.into_iter().filter_map(of).collect())
    }

    /// Indices of the revolute joints that the effect is given.
    pub(super) fn revolutes(&self, mechanism: &Mechanism) -> Result<Vec<usize>, Wrong> {
        self.chosen("joint", mechanism.revolutes.iter().map(|joint| joint.name.as_str()))
    }

    /// Indices of the sensors that the effect is given.
    pub(super) fn sensors(&self, mechanism: &Mechanism) -> Result<Vec<usize>, Wrong> {
        let Targets::Sensor(senses) = self.kind.targets else { return Ok(Vec::new()) };
        let sensors = mechanism.sensors.iter().enumerate();
        let taken: Vec<(usize, &str)> = sensors
            .filter(|(_, sensor)| senses.include(sensor))
            .map(|(i, sensor)| (i, sensor.column.as_str()))
            .collect();
        let chosen = self.chosen("sensor", taken.iter().map(|(_, column)| *column))?;
        Ok(chosen.into_iter().map(|i| taken[i].0).collect())
    }

    /// The body that the effect is given, else the output body, and the axes that it is described in: of a
    /// machine without names the body's own, at its reference point.
    pub(super) fn body(&self, mechanism: &Mechanism) -> Result<(usize, Axes), Wrong> {
        let bodies = &mechanism.names.bodies;
        let moving = || -> Vec<&str> {
            let moving = bodies.iter().filter(|(_, axes)| axes.origin.body.is_some());
            moving.map(|(name, _)| name.as_str()).collect()
        };
        let name = match &self.target {
            Target::Body(name) => Some(name),
            _ => mechanism.names.output.as_ref(),
        };
        let named = name.and_then(|name| bodies.get(name));
        match (named.and_then(|axes| Some((axes.origin.body?, *axes))), &self.target) {
            (Some(found), _) => Ok(found),
            (None, Target::Body(name)) => Err(self.stranger(name, "moving body", &moving())),
            (None, _) => {
                let origin = Mark { body: Some(mechanism.output), point: Vector2::zeros() };
                Ok((mechanism.output, Axes { origin, angle: 0.0, centre: origin }))
            }
        }
    }

    /// The name of the point that the effect is given.
    pub(super) fn point<'a>(&'a self, mechanism: &Mechanism) -> Result<&'a str, Wrong> {
        let known: Vec<&str> = mechanism.names.points.keys().map(String::as_str).collect();
        match self.target.names() {
            [name] if known.contains(&name.as_str()) => Ok(name),
            names => {
                let name = names.first().map_or("", String::as_str);
                Err(self.stranger(name, "point", &known))
            }
        }
    }
}

/// The keys of a setting that are no table.
struct OwnKeys<'a>(&'a Setting);

impl Serialize for OwnKeys<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Setting { kind, target, values, table } = self.0;
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("kind", kind.name)?;
        // A table says itself what it acts on.
        if let Some(key) = target.key()
            && table.is_none()
        {
            match target.names() {
                [name] => map.serialize_entry(key, name)?,
                names => map.serialize_entry(key, names)?,
            }
        }
        for (name, value) in values {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

impl Serialize for Setting {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct WrittenSetting<'a> {
            #[serde(flatten)]
            keys: OwnKeys<'a>,
            #[serde(flatten)]
            table: &'a Option<FittedTable>,
        }
        WrittenSetting { keys: OwnKeys(self), table: &self.table }.serialize(serializer)
    }
}
