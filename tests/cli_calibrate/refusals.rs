//! Recordings and rigs that cannot be calibrated.

use crate::cli_common::Place;
use crate::recording::{Break, Table, rig};

const BROKEN: &[Break] = &[
    (
        "a renamed command",
        |t| t.rename("q1_cmd", "q1cmd"),
        &["bad.csv:1: ", "unknown column `q1cmd`", "did you mean `q1_cmd`?"],
    ),
    ("a small letter", |t| t.rename("F1", "f1"), &["unknown column `f1`", "did you mean `F1`?"]),
    ("a column twice", |t| t.rename("F2", "F1"), &["bad.csv:1: ", "column `F1` twice"]),
    ("no time", |t| t.drop(&["t"]), &["bad.csv:1: no column `t`"]),
    (
        "a gap",
        |t| drop(t.rows.drain(1000..1100)),
        &["bad.csv:1002: a step of 0.101", "constant rate"],
    ),
    ("a repeated row", |t| t.rows[700] = t.rows[699].clone(), &["bad.csv:702: ", "is repeated"]),
    ("rows exchanged", |t| t.rows.swap(700, 710), &["bad.csv:703: time runs backwards"]),
    ("not a number", |t| t.set(500, "x", "NaN"), &["bad.csv:502: column `x` holds NaN"]),
    ("infinity", |t| t.set(500, "F2", "inf"), &["bad.csv:502: column `F2` holds inf"]),
    ("an empty cell", |t| t.set(500, "q3", ""), &["bad.csv:502: column `q3` holds nothing"]),
    ("a word", |t| t.set(500, "phi", "n/a"), &["bad.csv:502: column `phi` holds n/a"]),
    ("a short row", |t| drop(t.rows[500].pop()), &["bad.csv:502: ", "as many values as"]),
    ("no rows", |t| t.rows.clear(), &["bad.csv", "0 row(s)"]),
    (
        "a dead force sensor",
        |t| (0..t.rows.len()).for_each(|row| t.set(row, "F2", "0.000")),
        &[
            "bad.csv: column `F2` never changes while the commands do, not even by its noise",
            "connected",
        ],
    ),
    (
        "a dead tracker",
        |t| (0..t.rows.len()).for_each(|row| t.set(row, "y", "0.01")),
        &["column `y` never changes"],
    ),
    ("900 ms", |t| t.rows.truncate(900), &["bad.csv: lasts 0.8990 s", "at least 1 s"]),
    (
        "x in mm",
        |t| t.scale(&["x"], 1e3),
        &["`x` is what the commands' own motion says in another unit", "`x` times 0.001"],
    ),
    ("y in mm", |t| t.scale(&["x", "y"], 1e3), &["`x` times 0.001", "`y` times 0.001"]),
    ("phi in mrad", |t| t.scale(&["phi"], 1e3), &["column `phi` is", "`phi` times 0.001"]),
    (
        "phi in degrees",
        |t| t.scale(&["phi"], 57.295_779_5),
        &["column `phi` is what", "`phi` times 0.01745"],
    ),
    (
        "q2 in mm",
        |t| t.scale(&["q2"], 1e3),
        &["`q2` is what the command says in another unit", "`q2` times 0.001"],
    ),
    (
        "commands in mm",
        |t| t.scale(&["q1_cmd", "q2_cmd", "q3_cmd"], 1e3),
        &[
            "column `q1_cmd` starts with 332",
            "where the machine cannot be; it can with column `q1_cmd` times 0.001",
            "column `q2_cmd`",
            "column `q3_cmd`",
        ],
    ),
    (
        "every length in mm",
        |t| t.scale(&["q1_cmd", "q2_cmd", "q3_cmd", "q1", "q2", "q3", "x", "y"], 1e3),
        &["column `q1_cmd` starts with 332", "`q3_cmd` times 0.001"],
    ),
    (
        "forces in kN",
        |t| t.scale(&["F1", "F2", "F3"], 1e-3),
        &["bad.csv: column `F1` is what the servo's law says in another unit", "`F1` times 1000"],
    ),
    ("forces in mN", |t| t.scale(&["F1", "F2", "F3"], 1e3), &["column `F3`", "`F3` times 0.001"]),
    ("time in ms", |t| t.scale(&["t"], 1e3), &["rows are 1.0000 s apart", "in ms, write it in s"]),
    (
        "a low rate",
        |t| {
            let mut row = 0;
            t.rows.retain(|_| {
                row += 1;
                row % 10 == 1
            });
        },
        &["rows are 0.0100 s apart", "at least 200 a second"],
    ),
    (
        "lengths exchanged",
        |t| t.exchange("q1", "q2"),
        &["columns `q1` and `q2` are each what the command says of the other's drive"],
    ),
    (
        "a force negated",
        |t| t.scale(&["F2"], -1.0),
        &[
            "column `F2` has the opposite sign of what the servo's law says",
            "in the direction of its joint's coordinate",
        ],
    ),
    (
        "a command exchanged with its length",
        |t| t.exchange("q1_cmd", "q1"),
        &[
            "column `F1` has the opposite sign",
            "a command and an encoder that are exchanged look alike",
        ],
    ),
    (
        "forces exchanged",
        |t| t.exchange("F1", "F3"),
        &["columns `F1` and `F3` are each what the servo's law says of the other's drive"],
    ),
    (
        "commands exchanged",
        |t| t.exchange("q1_cmd", "q2_cmd"),
        &["columns `q1` and `q2` are each what the command says of the other's drive"],
    ),
];

