//! Where results go: new folders, folders that hold something, and disks that are full.

mod cli_common;

use cli_common::Place;

#[test]
fn a_result_is_replaced_only_by_force_and_other_files_never() {
    let place = Place::new();
    place.good("run --duration 0.02 --out r");
    let before = place.read("r/summary.json");
    place.refused("run --duration 0.03 --out r", &["`r` already holds a result", "--force"]);
    assert_eq!(before, place.read("r/summary.json"));
    place.good("run --duration 0.03 --out r --force");
    assert!(place.read("r/summary.json").contains("\"simulated_s\": 0.03"));
    assert_eq!(place.entries(), ["r"]);

    place.write("r/thesis.txt", "years of work");
    place.refused("run --duration 0.02 --out r --force", &["thesis.txt", "choose another folder"]);
    std::fs::create_dir(place.path("mine")).unwrap();
    place.write("mine/summary.json", "{\"program\": \"another\"}");
    place.refused("run --duration 0.02 --out mine --force", &["`mine` holds `summary.json`"]);
    std::fs::create_dir(place.path("empty")).unwrap();
    place.good("run --duration 0.02 --out empty");
}

/// The file system takes 50 kB a file and no more: a run of 1000 s ends there, after a fraction of a
/// second of them.
#[cfg(unix)]
#[test]
fn a_full_disk_ends_the_run_at_once() {
    let place = Place::new();
    let script = "trap '' XFSZ; ulimit -f 100; exec \"$0\" run --duration 1000 --out r --quiet";
    let started = std::time::Instant::now();
    let output = std::process::Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_freeplay")])
        .current_dir(place.path(""))
        .output()
        .unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{err}");
    assert!(err.starts_with("error: cannot write timeseries.csv: "), "{err}");
    assert!(started.elapsed().as_secs() < 20, "the run went on");
    assert!(place.entries().is_empty(), "{:?}", place.entries());
}

/// The README's second `run` said that the folder of the first holds a result. A name that nobody chose counts up.
#[test]
fn a_second_run_stands_beside_the_first() {
    let place = Place::new();
    for (line, folder) in [
        ("run --duration 0.02", "freeplay-run-default"),
        ("run --duration 0.03", "freeplay-run-default-2"),
        ("run --duration 0.04 --quiet", "freeplay-run-default-3"),
    ] {
        place.good(line);
        assert!(place.read(&format!("{folder}/summary.json")).contains("simulated_s"), "{folder}");
    }
    // Sweeps, which go on where they were, find theirs among others.
    let sweep = "sweep --duration 0.02 --vary joints.clearance";
    place.good(&format!("{sweep}=1e-4"));
    place.good(&format!("{sweep}=2e-4"));
    let before = place.read("freeplay-sweep-default/sweep.csv");
    place.good(&format!("{sweep}=1e-4"));
    assert_eq!(place.read("freeplay-sweep-default/sweep.csv"), before);
    assert!(place.read("freeplay-sweep-default-2/sweep.csv").contains("\n0.0002,"));
    place.good("run --duration 0.02 --force");
    let names =
        ["run-default", "run-default-2", "run-default-3", "sweep-default", "sweep-default-2"]
            .map(|name| format!("freeplay-{name}"));
    assert_eq!(place.entries(), names);
}

/// A name that ends in a slash, as a shell completes it, was refused where the folder was new.
#[test]
fn a_folder_may_be_named_with_a_slash_at_its_end() {
    let place = Place::new();
    for out in ["new/", "another/one/"] {
        place.good(&format!("run --duration 0.02 --quiet --out {out}"));
        assert!(place.read(&format!("{out}summary.json")).contains("simulated_s"), "{out}");
    }
    assert_eq!(place.entries(), ["another", "new"]);
}
