//! The mechanism of the README and those in `assets/mechanisms`, as a user would try them.

mod cli_common;

use cli_common::Place;
use std::fs;

/// The TOML block of the README that is called "mine".
fn of_the_readme() -> String {
    let readme = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    let blocks = readme.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    let mine = blocks.filter(|block| block.starts_with("name = \"mine\""));
    mine.map(str::to_owned).next().expect("the README has a mechanism of one's own")
}

#[test]
fn the_mechanism_of_the_readme_runs() {
    let place = Place::new();
    place.write("mine.toml", &of_the_readme());
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
