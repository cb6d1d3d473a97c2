//! The files of a prediction of wear.

/// The JSON file of a prediction of wear, by which its folder is known.
pub const WEAR_PREDICTED_FILE: &str = "wear.json";

/// The worn machine, a scenario like any other.
pub const WORN_FILE: &str = "worn.toml";
/// Clearances, stage by stage.
pub const STAGES_FILE: &str = "clearances.csv";
/// The shapes of the rings.
pub const SHAPES_FILE: &str = "rings.csv";
