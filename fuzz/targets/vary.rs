//! `--vary PATH=…`, one a line, and the runs that they ask for.
#![no_main]

use freeplay::study::sweep::{Design, Vary};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let read: Result<Vec<Vary>, _> = text.lines().map(Vary::parse).collect();
    let Ok(varied) = read else { return };
    for vary in &varied {
        let again = Vary::parse(&vary.to_string()).unwrap_or_else(|e| panic!("{vary}: {e}"));
        assert_eq!(again, *vary);
    }
    let Ok(design) = Design::new(varied, 1) else { return };
    for run in [0, design.runs() / 2, design.runs() - 1] {
        assert_eq!(design.values(run).len(), design.varied().len());
    }
});
