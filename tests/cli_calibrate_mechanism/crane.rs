//! What is hidden in a machine of which an angle shows a freedom that nothing drives, and whose joint nobody measures.

use crate::found_of;

/// A camera shows the load's angle in the room; without it the recordings were refused.
#[test]
#[ignore = "a minute and a half"]
fn a_payload_is_found_on_a_load_whose_angle_alone_is_seen() {
    let hidden = [("kind", "payload"), ("body", "load"), ("mass_kg", "0.2"), ("com_x_m", "0.25")];
    let found = found_of("crane", &[&hidden]).remove(0);
    for (name, truth) in [("mass_kg", 0.2), ("com_x_m", 0.25)] {
        let value = found[name]["value"].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 2e-3, "{name}: {value}");
    }
}