#[test]
fn broken_recordings_are_refused() {
    let place = Place::new();
    let good = Table::of_rig("run-a.csv");
    let line = format!("calibrate --rig {} --data bad.csv --out c", rig("rig.toml").display());
    for (name, broken, fragments) in BROKEN {
        let mut table = good.clone();
        broken(&mut table);
        place.write("bad.csv", &table.text());
        println!("{name}");
        place.refused(&line, fragments);
    }
}

#[test]
fn a_broken_validation_run_is_refused() {
    let place = Place::new();
    let mut table = Table::of_rig("run-b.csv");
    table.scale(&["F1", "F2", "F3"], 1e-3);
    place.write("bad.csv", &table.text());
    std::fs::copy(rig("run-a.csv"), place.path("copy.csv")).unwrap();
    let line = format!(
        "calibrate --rig {} --data {}",
        rig("rig.toml").display(),
        rig("run-a.csv").display()
    );
    place.refused(&format!("{line} --validate bad.csv"), &["bad.csv: column `F1`", "times 1000"]);
    let in_mm = &["`F1` is what the servo's law says", "a servo of stiffness 5e5 in place of 5e2"];
    place.refused(&format!("{line} --set drive.stiffness=500"), in_mm);
    let copied = &["copy.csv: holds the same samples as", "run-a.csv", "another run"];
    place.refused(&format!("{line} --validate copy.csv"), copied);
    place.refused(&format!("{line} --validate none.csv"), &["none.csv: cannot be read"]);
}

#[test]
fn rigs_that_do_not_fit_are_refused() {
    let place = Place::new();
    let toml = std::fs::read_to_string(rig("rig.toml")).unwrap();
    let data = rig("run-a.csv").display().to_string();
    let without_sensors = &toml[..toml.find("[sensors]").unwrap()];
    place.write("no-sensors.toml", without_sensors);
    place.write("effect.toml", &format!("{toml}\n[[effect]]\nkind = \"payload\"\nmass_kg = 0.1\n"));
    place.write("rig.toml", &toml);
    for (rig, options, fragments) in [
        (
            "no-sensors.toml",
            "",
            &["no-sensors.toml: sensors: is missing", "pose_std", "how exact"][..],
        ),
        ("effect.toml", "", &["effect.toml:", "effect", "holds 1 effect", "freeplay predict"]),
        ("none.toml", "", &["none.toml: cannot be read"]),
        ("rig.toml", "--set sensors.pose_sd=1", &["did you mean `pose_std`?"]),
        ("rig.toml", "--set contact.law=native", &["contact.law: is \"native\"", "hertz-step"]),
        (
            "rig.toml",
            "--set mechanism.base_side=0.7",
            &["run-a.csv: no pose of the machine has its first commands", "is this the rig"],
        ),
        (
            "rig.toml",
            "--set mechanism.base_side=0.62",
            &["run-a.csv: column `phi` is ", "from where the commands lead", "is this the rig"],
        ),
        ("rig.toml", "--without payloads", &["--without: `payloads`", "did you mean `payload`?"]),
        ("rig.toml", "--without zzz", &["`zzz` is not an effect; known: payload, "]),
    ] {
        place.refused(&format!("calibrate --rig {rig} --data {data} {options}"), fragments);
    }
    assert_eq!(place.freeplay(&format!("calibrate --data {data}")).code, 2);
    assert_eq!(place.freeplay("calibrate --rig rig.toml").code, 2);
}

