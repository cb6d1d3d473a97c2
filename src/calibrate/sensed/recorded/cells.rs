//! A column of a recording that no sensor has, as it was: kept together, because a text of its own for each cell takes
//! twenty times the room of its file.

use std::ops::Range;

/// Texts one behind the other.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::calibrate::sensed) struct Cells {
    text: String,
    /// Where each of them ends.
    ends: Vec<usize>,
}

impl Cells {
    /// Adds a cell.
    pub fn push(&mut self, cell: &str) {
        self.text.push_str(cell);
        self.ends.push(self.text.len());
    }

    /// The cell of a row.
    pub fn get(&self, row: usize) -> &str {
        let start = row.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.text[start..self.ends[row]]
    }

    /// Those of some rows.
    pub fn part(&self, rows: Range<usize>) -> Self {
        let mut part = Self::default();
        rows.for_each(|row| part.push(self.get(row)));
        part
    }
}
