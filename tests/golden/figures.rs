//! Results in JSON, compared number by number.

use crate::kept::{Differences, kept_json};
use serde_json::Value;

/// What tells when, where and by which version a result was made, and sentences that hold its figures.
const UNSTEADY: [&str; 13] = [
    "version",
    "rapier_version",
    "scenario_hash",
    "runs_hash",
    "table_sha256",
    "wall_s",
    "wall_s_per_simulated_s",
    "files",
    "folder",
    "reason",
    "answer",
    "evidence",
    "equation",
];

/// Results that say how fast rounding grows, or where a step ended: share by which they may differ.
const ROUGH: [(&str, f64); 7] = [
    ("lyapunov_exponent_1_s", 0.05),
    ("e_folding_s", 0.05),
    ("predictability_horizon_s", 0.05),
    ("steps", 0.02),
    ("smallest_step_s", 0.1),
    ("largest_step_s", 0.1),
    ("step_error_m_s", 0.1),
];

/// Without what is unsteady.
pub fn steady(value: Value) -> Value {
    match value {
        Value::Object(map) => {
            let kept = map.into_iter().filter(|(key, _)| !UNSTEADY.contains(&key.as_str()));
            Value::Object(kept.map(|(key, value)| (key, steady(value))).collect())
        }
        Value::Array(list) => Value::Array(list.into_iter().map(steady).collect()),
        other => other,
    }
}

/// The figures against what is kept of them; numbers may differ by a share `limit`.
pub fn compare(name: &str, now: Value, limit: f64) {
    let file = format!("{name}.json");
    let [kept, now] = kept_json(&file, &steady(now));
    let mut walk = Walk { limit, differences: Differences::default() };
    walk.value(&mut Vec::new(), &kept, &now, 0.0);
    walk.differences.settle(&file);
}

/// Below which a quantity with this unit at the end of its name is rounding.
fn least(path: &[String]) -> f64 {
    let ends = |unit: &str| path.iter().any(|key| key.ends_with(unit));
    match () {
        () if ends("_m_s2") || ends("_N") || ends("_1_s") => 1.0,
        () => 1e-6,
    }
}

struct Walk {
    limit: f64,
    differences: Differences,
}

impl Walk {
    /// Keys may have come, none may have gone. `scale` is that of a mean, for its scatter.
    fn value(&mut self, path: &mut Vec<String>, kept: &Value, now: &Value, scale: f64) {
        let place = path.join(".");
        match (kept, now) {
            (Value::Object(kept), Value::Object(now)) => {
                let scale = kept.get("mean").and_then(Value::as_f64).unwrap_or(0.0).abs();
                for (key, kept) in kept {
                    path.push(key.clone());
                    self.value(path, kept, now.get(key).unwrap_or(&"missing".into()), scale);
                    path.pop();
                }
            }
            (Value::Array(kept), Value::Array(now)) if kept.len() == now.len() => {
                for (k, (kept, now)) in kept.iter().zip(now).enumerate() {
                    path.push(k.to_string());
                    self.value(path, kept, now, scale);
                    path.pop();
                }
            }
            (Value::Number(kept), Value::Number(now)) => {
                let [kept, now] = [kept, now].map(|number| number.as_f64().unwrap());
                let scale = scale.max(kept.abs()).max(least(path));
                let rough = ROUGH.iter().find(|(key, _)| path.iter().any(|at| at == key));
                let limit = rough.map_or(self.limit, |(_, share)| *share);
                self.differences.number(&place, kept, now, limit * scale);
            }
            (Value::String(kept), Value::String(now)) => self.words(&place, kept, now),
            _ if kept == now => {}
            _ => self.differences.other(&place, &kept.to_string(), &now.to_string()),
        }
    }

    /// The same words; numbers among them may differ by one in the last digit that they show.
    fn words(&mut self, place: &str, kept: &str, now: &str) {
        let [before, after] = [kept, now].map(|text| text.split_whitespace().collect::<Vec<_>>());
        if before.len() != after.len() {
            return self.differences.other(place, kept, now);
        }
        for (before, after) in before.into_iter().zip(after).filter(|(a, b)| a != b) {
            match (shown(before), shown(after)) {
                (Some((before, digit)), Some((after, _))) => {
                    self.differences.number(place, before, after, 1.01 * digit);
                }
                _ => return self.differences.other(place, kept, now),
            }
        }
    }
}

/// A number among words, and one in its last digit.
fn shown(word: &str) -> Option<(f64, f64)> {
    let word = word.trim_matches(|c: char| !c.is_ascii_digit() && c != '-');
    let number: f64 = word.parse().ok()?;
    let (digits, exponent) = word.split_once('e').unwrap_or((word, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    Some((number, 10_f64.powi(exponent.parse::<i32>().ok()? - i32::try_from(decimals).ok()?)))
}