/// Semicolons, decimal commas, a row of units, UTF-16: the same numbers, and it is said how they are written.
#[test]
fn recordings_as_other_programs_write_them_are_read() {
    let place = Place::new();
    let plain = Table::of_rig("run-b.csv").text();
    let mut german = plain.replace(',', ";").replace('.', ",");
    let header = german.find('\n').unwrap();
    let units: Vec<&str> = plain[..header].split(',').map(unit).collect();
    german.insert_str(header, &format!("\n{}", units.join(";")));
    let wide: Vec<u8> =
        [0xfe, 0xff].into_iter().chain(german.encode_utf16().flat_map(u16::to_be_bytes)).collect();
    let rig = rig("rig.toml");
    let predicted = |name: &str, bytes: &[u8]| {
        std::fs::write(place.path(name), bytes).unwrap();
        let done = place
            .freeplay(&format!("predict {} --data {name} --json --quiet --force", rig.display()));
        assert_eq!(done.code, 0, "{}", done.err);
        let json: serde_json::Value = serde_json::from_str(&done.out).unwrap();
        (json["errors"].to_string().replace(name, "run"), done.err)
    };
    let (errors, said) = predicted("plain.csv", plain.as_bytes());
    assert!(!said.contains("note:"), "{said}");
    let (again, said) = predicted("wide.csv", &wide);
    assert_eq!(errors, again);
    let how = "read with UTF-16, semicolons between columns, decimal commas, a row of units";
    assert!(said.contains(&format!("note: wide.csv: {how}")), "{said}");

    let millimetres =
        plain.replacen('\n', &format!("\n{}\n", units.join(",").replace('m', "mm")), 1);
    place.write("mm.csv", &millimetres);
    let line = format!("predict {} --data mm.csv", rig.display());
    // A template takes no scale, the file that it stands for does.
    let said = [
        "mm.csv: ",
        "line 2: column `q1_cmd` is in `[mm]`",
        "expected SI units",
        "freeplay expand",
    ];
    place.refused(&line, &said);
}

fn unit(column: &str) -> &'static str {
    match column {
        "t" => "[s]",
        "phi" => "[rad]",
        force if force.starts_with('F') => "[N]",
        _ => "[m]",
    }
}

/// Windows belong to machines that nothing holds.
#[test]
fn a_platform_is_not_predicted_over_windows() {
    let place = Place::new();
    let [model, data] = ["rig.toml", "run-a.csv"].map(rig);
    let (model, data) = (model.display(), data.display());
    for flag in ["window", "fit", "from"] {
        let line = format!("predict {model} --data {data} --{flag} 1");
        place.refused(&line, &[&format!("--{flag}: "), "not over windows"]);
    }
}

/// A machine without sensors is told how they are declared.
#[test]
fn a_described_machine_without_sensors_is_pointed_to_them() {
    let place = Place::new();
    place.write("four-bar.toml", &place.good("init four-bar"));
    let data = rig("run-a.csv");
    let data = data.display();
    for line in [
        format!("predict four-bar.toml --data {data}"),
        format!("calibrate --rig four-bar.toml --data {data}"),
    ] {
        place.refused(
            &line,
            &["four-bar.toml: sensor: is missing", "[[sensor]]", "init four-bar --rig"],
        );
    }
}
