//! What is compared, by name.

/// One compared quantity.
#[derive(Debug)]
pub struct ComparedQuantity {
    /// Key in `compare.json` and column in `compare.csv`, with its unit.
    pub key: &'static str,
    /// What it is called in words.
    pub label: &'static str,
    /// Its unit in words; lengths are written in the unit that suits them.
    pub unit: &'static str,
}

const fn quantity(key: &'static str, label: &'static str, unit: &'static str) -> ComparedQuantity {
    ComparedQuantity { key, label, unit }
}

/// Number of compared quantities.
pub const COUNT: usize = 15;

/// The compared quantities, in the order of the tables. Means, peaks and fractions leave out the start
/// (`simulation.settle`).
pub const QUANTITIES: [ComparedQuantity; COUNT] = [
    quantity("rms_path_error_m", "path error, rms", "m"),
    quantity("max_path_error_m", "path error, largest", "m"),
    quantity(
        "rms_smooth_acceleration_deviation_m_s2",
        "output acceleration, 10 ms means, rms deviation from ideal",
        "m/s²",
    ),
    quantity(
        "rms_acceleration_deviation_m_s2",
        "output acceleration, rms deviation from ideal",
        "m/s²",
    ),
    quantity("peak_platform_acceleration_m_s2", "output acceleration, peak", "m/s²"),
    quantity("rms_actuator_force_deviation_N", "actuator forces, rms deviation from ideal", "N"),
    quantity("peak_actuator_force_N", "actuator force, peak", "N"),
    quantity("median_contact_force_N", "contact force while touching, median", "N"),
    quantity("contact_force_95_N", "contact force while touching, 95 % quantile", "N"),
    quantity("contact_force_99_N", "contact force while touching, 99 % quantile", "N"),
    quantity("peak_contact_force_N", "contact force, peak", "N"),
    quantity("largest_penetration_m", "penetration, deepest", "m"),
    quantity("contact_fraction", "share of time in contact", ""),
    quantity("impacts_per_s", "impacts per second", "1/s"),
    quantity("energy_lost_W", "energy lost in the contacts, per second", "W"),
];

/// Index of a quantity in [`QUANTITIES`].
pub fn index(key: &str) -> Option<usize> {
    QUANTITIES.iter().position(|q| q.key == key)
}
