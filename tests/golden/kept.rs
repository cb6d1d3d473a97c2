//! The files of `data/`, and what differs from them.

use serde_json::Value;
use std::path::Path;

/// What is kept under this name. Where files are written, `now` is kept first.
pub fn kept(name: &str, now: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/data").join(name);
    if std::env::var("FREEPLAY_WRITE_GOLDEN").is_ok_and(|value| value == "1") {
        std::fs::write(&path, now).unwrap();
    }
    std::fs::read_to_string(&path)
        .unwrap_or_else(|e| panic!("{}: {e}; FREEPLAY_WRITE_GOLDEN=1 writes it", path.display()))
}

/// The same of a result in JSON: what is kept, and what is now. Both are read from text, for a number
/// that is read twice may differ in its last bit.
pub fn kept_json(name: &str, now: &Value) -> [Value; 2] {
    let now = serde_json::to_string_pretty(now).unwrap() + "\n";
    [&kept(name, &now), &now].map(|text| serde_json::from_str(text).unwrap())
}

/// What differs between a result and what is kept of it.
#[derive(Debug, Default)]
pub struct Differences {
    broken: Vec<String>,
    /// The largest one, in units of its limit, and where it is.
    worst: (f64, String),
}

impl Differences {
    /// Numbers that may differ by `limit`.
    pub fn number(&mut self, place: &str, kept: f64, now: f64, limit: f64) {
        let share = if kept == now { 0.0 } else { (now - kept).abs() / limit };
        if share > self.worst.0 {
            self.worst = (share, place.to_owned());
        }
        if share > 1.0 || share.is_nan() {
            self.broken
                .push(format!("{place}: {now}, kept {kept}, limit of the difference {limit:.1e}"));
        }
    }

    pub fn other(&mut self, place: &str, kept: &str, now: &str) {
        self.broken.push(format!("{place}: {now}, kept {kept}"));
    }

    /// Says how far the result is from what is kept, and fails where that is too far.
    pub fn settle(self, name: &str) {
        let (share, place) = &self.worst;
        if *share == 0.0 && self.broken.is_empty() {
            println!("{name}: the same");
        } else {
            println!("{name}: differs by {share:.1e} of the limit, {place}");
        }
        let first: Vec<&str> = self.broken.iter().take(20).map(String::as_str).collect();
        assert!(first.is_empty(), "{name}, {} places:\n{}", self.broken.len(), first.join("\n"));
    }
}
