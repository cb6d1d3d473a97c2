//! Files that mean harm: names that are markup or commands to a terminal, files without end, texts that are work.

mod cli_common;

use cli_common::Place;
use std::fs::File;
use std::time::{Duration, Instant};

/// Longest that a refusal may take, on a machine that does much else.
const QUICK: Duration = Duration::from_secs(10);

/// A pendulum whose every name is markup.
const MARKUP: &str = r#"
name = "</title><script>alert('1')</script>"
[[body]]
name = "<img src=x onerror=alert(2)>"
mass = 1.0
inertia = 0.01
points = { "\"><svg onload=alert(3)>" = [0.0, 0.3] }
[ground]
points = { "]]><b>" = [0.0, 0.0] }
[[joint]]
kind = "revolute"
name = "&lt;</text><script>alert(4)</script>"
ring = "ground.]]><b>"
journal = "<img src=x onerror=alert(2)>.\"><svg onload=alert(3)>"
clearance = 1e-3
[environment]
gravity = [0.0, -9.81]
"#;

#[test]
fn names_are_no_markup_in_pages_and_pictures() {
    let place = Place::new();
    place.write("markup.toml", MARKUP);
    place.freeplay("run markup.toml --duration 0.05 --out run --quiet");
    place.freeplay(
        "sweep markup.toml --duration 0.02 --vary joints.friction=0,0.1 --out sweep --quiet",
    );
    let mut seen = 0;
    for folder in ["run", "sweep"] {
        for file in std::fs::read_dir(place.path(folder)).unwrap() {
            let file = file.unwrap().path();
            if !file.extension().is_some_and(|e| e == "html" || e == "svg") {
                continue;
            }
            let text = std::fs::read_to_string(&file).unwrap();
            for markup in ["<script>alert", "<img", "<svg onload", "]]><b>"] {
                assert!(!text.contains(markup), "{}: {markup}", file.display());
            }
            seen += usize::from(text.contains("alert("));
        }
    }
    assert!(seen >= 3, "names are in {seen} files");
}

/// Names that would act on a terminal are refused; whatever else is quoted shows as numbers.
#[test]
fn no_text_of_a_file_acts_on_the_terminal() {
    let place = Place::new();
    let clear = "\u{1b}[2J\u{9b}31m\u{202e}";
    place.write("name.toml", "name = \"a\\u001b[2J\"\n[mechanism]\nkind = \"3rpr\"\n");
    place
        .refused("check name.toml", &["name.toml:1: name", "U+001B", "without control characters"]);
    place.write("key.toml", "[mechanism]\nkind = \"3rpr\"\n\"a\\u202eb\" = 1\n");
    place.refused("check key.toml", &["key.toml:3", "U+202E"]);
    place.write("syntax.toml", &format!("a = {clear}\n"));
    place.write("log.csv", &format!("t,{clear}\n0,1\n"));
    let rig = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/rigs-planar/planar-2/rig.toml");
    for line in [
        "check syntax.toml".to_owned(),
        format!("check absent{clear}.toml"),
        format!("check --set {clear}=1"),
        format!("check --set name={clear}"),
        format!("predict {rig} --data log.csv"),
        format!("sweep --vary {clear}=1..x:2"),
    ] {
        let done = place.freeplay(&line);
        assert_eq!(done.code, 2, "{line:?}\n{}", done.err);
        for c in ['\u{1b}', '\u{9b}', '\u{202e}'] {
            assert!(!done.err.contains(c) && !done.out.contains(c), "{line:?}\n{:?}", done.err);
        }
    }
}

#[cfg(unix)]
#[test]
fn motions_are_read_from_plain_files_alone() {
    let place = Place::new();
    let made = std::process::Command::new("mkfifo").arg(place.path("pipe")).status().unwrap();
    assert!(made.success());
    for file in ["/dev/zero", "pipe", "."] {
        let started = Instant::now();
        let text = format!(
            "[mechanism]\nkind = \"3rpr\"\n[motion]\nkind = \"table\"\nfile = \"{file}\"\n"
        );
        place.write("table.toml", &text);
        place.refused("check table.toml", &["table.toml:5: motion.file", "is no plain file"]);
        assert!(started.elapsed() < QUICK, "{file}");
    }
}

