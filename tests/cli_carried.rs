//! A result repeats wherever it lies: tables that a scenario reads are copied into it. The real binary.

mod cli_common;

use cli_common::Place;
use std::fs;

#[test]
fn a_result_repeats_without_the_table_of_its_motion() {
    let place = Place::new();
    let rows = (0..=40).map(|i| {
        let t = 0.01 * f64::from(i);
        format!("{t},{},{},0.5235987755982988\n", 0.02 * t, 0.01 * t * t)
    });
    place.write("way.csv", &format!("t,x,y,phi\n{}", rows.collect::<String>()));
    let file = "[mechanism]\nkind = \"3rpr\"\n[motion]\nkind = \"table\"\nfile = \"way.csv\"\n";
    place.write("along.toml", file);
    place.good("run along.toml --duration 0.05 --out first --quiet");
    assert_eq!(place.read("first/table-1.csv"), place.read("way.csv"));
    assert!(place.read("first/scenario.toml").contains("file = \"table-1.csv\""));
    // Carried somewhere else, and the table gone.
    fs::create_dir(place.path("elsewhere")).unwrap();
    fs::rename(place.path("first"), place.path("elsewhere/first")).unwrap();
    fs::remove_file(place.path("way.csv")).unwrap();
    place.good("run elsewhere/first/scenario.toml --out again --quiet");
    assert_eq!(place.read("again/timeseries.csv"), place.read("elsewhere/first/timeseries.csv"));
    // The copies are part of the result: --force replaces all of it.
    place.good("run --duration 0.05 --out again --force --quiet");
    assert!(!place.path("again/table-1.csv").exists());
}
