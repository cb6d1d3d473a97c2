//! Machines whose joints, or whose drives, differ from each other.

use crate::cli_common::Place;
use crate::files::with;

/// An arm that is held level, with three weights in bearings of two laws; below the one at its end hangs another.
const HANGING: &str = r#"name = "hanging"

[ground.points]
O = [0.0, 0.0]

[environment]
gravity = [0.0, -9.81]

[[body]]
name = "arm"
mass = 0.4
inertia = 1e-3
center_of_mass = [0.1, 0.0]
points = { O = [0.0, 0.0], M = [0.1, 0.0], E = [0.2, 0.0] }

[[body]]
name = "half"
mass = 0.5
inertia = 1e-4
points = { P = [0.0, 0.02] }
start = [0.1, -0.02, 0.0]

[[body]]
name = "one"
mass = 1.0
inertia = 1e-4
points = { P = [0.0, 0.02], Q = [0.0, -0.02] }
start = [0.2, -0.02, 0.0]

[[body]]
name = "two"
mass = 2.0
inertia = 1e-4
points = { P = [0.0, 0.02] }
start = [0.2, -0.06, 0.0]

[[joint]]
name = "M"
kind = "revolute"
ring = "arm.M"
journal = "half.P"
law = "native"
clearance = 2e-5

[[joint]]
name = "O"
kind = "revolute"
ring = "ground.O"
journal = "arm.O"

[[joint]]
name = "E"
kind = "revolute"
ring = "arm.E"
journal = "one.P"
law = "hertz-step"
clearance = 1e-5
c_max = 3000.0

[[joint]]
name = "Q"
kind = "revolute"
ring = "one.Q"
journal = "two.P"
law = "native"
clearance = 3e-5

[[drive]]
joint = "O"
kind = "prescribed"

[simulation]
duration = 0.3
step = 1e-5
"#;

/// The mean of each column of a time series over its last part, by name.
fn means(csv: &str, share: f64) -> impl Fn(&str) -> f64 + use<> {
    let header: Vec<String> = csv.lines().next().unwrap().split(',').map(str::to_owned).collect();
    let rows: Vec<Vec<f64>> = csv
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect())
        .collect();
    let rows = rows[(rows.len() as f64 * (1.0 - share)) as usize..].to_vec();
    move |name| {
        let column = header.iter().position(|column| column == name).unwrap();
        rows.iter().map(|row| row[column]).sum::<f64>() / rows.len() as f64
    }
}

/// Ideal joints, joints under a law and native ones beside each other: at rest each bears what hangs on it.
/// Native contacts were once told apart by their number among the native ones, and so gave their forces to
/// other joints; joints under a law reported 0 N.
#[test]
fn each_joint_of_a_mixed_machine_reports_its_own_force() {
    let place = Place::new();
    let g = 9.81;
    // Whatever the order in which the joints stand.
    let blocks: Vec<&str> = HANGING.split("[[joint]]\n").collect();
    let (last, drive) = blocks[4].split_once("[[drive]]").unwrap();
    for order in [[1, 2, 3, 4], [2, 3, 4, 1], [4, 3, 1, 2]] {
        let joint = |i: usize| format!("[[joint]]\n{}", if i == 4 { last } else { blocks[i] });
        let text = format!("{}{}[[drive]]{drive}", blocks[0], order.map(joint).concat());
        place.write("hanging.toml", &text);
        place.good("run hanging.toml --out run --force --quiet");
        let mean = means(&place.read("run/timeseries.csv"), 0.3);
        for (joint, mass, clearance) in [("M", 0.5, 2e-5), ("E", 3.0, 1e-5), ("Q", 2.0, 3e-5)] {
            let force = mean(&format!("force_{joint}"));
            assert!((force / (mass * g) - 1.0).abs() < 1e-2, "{order:?} {joint}: {force} N");
            let eccentricity = mean(&format!("ecc_{joint}"));
            let depth = eccentricity - clearance;
            assert!((0.0..5e-6).contains(&depth), "{order:?} {joint}: {eccentricity} m");
        }
        // The ideal joint's drive holds all of them by their lever arms.
        let torque = mean("F_O");
        let expected = g * (0.4 * 0.1 + 0.5 * 0.1 + 3.0 * 0.2);
        assert!((torque / expected - 1.0).abs() < 1e-2, "{order:?} O: {torque} N m");
    }
}

/// Two stages that share nothing, each driven by a controller of its own.
const STAGES: &str = r#"name = "stages"

[ground.points]
O = [0.0, 0.0]
P = [0.0, 0.1]

[[body]]
name = "a"
mass = 2.0
inertia = 1e-3
points = { O = [0.0, 0.0] }
start = [0.1, 0.0, 0.0]

[[body]]
name = "b"
mass = 2.0
inertia = 1e-3
points = { O = [0.0, 0.0] }
start = [0.1, 0.1, 0.0]

[[joint]]
name = "A"
kind = "prismatic"
base = "ground.O"
slider = "a.O"

[[joint]]
name = "B"
kind = "prismatic"
base = "ground.P"
slider = "b.O"

[[drive]]
joint = "A"
kind = "sampled"
controller = { position_gain = 40.0, velocity_gain = 400.0, interval = 1e-3 }

[[drive]]
joint = "B"
kind = "sampled"
controller = { position_gain = 40.0, velocity_gain = 400.0, interval = 2.5e-3 }

[[motion]]
joint = "A"
kind = "multisine"
center = 0.1
terms = [{ amplitude = 0.01, frequency = 5.0, phase = 0.4 }]

[[motion]]
joint = "B"
kind = "multisine"
center = 0.1
terms = [{ amplitude = 0.01, frequency = 5.0, phase = 0.4 }]

[simulation]
duration = 0.2
step = 1e-5
"#;

/// Each controller samples at its own interval, whatever others do. All of a machine once sampled at the
/// shortest.
#[test]
fn controllers_sample_at_their_own_intervals() {
    let place = Place::new();
    let run = |name: &str, text: &str| {
        place.write(&format!("{name}.toml"), text);
        place.good(&format!("run {name}.toml --out {name} --quiet"));
        let csv = place.read(&format!("{name}/timeseries.csv"));
        let header: Vec<String> =
            csv.lines().next().unwrap().split(',').map(str::to_owned).collect();
        move |column: &str| -> Vec<f64> {
            let place = header.iter().position(|name| name == column).unwrap();
            let field = |line: &str| line.split(',').nth(place).unwrap().parse().unwrap();
            csv.lines().skip(1).map(field).collect()
        }
    };
    let apart =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0f64, f64::max);
    // Only one interval in the file: that of `a`, or that of `b`.
    let both = run("both", STAGES);
    let fast = run("fast", &with(STAGES, "interval = 2.5e-3", "interval = 1e-3"));
    let slow = run("slow", &with(STAGES, "interval = 1e-3", "interval = 2.5e-3"));
    for (column, bound) in [("q_", 1e-9), ("F_", 1e-5)] {
        let [a, b] = ["A", "B"].map(|joint| format!("{column}{joint}"));
        assert!(apart(&both(&a), &fast(&a)) < bound, "{a}: {}", apart(&both(&a), &fast(&a)));
        assert!(apart(&both(&b), &slow(&b)) < bound, "{b}: {}", apart(&both(&b), &slow(&b)));
        let told = apart(&fast(&b), &slow(&b));
        assert!(told > 1e3 * bound, "{b} does not show the interval: {told}");
    }
}