#[test]
fn a_gigabyte_is_refused_with_its_size() {
    let place = Place::new();
    // A hole: it takes no room.
    File::create(place.path("large")).and_then(|file| file.set_len(1 << 30)).unwrap();
    let assets = concat!(env!("CARGO_MANIFEST_DIR"), "/assets");
    place.write(
        "table.toml",
        "[mechanism]\nkind = \"3rpr\"\n[motion]\nkind = \"table\"\nfile = \"large\"\n",
    );
    let started = Instant::now();
    for (line, most) in [
        (format!("predict {assets}/rigs/rig-1/rig.toml --data large"), "256 MB"),
        (format!("predict {assets}/rigs-planar/planar-2/rig.toml --data large"), "256 MB"),
        (format!("calibrate --rig {assets}/rigs-planar/planar-2/rig.toml --data large"), "256 MB"),
        ("check table.toml".to_owned(), "256 MB"),
        ("check large".to_owned(), "1 MB"),
    ] {
        place.refused(&line, &["large", "holds 1024 MB", &format!("at most {most} are read")]);
    }
    assert!(started.elapsed() < QUICK);
}

/// Texts of a megabyte at most whose cost would grow with its square, or without end.
#[test]
fn texts_that_are_work_are_refused_quickly() {
    let many = |line: &str| line.repeat((1 << 20) / line.len() - 10);
    let counted = |line: fn(usize) -> String| (0..40_000).map(line).collect::<String>();
    let long_key = "k".repeat(400_000);
    for (name, text) in [
        ("deep list", format!("a = {}", many("["))),
        ("deep table", format!("a = {}", many("{a="))),
        ("deep key", format!("{}a = 1", many("a."))),
        ("deep header", format!("[{}a]", many("a."))),
        ("unknown keys", counted(|i| format!("a{i} = 1\n"))),
        ("unknown keys below", format!("[contact]\n{}", counted(|i| format!("a{i} = 1\n")))),
        ("keys below a long one", format!("[[{long_key}]]\n{}", many("[a]\n"))),
        ("a long list below a long key", format!("{long_key} = [{}]", many("nan,"))),
        ("no numbers", format!("[legs]\nstroke = [{}]", many("nan,"))),
        ("bodies", many("[[body]]\n")),
        ("joints", format!("[[body]]\n{}", many("[[joint]]\n"))),
        ("effects", format!("[mechanism]\nkind=\"3rpr\"\n{}", many("[[effect]]\n"))),
        ("points", format!("[ground]\npoints = {{{}}}", counted(|i| format!("p{i}=[0,0],")))),
        ("a long word", format!("{} = 1", "a".repeat(1_000_000))),
    ] {
        let place = Place::new();
        place.write("work.toml", &text);
        let started = Instant::now();
        let done = place.freeplay("check work.toml");
        assert_eq!(done.code, 2, "{name}: {:.1000}", done.err);
        assert!(started.elapsed() < QUICK, "{name}: {:?}", started.elapsed());
    }
}

/// A record that would be counted through for ages, and a key that is no file name.
#[test]
fn sweeps_are_what_their_records_say() {
    let place = Place::new();
    let machine = MARKUP.replace("name = \"&lt;", "name = \"a/../b");
    let joint = "a/../b</text><script>alert(4)</script>";
    place.write("slash.toml", &machine.replace(joint, "a/b"));
    let line = "sweep slash.toml --duration 0.02 --out s --quiet --vary joint.a/b.friction=0.1,0.2";
    assert_eq!(place.freeplay(line).code, 0);
    assert!(place.path("s/over-joint.a-b.friction.svg").exists());
    let record = place.read("s/sweep.json");
    for (right, wrong, said) in [
        ("\"runs\": 2", "\"runs\": 10000000000000000000", "from 1 to 1000000 are possible"),
        ("\"runs\": 2", "\"runs\": 0", "from 1 to 1000000 are possible"),
        ("\"joint.a/b.friction=0.1,0.2\"", "\"x=1\", \"y=1\"", "do not begin with what is varied"),
    ] {
        assert!(record.contains(right), "{record}");
        place.write("s/sweep.json", &record.replacen(right, wrong, 1));
        place.refused("merge s --out t", &["`s/sweep.json` is no record of a sweep", said]);
    }
}
