//! Recordings and rigs that cannot be right: told with where it stands and what would be right.

use crate::FOUR_BAR;
use crate::cli_common::Place;

const GOOD: &str = "t,crank_cmd,crank,torque,rocker\n";

/// Some rows at rest.
fn rows(count: u32) -> String {
    (0..count).map(|i| format!("{:.3},1,1,0.1,1.6\n", f64::from(i) * 1e-3)).collect()
}

#[test]
fn recordings_that_cannot_be_right_are_refused() {
    let long = rows(1200);
    for (text, fragments) in [
        (
            format!("t,crank_cmd,krank,torque,rocker\n{long}"),
            &["bad.csv:1: unknown column `krank`", "did you mean `crank`?", "[[sensor]]"][..],
        ),
        (
            format!("t,crank_cmd,crank,crank,rocker\n{long}"),
            &["bad.csv:1: column `crank` twice", "keep one"],
        ),
        (
            "t,crank,torque,rocker\n0,1,0.1,1.6\n0.001,1,0.1,1.6\n".to_owned(),
            &["bad.csv:1: no column `crank_cmd`", "commands"],
        ),
        (format!("time,crank_cmd,crank,torque,rocker\n{long}"), &["unknown column `time`"]),
        (format!("{GOOD}{}0.9,1,1,0.1,1.6\n", rows(50)), &["bad.csv:52: a step of"]),
        (format!("{GOOD}{}0.050,1,one,0.1,1.6\n", rows(50)), &["column `crank` holds one"]),
        (GOOD.to_owned(), &["0 row(s)"]),
        // Fewer rows than are left out at both ends.
        (format!("{GOOD}{}", rows(50)), &["bad.csv: lasts 0.0490 s", "at least 1 s"]),
        (
            GOOD.to_owned()
                + &(0..300)
                    .map(|i| format!("{:.2},1,1,0.1,1.6\n", f64::from(i) * 1e-2))
                    .collect::<String>(),
            &["bad.csv: rows are 0.0100 s apart", "at least 200 a second"],
        ),
    ] {
        let place = Place::new();
        place.write("rig.toml", FOUR_BAR);
        place.write("bad.csv", &text);
        place.refused("calibrate --rig rig.toml --data bad.csv --quiet", fragments);
    }
}

/// Nothing drives the lower link, and nobody measured its angle.
#[test]
fn recordings_that_do_not_say_how_a_machine_stands_are_refused() {
    let rig = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/rigs-planar/planar-4/rig.toml");
    let place = Place::new();
    let rows: String = (0..1200).map(|i| format!("{:.3},0.5\n", f64::from(i) * 1e-3)).collect();
    place.write("bad.csv", &format!("t,q_O\n{rows}"));
    place.refused(
        &format!("calibrate --rig {rig} --data bad.csv --quiet"),
        &["do not say how the machine stands", "are measured than it has freedoms"],
    );
}

#[test]
fn the_run_that_was_fitted_proves_nothing() {
    let place = Place::new();
    place.write("rig.toml", FOUR_BAR);
    place.write("a.csv", &format!("{GOOD}{}", rows(1200)));
    place.write("b.csv", &format!("{GOOD}{}", rows(1200)));
    let line = "calibrate --rig rig.toml --data a.csv --validate b.csv --quiet";
    place.refused(line, &["b.csv: holds the same samples as a.csv", "another run"]);
}

/// Noise that is larger than all that a column ever showed.
#[test]
fn noise_that_cannot_be_is_refused() {
    let rigs = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/rigs-planar/planar-2");
    let place = Place::new();
    let rig = std::fs::read_to_string(format!("{rigs}/rig.toml")).unwrap();
    place.write("rig.toml", &rig.replace("std = 0.003", "std = 300.0"));
    let done = place.freeplay(&format!("calibrate --rig rig.toml --data {rigs}/run-a.csv --quiet"));
    assert_eq!(done.code, 2, "{}", done.err);
    // What the rig says alone is doubtful; what it says of this recording is wrong.
    for said in [
        "warning: rig.toml:96: sensor.2.std: is 300 N·m",
        "error: rig.toml:96: sensor.2.std: noise of T_O is 300 N·m, and all that it shows spans",
    ] {
        assert!(done.err.contains(said), "{}", done.err);
    }
    assert_eq!(place.entries(), ["rig.toml"]);
}

