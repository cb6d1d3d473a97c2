//! `[columns]`: which column of a recording is which quantity, and in which unit.

use crate::measure::log::ColumnSource;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Quantities by their names in logs (`t`, `q1_cmd`, `q1`, `F1`, `added1`, `x`, `y`, `phi`), each with the
/// column that holds it: a name where the column is in SI units, `{ column = "…", scale = … }` where its
/// numbers are to be multiplied. Columns that nothing asks for are left alone. A described machine has
/// `[[sensor]]`s for all of them but `t`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Columns(BTreeMap<String, Column>);

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a column's name, or a table with column and scale")]
enum Column {
    Name(String),
    Scaled(ColumnSource),
}

impl Column {
    fn source(&self) -> ColumnSource {
        match self {
            Column::Name(column) => ColumnSource::new(column, 1.0),
            Column::Scaled(source) => source.clone(),
        }
    }
}

/// The name of time.
const TIME: &str = "t";

impl Columns {
    /// Where a quantity stands, by its name; none where nothing is said of it.
    pub fn source(&self, quantity: &str) -> Option<ColumnSource> {
        self.0.get(quantity).map(Column::source)
    }

    /// Names of the quantities other than time.
    pub fn quantities(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str).filter(|name| *name != TIME)
    }

    /// The same with time alone: all that is left to say of a machine that has `[[sensor]]`s; none where nothing is.
    pub fn time_alone(&self) -> Option<Self> {
        let column = self.0.get(TIME)?.clone();
        Some(Self(BTreeMap::from([(TIME.to_owned(), column)])))
    }
}
