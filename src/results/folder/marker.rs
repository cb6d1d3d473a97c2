//! The JSON file by which a result is known.

use std::fs;
use std::path::Path;

/// The names of the files of a result, or none if `marker` is not a result's.
pub(super) fn files_of_result(marker: &Path) -> Vec<String> {
    let text = fs::read_to_string(marker).unwrap_or_default();
    let value: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    if value["program"] != env!("CARGO_PKG_NAME") {
        return Vec::new();
    }
    let files = value["files"].as_array().map(Vec::as_slice).unwrap_or_default();
    files.iter().filter_map(|name| name.as_str().map(str::to_owned)).collect()
}
