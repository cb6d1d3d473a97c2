//! The mechanism of the docs and those in `assets/mechanisms`, as a user would try them.

mod cli_common;

use cli_common::Place;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::fs;

/// The TOML block of the docs that is called "mine".
fn of_the_docs() -> String {
    let docs =
        fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/mechanisms.md")).unwrap();
    let blocks = docs.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    let mine = blocks.filter(|block| block.starts_with("name = \"mine\""));
    mine.map(str::to_owned).next().expect("the docs have a mechanism of one's own")
}

#[test]
fn the_mechanism_of_the_docs_runs() {
    let place = Place::new();
    place.write("mine.toml", &of_the_docs());
    let text = place.good("check mine.toml");
    for fragment in ["1 (Grübler counts 1), 1 driven", "loop B-A-O-D", "clearance 200 µm"] {
        assert!(text.contains(fragment), "{text}\nlacks: {fragment}");
    }
    place.good("run mine.toml --duration 0.02 --quiet");
    for file in ["player.html", "index.html", "timeseries.csv", "animation.svg"] {
        assert!(place.read(&format!("freeplay-run-mine/{file}")).len() > 1000, "{file}");
    }
}

#[test]
fn every_example_mechanism_runs_and_expands_to_itself() {
    let place = Place::new();
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/mechanisms");
    let mut files = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let expanded = place.good(&format!("expand {}", path.display()));
        place.write("expanded.toml", &expanded);
        assert_eq!(place.good("expand expanded.toml"), expanded, "{name}");
        let run = "--duration 0.05 --set simulation.settle=0.01 --quiet";
        for (file, out) in [(path.display().to_string(), "a"), ("expanded.toml".to_owned(), "b")] {
            let done = place.freeplay(&format!("run {file} {run} --out {out}-{name}"));
            assert_eq!(done.code, 0, "{name}: {}", done.err);
        }
        let [a, b] = ["a", "b"].map(|run| place.read(&format!("{run}-{name}/timeseries.csv")));
        assert!(a == b, "{name}: the file and what it expands to differ");
        files += 1;
    }
    assert!(files >= 4, "{files} files");
}

/// A cell of the table of speeds: its text, and how far another machine's rattle may take it away.
struct Cell {
    text: String,
    value: f64,
    /// As a share of the value, and as such.
    scatter: [f64; 2],
}

/// The table of speeds from its sweep: means over the starts of the crank. Ideal joints do not rattle.
fn table_of_speeds(csv: &str) -> Vec<Vec<Cell>> {
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let rows: Vec<HashMap<String, String>> = reader.deserialize().map(|row| row.unwrap()).collect();
    assert!(rows.iter().all(|row| row["status"] == "ok"));
    let mut speeds: Vec<&str> = rows.iter().map(|row| &*row["motion.velocity"]).collect();
    speeds.dedup();
    let table = speeds.iter().map(|&speed| {
        let mean = |law: &str, figure: &str| {
            let of = rows
                .iter()
                .filter(|row| row["motion.velocity"] == speed && row["contact.law"] == law);
            let values: Vec<f64> = of.map(|row| row[figure].parse().unwrap()).collect();
            values.iter().sum::<f64>() / values.len() as f64
        };
        let played = |figure: &str| mean("hertz-step", figure);
        let cell = |value: f64, scatter| Cell { text: three_digits(value), value, scatter };
        let lost = |joint: &str| {
            let value = 100.0 * (1.0 - played(&format!("contact_fraction_{joint}")));
            Cell { text: format!("{value:.0} %"), value, scatter: [0.0, 5.0] }
        };
        let turns = speed.parse::<f64>().unwrap() / TAU;
        let turn = (60.0 * turns).round();
        let mut cells = vec![Cell { text: format!("{turn}"), value: turn, scatter: [0.0; 2] }];
        for figure in ["peak_force_A_N", "peak_force_B_N", "peak_actuator_torque_Nm"] {
            cells.push(cell(played(figure), [0.3, 0.0]));
            cells.push(cell(mean("ideal", figure), [0.006, 0.0]));
        }
        cells.extend([lost("A"), lost("B")]);
        let impacts = played("impacts_per_s") / turns;
        cells.push(Cell { text: format!("{impacts:.0}"), value: impacts, scatter: [0.5, 1.0] });
        cells.push(cell(1e3 * played("max_path_error_m"), [0.1, 0.0]));
        cells
    });
    table.collect()
}

fn three_digits(value: f64) -> String {
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 12.0);
    format!("{value:.0$}", decimals as usize)
}

/// The command that the docs give is run, and its table compared with theirs.
#[test]
fn the_table_of_speeds_is_that_of_its_sweep() {
    let docs = include_str!("../docs/mechanisms.md");
    let (before, rest) = docs.split_once("<!-- table of speeds -->\n").expect("begins");
    let shown = rest.split_once("<!-- end of table of speeds -->").expect("ends").0;
    let block = before.rsplit("```sh\n").next().expect("a command above the table");
    let line = block.split("```").next().unwrap().replace("\\\n", " ");
    // Shells take the quotes away.
    let line = line.replace('\'', "");
    let line = line.trim().strip_prefix("freeplay ").expect("a command of freeplay");
    let assets = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/");
    let place = Place::new();
    place.good(&format!("{} --quiet", line.replace(" assets/", &format!(" {assets}"))));
    let table = table_of_speeds(&place.read("freeplay-sweep-slider-crank/sweep.csv"));
    let write = |row: &Vec<Cell>| {
        let texts: Vec<&str> = row.iter().map(|cell| &*cell.text).collect();
        format!("| {} |\n", texts.join(" | "))
    };
    let ours: String = table.iter().map(write).collect();
    let rows: Vec<&str> = shown.lines().skip(2).collect();
    assert_eq!(rows.len(), table.len(), "it is\n{ours}");
    for (row, cells) in rows.iter().zip(&table) {
        let texts: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        assert_eq!(texts.len(), cells.len(), "{row}\nit is\n{ours}");
        for (text, cell) in texts.iter().zip(cells) {
            let value: f64 = text.trim_end_matches(" %").parse().unwrap();
            let scatter = cell.scatter[0] * cell.value + cell.scatter[1];
            assert!((value - cell.value).abs() <= scatter, "{text} in\n{row}\nit is\n{ours}");
        }
    }
    // Inertia: four times the force at twice the speed.
    let ideal = |row: usize| table[row][2].value;
    assert!((ideal(4) / ideal(3) - 4.0).abs() < 0.05, "{} to {}", ideal(3), ideal(4));
}
