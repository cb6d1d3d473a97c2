//! A good recording of a rig, to be broken.

use serde_json::Value;
use std::path::PathBuf;

pub fn rig(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("assets/rigs/rig-2").join(name)
}

/// A recording as texts, to be broken.
#[derive(Clone)]
pub struct Table {
    pub header: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Table {
    pub fn of_rig(name: &str) -> Self {
        let text = std::fs::read_to_string(rig(name)).unwrap();
        let mut lines =
            text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        Self { header: lines.next().unwrap(), rows: lines.collect() }
    }

    pub fn column(&self, name: &str) -> usize {
        self.header.iter().position(|column| column == name).unwrap()
    }

    pub fn text(&self) -> String {
        let lines = std::iter::once(&self.header).chain(&self.rows).map(|row| row.join(","));
        lines.collect::<Vec<_>>().join("\n") + "\n"
    }

    pub fn rename(&mut self, from: &str, to: &str) {
        let column = self.column(from);
        self.header[column] = to.to_owned();
    }

    /// Gives two columns each other's name.
    pub fn exchange(&mut self, a: &str, b: &str) {
        self.rename(a, "exchanged");
        self.rename(b, a);
        self.rename("exchanged", b);
    }

    pub fn drop(&mut self, names: &[&str]) {
        for name in names {
            let column = self.column(name);
            self.header.remove(column);
            for row in &mut self.rows {
                row.remove(column);
            }
        }
    }

    pub fn set(&mut self, row: usize, name: &str, value: &str) {
        let column = self.column(name);
        self.rows[row][column] = value.to_owned();
    }

    pub fn scale(&mut self, names: &[&str], factor: f64) {
        for name in names {
            let column = self.column(name);
            for row in &mut self.rows {
                row[column] = (row[column].parse::<f64>().unwrap() * factor).to_string();
            }
        }
    }
}

pub fn assert_number(value: &Value, what: &str) {
    assert!(value.is_number(), "{what}: {value}");
}

/// A name, how a good recording is broken, and what the message must contain.
pub type Break = (&'static str, fn(&mut Table), &'static [&'static str]);