#[test]
fn rigs_that_cannot_be_calibrated_are_refused() {
    let (machine, _) = FOUR_BAR.split_once("[[sensor]]").unwrap();
    let payload = "[[effect]]\nkind = \"payload\"\nmass_kg = 0.1\n";
    let encoder = "[[sensor]]\ncolumn = \"crank_cmd\"\nquantity = \"command\"\nof = \"O\"\n";
    for (rig, fragments) in [
        (machine.to_owned(), &["sensor: is missing", "[[sensor]]"][..]),
        (format!("{FOUR_BAR}{payload}"), &["holds 1 effect", "without [[effect]]"]),
        // Nothing was measured: the command says how the machine stands.
        (format!("{machine}{encoder}"), &["nothing that a model could get wrong", "effort"]),
    ] {
        let place = Place::new();
        place.write("rig.toml", &rig);
        let heads = if rig.contains("rocker\"\nquantity") { GOOD } else { "t,crank_cmd\n" };
        let columns = heads.matches(',').count();
        let row = |i: u32| format!("{:.3}{}\n", f64::from(i) * 1e-3, ",1".repeat(columns));
        place.write("a.csv", &(heads.to_owned() + &(0..1200).map(row).collect::<String>()));
        place.refused("calibrate --rig rig.toml --data a.csv --quiet", fragments);
    }
}

/// The first rows of a recorded five-bar, two columns of each row exchanged or one of them multiplied.
fn five_bar(change: &dyn Fn(&mut Vec<f64>)) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/rigs-planar/planar-5");
    let text = std::fs::read_to_string(format!("{folder}/run-a.csv")).unwrap();
    let mut lines = text.lines().take(1500);
    let mut changed = format!("{}\n", lines.next().unwrap());
    for line in lines {
        let mut row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        change(&mut row);
        let cells: Vec<String> = row.iter().map(f64::to_string).collect();
        changed += &format!("{}\n", cells.join(","));
    }
    changed
}

/// A crank-rocker's rocker, which no drive moves, is where the crank's commands lead it; and one that does not move is dead, if
/// its noise does not show either.
#[test]
fn places_that_commands_do_not_lead_to_are_told() {
    let place = Place::new();
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/rigs-planar/planar-2");
    let text = std::fs::read_to_string(format!("{folder}/run-a.csv")).unwrap();
    let changed = |column: usize, change: &dyn Fn(f64) -> f64| {
        let mut lines = text.lines();
        let mut changed = format!("{}\n", lines.next().unwrap());
        for line in lines {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            cells[column] = change(cells[column].parse().unwrap()).to_string();
            changed += &format!("{}\n", cells.join(","));
        }
        changed
    };
    let heads: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let column = |head: &str| heads.iter().position(|known| *known == head).unwrap();
    let degrees = 180.0 / std::f64::consts::PI;
    for (bad, fragment) in [
        (
            changed(column("q_D"), &|q| degrees * q),
            "`q_D` is what the commands' own motion says in another unit",
        ),
        (
            changed(column("q_D"), &|q| -q),
            "`q_D` has the opposite sign of what the commands' own motion",
        ),
        (
            changed(column("T_O"), &|_| 0.25),
            "`T_O` never changes while the commands do, not even by its noise",
        ),
    ] {
        place.write("bad.csv", &bad);
        for command in ["calibrate --rig", "predict"] {
            let line = format!("{command} {folder}/rig.toml --data bad.csv --quiet");
            place.refused(&line, &["bad.csv: ", fragment]);
        }
    }
}

/// Columns t, q_O1_cmd, q_O1, T_O1, q_O2_cmd, q_O2, T_O2: what a command and a servo's law say shows which are mistaken.
#[test]
fn columns_that_are_mistaken_are_told_by_commands_and_laws() {
    let place = Place::new();
    let rig = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/rigs-planar/planar-5/rig.toml");
    let times = |column: usize, factor: f64| move |row: &mut Vec<f64>| row[column] *= factor;
    for (change, fragment) in [
        (
            &times(3, -1.0) as &dyn Fn(&mut Vec<f64>),
            "`T_O1` has the opposite sign of what the servo's law says",
        ),
        (&times(3, 1e3), "it would fit with sensor.2.scale = 0.001"),
        (
            &times(2, 180.0 / std::f64::consts::PI),
            "`q_O1` is what the command says in another unit",
        ),
        (&times(5, 0.0), "`q_O2` stands still while its drive is told to move"),
        (
            &|row| row.swap(3, 6),
            "`T_O1` and `T_O2` are each what the servo's law says of the other's",
        ),
        (&|row| row.swap(2, 5), "`q_O1` and `q_O2` are each what the command says of the other's"),
        (&times(0, 1e3), "if column `t` is in ms, write it in s"),
    ] {
        place.write("bad.csv", &five_bar(change));
        place.refused(&format!("predict {rig} --data bad.csv --quiet"), &["bad.csv: ", fragment]);
        place.refused(
            &format!("calibrate --rig {rig} --data bad.csv --quiet"),
            &["bad.csv: ", fragment],
        );
    }
}
