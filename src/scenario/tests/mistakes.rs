//! What is said about files and overrides that are wrong.

use super::{MINIMAL, RIG, load_text};

/// A wrong file, overrides, and what the message must contain.
type MistakenFile = (&'static str, &'static [&'static str], &'static [&'static str]);

/// Every mistake says where it is, what is wrong, and what would be right.
fn are_told(mistakes: &[MistakenFile]) {
    for (text, list, fragments) in mistakes {
        let message = match load_text(text, list) {
            Ok(_) => panic!("accepted: {text} {list:?}"),
            Err(problems) => problems.to_string(),
        };
        for fragment in *fragments {
            assert!(
                message.contains(fragment),
                "{text}{list:?}\n  says:  {message}\n  lacks: {fragment}"
            );
        }
        assert_eq!(
            message.lines().count(),
            fragments.iter().filter(|f| f.starts_with("my.toml")).count().max(1),
            "one line for each problem:\n{message}"
        );
    }
}

const SYNTAX: &[MistakenFile] = &[
    ("a = 1\nb = = 2\n", &[], &["my.toml:2:5: "]),
    ("a = 1\na = 2\n", &[], &["my.toml:2:1: ", "duplicate key"]),
    (
        "[joint]\n[joint]\n",
        &[],
        &["my.toml:2:2: duplicate key; there may be many of them: write [[joint]]"],
    ),
    ("[mechanism\n", &[], &["my.toml:1:11: "]),
    ("seed = 99999999999999999999\n", &[], &["my.toml:1:"]),
];

#[test]
fn mistakes_of_syntax() {
    are_told(SYNTAX);
}

const KEYS: &[MistakenFile] = &[
    ("", &[], &["my.toml: mechanism.kind: is missing; write kind = \"3rpr\""]),
    ("seed = 2\n[mechanism]\n", &[], &["my.toml:2: mechanism.kind: is missing"]),
    (
        "[mechanism]\nkind = \"3rpr\"\n[joints]\n# c\nclearence = 1e-4\n",
        &[],
        &["my.toml:5: unknown key `joints.clearence`; did you mean `clearance`?"],
    ),
    (
        "[mechanism]\nkind = \"3rpr\"\n[drive]\nzzz = 1\n",
        &[],
        &["my.toml:4: unknown key `drive.zzz`; known here: mode, stiffness, damping"],
    ),
    (
        "[mechanism]\nkind = \"3rpr\"\n[contacts]\n",
        &[],
        &["my.toml:3: unknown key `contacts`; did you mean `contact`?"],
    ),
    (
        "[mechanism]\nkind = \"3rpr\"\n[motion]\nkind = \"line\"\nradius = 0.1\n",
        &[],
        &["my.toml:5: unknown key `motion.radius`; known here: start, velocity, phi"],
    ),
    (
        "[mechanism]\nkind = \"3rpr\"\n[motion]\nkind = \"multisine\"\n[[motion.terms]]\n\
         frequency = 1\n[[motion.terms]]\nfreqency = 2\n",
        &[],
        &["my.toml:8: unknown key `motion.terms.1.freqency`; did you mean `frequency`?"],
    ),
    (
        "[mechanism]\nkind = \"pendulm\"\n",
        &[],
        &[
            "my.toml:2: mechanism.kind: \"pendulm\" is not a kind of mechanism; did you mean `pendulum`?",
        ],
    ),
    (
        "[mechanism]\nkind = 3\n",
        &[],
        &["my.toml:2: mechanism.kind: 3 is not a kind of mechanism; known here: 3rpr"],
    ),
    (MINIMAL, &["motion.kind=circel"], &["--set motion.kind: ", "did you mean `circle`?"]),
];

#[test]
fn mistakes_of_keys() {
    are_told(KEYS);
}

const TYPES: &[MistakenFile] = &[
    (
        "[mechanism]\nkind = \"3rpr\"\nbase_side = \"big\"\nplatform_side = true\n",
        &[],
        &[
            "my.toml:3: mechanism.base_side: found string \"big\"; expected a number",
            "my.toml:4: mechanism.platform_side: found boolean `true`; expected a number",
        ],
    ),
    (
        "[mechanism]\nkind = \"3rpr\"\n[joints]\nclearance = [1e-4, 1e-4]\n",
        &[],
        &["my.toml:4: joints.clearance: found a list of 2; expected one number for all joints"],
    ),
    (
        "[mechanism]\nkind = \"3rpr\"\n[joints]\nclearance = [\n1, 1, 1,\n\"x\", 1, 1]\n",
        &[],
        &["my.toml:6: joints.clearance.3: found string \"x\"; expected a number"],
    ),
    (
        "[mechanism]\nkind = \"3rpr\"\n[contact]\nlaw = \"nativ\"\n",
        &[],
        &["my.toml:4: contact.law: unknown value \"nativ\"; did you mean `native`?"],
    ),
    (
        "legs = 3\n[mechanism]\nkind = \"3rpr\"\n",
        &[],
        &["my.toml:1: legs: found integer `3`; expected a section with keys"],
    ),
    (
        "seed = -1\n[mechanism]\nkind = \"3rpr\"\n",
        &[],
        &["my.toml:1: seed: found integer `-1`; expected a whole number, 0 or more"],
    ),
    (MINIMAL, &["legs.stroke=[0.2]"], &["--set legs.stroke: found a list of 1; expected"]),
    (MINIMAL, &["name=12"], &["--set name: found integer `12`; expected a string, in quotes"]),
];

#[test]
fn mistakes_of_types() {
    are_told(TYPES);
}

const OVERRIDES: &[MistakenFile] = &[
    (MINIMAL, &["seed"], &["--set seed: `seed` is not an assignment; write PATH=VALUE"]),
    (MINIMAL, &["a..b=1"], &["--set a..b: ", "is not an assignment"]),
    (MINIMAL, &["seed="], &["--set seed: the value is not TOML"]),
    (MINIMAL, &["joints.clearance=[1,2"], &["--set joints.clearance: the value is not TOML"]),
    (
        MINIMAL,
        &["joint.clearance=1"],
        &["--set joint.clearance: joint: is one section, not a list; did you mean `joints`?"],
    ),
    (MINIMAL, &["joints.clearance=0.02"], &["--set joints.clearance: is 0.02 at A1, 0.02 at A2"]),
    (
        RIG,
        &["joints.clearance.7=1"],
        &["--set joints.clearance.7: `joints.clearance` is a list of 6"],
    ),
    (
        RIG,
        &["joints.clearance.x=1"],
        &["it has no x; set the whole of it: --set joints.clearance=…"],
    ),
    (MINIMAL, &["seed=1", "seed.x=1"], &["--set seed.x: `seed` is one integer"]),
];

#[test]
fn mistakes_of_overrides() {
    are_told(OVERRIDES);
}

const VALUES: &[MistakenFile] = &[
    (
        "[mechanism]\nkind = \"3rpr\"\nplatform_mass = inf\n[environment]\ngravity = [0, nan]\n",
        &[],
        &[
            "my.toml:3: mechanism.platform_mass: is inf; expected a finite number",
            "my.toml:5: environment.gravity.1: is NaN; expected a finite number",
        ],
    ),
    (
        "[mechanism]\nkind = \"3rpr\"\nplatform_mass = 0\nplatform_inertia = -1\n",
        &[],
        &[
            "my.toml:3: mechanism.platform_mass: is 0; expected above 0 kg",
            "my.toml:4: mechanism.platform_inertia: is -1; expected above 0 kg m²",
        ],
    ),
    (
        "[mechanism]\nkind = \"3rpr\"\nplatform_side = 1e305\n",
        &[],
        &["my.toml:3: mechanism.platform_side: makes an inertia of inf kg m²"],
    ),
    (
        MINIMAL,
        &["mechanism.platform_side=1e-200"],
        &["mechanism.platform_side: makes an inertia of 0 kg m²"],
    ),
    (
        "[mechanism]\nkind = \"3rrr\"\nplatform_side = 1e305\n",
        &[],
        &["my.toml:3: mechanism.platform_side: makes an inertia of inf kg m²"],
    ),
    (MINIMAL, &["legs.stroke=[0.4,0.2]"], &["two increasing lengths"]),
    (
        MINIMAL,
        &["legs.rod_length=0.1"],
        &["my.toml: legs.stroke: ends at 0.4 m", "0.30000000000000004 m"],
    ),
    (
        RIG,
        &["joints.bearing_radius=4e-4"],
        &["my.toml:8: joints.clearance: is 0.0004 at C1, 0.0005 at C2"],
    ),
    (MINIMAL, &["joints.friction=-0.1"], &["expected 0 or more"]),
    (MINIMAL, &["contact.poisson_ratio=0.5"], &["below 0.5"]),
    (MINIMAL, &["contact.exponent=0.5"], &["1 (linear) or more"]),
    (MINIMAL, &["contact.c_max=-1"], &["expected 0 N s/m or more"]),
    (MINIMAL, &["contact.d_max=0"], &["above 0 m"]),
    (MINIMAL, &["contact.stiffness=0"], &["above 0 N/m^1.5"]),
    (MINIMAL, &["drive.damping=0"], &["above 0 N s/m"]),
];

#[test]
fn mistakes_of_values() {
    are_told(VALUES);
}

const LAWS: &[MistakenFile] = &[
    (
        "[mechanism]\nkind = \"3rpr\"\n[contact]\nlaw = \"hunt-crossley\"\nc_max = 3.0\n",
        &[],
        &["my.toml:5: contact.c_max: means nothing to the law \"hunt-crossley\"; that law takes"],
    ),
    (
        "[mechanism]\nkind = \"3rpr\"\n[contact]\nlaw = \"hunt-crossley\"\nrestitution = 0.5\n",
        &[],
        &["my.toml:5: contact.restitution: means nothing", "that law takes damping (s/m)"],
    ),
    (
        "[mechanism]\nkind = \"3rpr\"\n[contact]\nlaw = \"flores\"\ndamping = 10\n",
        &[],
        &["my.toml:5: contact.damping: means nothing", "that law takes restitution (no unit)"],
    ),
    (MINIMAL, &["contact.law=johnson", "contact.exponent=1.5"], &["--set contact.exponent: means"]),
    (MINIMAL, &["contact.law=flores", "contact.restitution=0"], &["above 0, at most 1"]),
    (MINIMAL, &["contact.law=flores", "contact.restitution=1.1"], &["is 1.1; expected above 0"]),
    (MINIMAL, &["contact.law=kelvin-voigt", "contact.damping=-1"], &["0 or more"]),
    (MINIMAL, &["contact.law=liu", "contact.length=0"], &["expected above 0"]),
    (MINIMAL, &["contact.restitution=0.5"], &["means nothing to the law \"hertz-step\""]),
    (
        MINIMAL,
        &["contact.static_ratio=2"],
        &["--set contact.static_ratio: means nothing to the friction"],
    ),
    (
        MINIMAL,
        &["contact.friction_law=ambrosio", "contact.rest_velocity=1e-2"],
        &["below contact.friction_velocity, 0.001 m/s"],
    ),
    (MINIMAL, &["contact.friction_law=stribek"], &["did you mean `stribeck`?"]),
    (MINIMAL, &["contact.law=hunt-crosley"], &["did you mean `hunt-crossley`?"]),
    (MINIMAL, &["sensors.pose_std=-1"], &["0 m or more"]),
    (MINIMAL, &["motion.period=0"], &["--set motion.period: is 0; expected above 0 s"]),
    (MINIMAL, &["motion.kind=quintic", "motion.time=0"], &["above 0 s"]),
    (MINIMAL, &["motion.kind=table"], &["motion.file: names no file", "t,x,y,phi"]),
    (MINIMAL, &["simulation.duration=0"], &["above 0 s"]),
    (MINIMAL, &["simulation.output_interval=2"], &["at most simulation.duration, 1 s"]),
    (MINIMAL, &["simulation.settle=1"], &["below simulation.duration, 1 s"]),
    (MINIMAL, &["simulation.step=0"], &["above 0 s"]),
    (
        "[mechanism]\nkind = \"3rpr\"\n[simulation]\nstep = 1e-5\ntolerance = 1e-6\n",
        &[],
        &["my.toml:5: simulation.tolerance: stands beside `simulation.step` (my.toml:4); keep one"],
    ),
];

#[test]
fn mistakes_of_laws_and_their_keys() {
    are_told(LAWS);
}
