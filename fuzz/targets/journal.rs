//! A sweep's record and journal, read, joined and shown. Up to a line of dashes the record (the one of a small
//! sweep where there is none); then the journal. Its lines `RUN cell,cell,…` are given the seal that they need.
#![no_main]

use freeplay::study::sweep::{Record, merge};
use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use sha2::{Digest, Sha256};
use std::path::Path;

const RECORD: &str = include_str!("../record.json");

fuzz_target!(|text: &str| {
    let (record, journal) = text.split_once("\n---\n").unwrap_or((RECORD, text));
    let part = freeplay_fuzz::file("part/sweep.json", record.as_bytes());
    let part = part.parent().expect("in a folder");
    let Ok(record) = Record::read(part) else { return };
    let hash = record.identity.hash();
    let journal: String = journal.split_inclusive('\n').map(|line| sealed(line, &hash)).collect();
    freeplay_fuzz::file("part/rows.jsonl", journal.as_bytes());
    let target = part.with_file_name("joined");
    for partial in [false, true] {
        let _ = merge(&[Path::to_owned(part)], &target, true, partial);
    }
    let _ = std::fs::remove_dir_all(target);
});

fn sealed(line: &str, identity: &str) -> String {
    let Some((run, cells)) = line.strip_suffix('\n').and_then(|line| line.split_once(' ')) else {
        return line.to_owned();
    };
    let Ok(run) = run.parse::<usize>() else { return line.to_owned() };
    let cells: Vec<&str> = cells.split(',').collect();
    let seal = Sha256::digest(format!("{identity} {run} {cells:?}"));
    let seal: String = seal[..8].iter().map(|byte| format!("{byte:02x}")).collect();
    serde_json::json!({ "run": run, "cells": cells, "seal": seal }).to_string() + "\n"
}

fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| {
    freeplay_fuzz::by_lines(data, size, most, seed)
});
