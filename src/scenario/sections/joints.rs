//! `[joints]`: the six passive revolute joints.

use serde::{Deserialize, Serialize};

/// Names of the joints, in the order in which files and arrays list them.
pub const JOINTS: [&str; 6] = ["A1", "A2", "A3", "C1", "C2", "C3"];

/// Bearings and journals. A value per joint is written as one number for all or as a list of six.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Joints {
    /// Inner radius of every bearing, m. Default 0.010: the paper. A change of clearance keeps it
    /// and changes the journal.
    pub bearing_radius: f64,
    /// Clearance c of each joint, m: bearing radius minus journal radius. Default 5e-4: the
    /// paper's machine, whose journals have 9.5 mm.
    #[serde(with = "one_or_six")]
    pub clearance: [f64; 6],
    /// Coulomb friction coefficient μ of each joint, dimensionless. Default 0: the paper has none.
    #[serde(with = "one_or_six")]
    pub friction: [f64; 6],
}

impl Default for Joints {
    fn default() -> Self {
        Joints { bearing_radius: 0.010, clearance: [5e-4; 6], friction: [0.0; 6] }
    }
}

/// One number for all joints or a list of six. Written as one number when all are equal, so that
/// both ways of saying the same give the same text.
mod one_or_six {
    use std::fmt;

    use serde::de::{Deserializer, Error, SeqAccess, Visitor};
    use serde::ser::{Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(
        values: &[f64; 6],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        if values.iter().all(|value| *value == values[0]) {
            serializer.serialize_f64(values[0])
        } else {
            values.serialize(serializer)
        }
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<[f64; 6], D::Error> {
        deserializer.deserialize_any(OneOrSix)
    }

    struct OneOrSix;

    impl<'de> Visitor<'de> for OneOrSix {
        type Value = [f64; 6];

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("one number for all joints or six (A1 A2 A3 C1 C2 C3)")
        }

        fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
            Ok([value; 6])
        }

        fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
            Ok([value as f64; 6])
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
            let mut values = Vec::new();
            while let Some(value) = list.next_element()? {
                values.push(value);
            }
            values.try_into().map_err(|values: Vec<f64>| Error::invalid_length(values.len(), &self))
        }
    }
}
