//! Effects of mechanisms from files.

use crate::cli_common::Place;
use crate::files::FOUR_BAR;

const SENSORS: &str = "
[[sensor]]
column = \"q_O\"
quantity = \"position\"
of = \"O\"
[[sensor]]
column = \"q_D\"
quantity = \"position\"
of = \"D\"
[[sensor]]
column = \"T_O\"
quantity = \"force\"
of = \"O\"
[[sensor]]
column = \"x_B\"
quantity = \"x\"
of = \"coupler.B\"
";

fn with(kind: &str, keys: &str) -> String {
    format!("{FOUR_BAR}{SENSORS}[[effect]]\nkind = \"{kind}\"\n{}\n", keys.replace("; ", "\n"))
}

/// Effects that change the motion, and effects that change what sensors show alone.
const MOVING: [(&str, &str); 16] = [
    ("mass-properties", "body = \"crank\"; mass_kg = 0.05; inertia_kg_m2 = 1e-4"),
    ("rotor-inertia", "joint = \"O\"; inertia_kg_m2 = 1e-3; coupling = -0.1"),
    ("payload", "body = \"coupler\"; mass_kg = 0.2; com_x_m = 0.1; com_y_m = 0.01"),
    ("drag", "body = \"crank\"; torque_Nms = 0.01"),
    ("tether", "body = \"coupler\"; stiffness_N_m = 200; anchor_y_m = 0.3; rest_length_m = 0.05"),
    ("unbalance", "body = \"rocker\"; mass_radius_kg_m = 1e-3; frequency_Hz = 30"),
    ("point-offset", "point = \"rocker.B\"; dx_m = 1e-3; dy_m = 2e-3"),
    ("point-offset", "point = \"ground.D\"; dx_m = 1e-3"),
    ("joint-friction", "joint = [\"O\", \"D\"]; coulomb = 0.05; viscous = 0.01"),
    ("torque-ripple", "joint = \"O\"; amplitude = 0.2; per_turn = 8; phase_rad = 0.4"),
    ("encoder-zero", "sensor = \"q_O\"; offset = 0.01"),
    ("encoder-scale", "sensor = \"q_O\"; relative = 0.02"),
    ("encoder-eccentricity", "sensor = \"q_O\"; amplitude = 0.02; phase_rad = 0.5"),
    ("impulse", "body = \"coupler\"; at_s = 0.002; ix_Ns = 0.02; iy_Ns = 0.01"),
    ("load-change", "body = \"rocker\"; at_s = 0.002; fx_N = 3; torque_Nm = 0.1"),
    ("drive-compliance", "joint = \"O\"; compliance_rad_Nm = 1e-3"),
];

const SHOWN: [(&str, &str); 7] = [
    ("encoder-zero", "sensor = \"q_D\"; offset = 0.01"),
    ("encoder-scale", "sensor = \"q_D\"; relative = 0.02"),
    ("encoder-eccentricity", "sensor = \"q_D\"; amplitude = 0.02"),
    ("sensor-latency", "sensor = [\"q_O\", \"q_D\"]; delay_s = 2e-3"),
    ("force-scale", "sensor = \"T_O\"; relative = 0.1"),
    ("force-offset", "sensor = \"T_O\"; offset = 0.2"),
    ("tracker-frame", "dx_m = 0.01; rotation_rad = 0.02; scale = 1.01"),
];

#[test]
fn effects_act_on_what_they_name_and_repeat() {
    let place = Place::new();
    // Gravity as declared: with an effect, whatever it is, a machine is put together once more.
    place.write("plain.toml", &with("gravity", ""));
    place.good("run plain.toml --duration 0.01 --quiet --out plain");
    let plain = place.read("plain/timeseries.csv");
    let runs = MOVING.map(|effect| (effect, true)).into_iter();
    for ((kind, keys), moves) in runs.chain(SHOWN.map(|effect| (effect, false))) {
        place.write("with.toml", &with(kind, keys));
        place.good("run with.toml --duration 0.01 --quiet --out a --force");
        assert_eq!(place.read("a/timeseries.csv") != plain, moves, "{kind} {keys}");
        // What was written has the same effect.
        place.good("run a/scenario.toml --quiet --out b --force");
        assert_eq!(place.read("a/timeseries.csv"), place.read("b/timeseries.csv"), "{kind}");
        assert_eq!(place.read("a/scenario.toml"), place.read("b/scenario.toml"), "{kind}");
    }
}

#[test]
fn examples_of_sensors_and_turning_drives_run() {
    let place = Place::new();
    for kind in ["torque-ripple", "encoder-zero", "sensor-latency", "force-scale", "tracker-frame"]
    {
        let text = place.good(&format!("effects {kind}"));
        let example: String = text[text.find("    [[effect]]").unwrap()..]
            .lines()
            .map(|line| format!("{}\n", line.trim_start()))
            .collect();
        place.write("example.toml", &format!("{FOUR_BAR}{SENSORS}{example}"));
        place.good("check example.toml --quiet");
    }
}

#[test]
fn targets_that_a_machine_lacks_are_refused_with_what_it_has() {
    let place = Place::new();
    let cases: [(&str, &str, &[&str]); 10] = [
        ("payload", "body = \"rokcer\"", &["effect.0.body", "did you mean \"rocker\"?", "crank"]),
        ("payload", "body = \"ground\"", &["effect.0.body", "not a moving body"]),
        ("payload", "body = 3", &["effect.0.body", "name of a body, in quotes"]),
        ("point-offset", "point = \"rocker.C\"", &["effect.0.point", "rocker.B", "ground.D"]),
        ("point-offset", "dx_m = 1e-3", &["effect.0.point: is missing", "point = "]),
        ("joint-friction", "joint = [\"O\", \"E\"]", &["effect.0.joint", "\"E\"", "O, A, B, D"]),
        ("joint-friction", "joint = []", &["effect.0.joint", "a list of some"]),
        ("torque-ripple", "joint = \"D\"", &["effect.0.joint", "this machine has O"]),
        ("force-scale", "sensor = \"q_O\"", &["effect.0.sensor", "this machine has T_O"]),
        ("drag", "sensor = \"q_O\"", &["`sensor` is not a key of the effect drag", "body"]),
    ];
    for (kind, keys, fragments) in cases {
        place.write("bad.toml", &with(kind, keys));
        place.refused("run bad.toml --out r", fragments);
    }
    let text = format!("{FOUR_BAR}[[effect]]\nkind = \"tracker-frame\"\ndx_m = 0.1\n");
    place.write("bad.toml", &text);
    place.refused("run bad.toml --out r", &["effect.0.kind", "no [[sensor]] of quantity x, y"]);
}
