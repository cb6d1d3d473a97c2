//! `[joints]`: the revolute joints of a machine, all alike or one by one.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;

/// Bearings and journals. A value per joint is written as one number for all or as a list, in the order
/// of the machine's revolute joints (3-RPR: A1 A2 A3 C1 C2 C3). A file that describes its joints itself
/// takes these where a joint says nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Joints {
    /// Inner radius of every bearing, m. Default 0.010: the paper. A change of clearance keeps it
    /// and changes the journal.
    pub bearing_radius: f64,
    /// Clearance c of each joint, m: bearing radius minus journal radius. Default 5e-4 in machines that
    /// have a `[mechanism] kind`: the paper's, whose journals have 9.5 mm; none, ideal joints, in
    /// described ones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<PerJoint>,
    /// Coulomb friction coefficient μ of each joint, dimensionless. Default 0: the paper has none.
    pub friction: PerJoint,
}

impl Default for Joints {
    fn default() -> Self {
        Joints { bearing_radius: 0.010, clearance: None, friction: PerJoint::all(0.0) }
    }
}

/// One number for all joints, or one for each. Written as one number when all are equal, so that
/// both ways of saying the same give the same text.
#[derive(Debug, Clone, PartialEq)]
pub struct PerJoint(Vec<f64>);

impl PerJoint {
    /// The same number for all.
    pub fn all(value: f64) -> Self {
        Self(vec![value])
    }

    /// The number of joint `index`; the last one's where there are fewer.
    pub fn at(&self, index: usize) -> f64 {
        self.0.get(index).or(self.0.last()).copied().unwrap_or_default()
    }

    /// All numbers: one, or as many as were listed.
    pub fn values(&self) -> &[f64] {
        &self.0
    }
}

impl JsonSchema for PerJoint {
    fn schema_name() -> Cow<'static, str> {
        "PerJoint".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let many = json_schema!({"type": "array", "items": {"type": "number"}, "minItems": 1});
        json_schema!({"anyOf": [{"type": "number"}, many]})
    }
}

impl Serialize for PerJoint {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0.as_slice() {
            [first, rest @ ..] if rest.iter().all(|value| value == first) => {
                serializer.serialize_f64(*first)
            }
            values => values.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for PerJoint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(PerJointVisitor)
    }
}

struct PerJointVisitor;

impl<'de> Visitor<'de> for PerJointVisitor {
    type Value = PerJoint;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("one number for all joints or a list of one each")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
        Ok(PerJoint::all(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
        Ok(PerJoint::all(value as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
        let mut values = Vec::new();
        while let Some(value) = list.next_element()? {
            values.push(value);
        }
        if values.is_empty() {
            return Err(Error::invalid_length(0, &self));
        }
        Ok(PerJoint(values))
    }
}
