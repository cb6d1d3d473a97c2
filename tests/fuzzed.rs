//! Inputs that once broke the program: each is refused now, quickly and in words.
//!
//! `tests/fuzzed/*.toml` are scenarios for `freeplay check`. The first line of each says after `#` what its refusal
//! has to say, or `ok` where it is no mistake.

mod cli_common;

use cli_common::Place;
use std::path::Path;
use std::time::{Duration, Instant};

/// Longest that any of them may take, on a machine that does much else.
const QUICK: Duration = Duration::from_secs(10);

#[test]
fn what_once_broke_it_is_refused_in_words() {
    let place = Place::new();
    let mut count = 0;
    for file in Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzzed").read_dir().unwrap() {
        let path = file.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let expected = text.lines().next().and_then(|line| line.strip_prefix("# ")).unwrap();
        let started = Instant::now();
        let done = place.freeplay(&format!("check {}", path.display()));
        let (name, said) = (path.display(), format!("{}{}", done.out, done.err));
        assert!(started.elapsed() < QUICK, "{name}: {:?}", started.elapsed());
        if expected == "ok" {
            assert_eq!(done.code, 0, "{name}: {said}");
        } else {
            assert_eq!(done.code, 2, "{name}: {said}");
            assert!(done.err.contains(expected), "{name}: {said}");
        }
        count += 1;
    }
    assert!(count > 0);
}
