//! The result of a run compared with another one. Up to a line of dashes its summary, then its time series.
#![no_main]

use freeplay::results::Folder;
use freeplay::scenario::DEFAULT_TOML;
use freeplay::study::diff::{DIFF_FILE, Side, diff_results};
use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use std::path::{Path, PathBuf};

const SUMMARY: &str = include_str!("../result/summary.json");
const SERIES: &str = include_str!("../result/timeseries.csv");

fn result(name: &str, summary: &str, series: &str) -> PathBuf {
    let put =
        |file: &str, text: &str| freeplay_fuzz::file(&format!("{name}/{file}"), text.as_bytes());
    put("summary.json", summary);
    put("timeseries.csv", series);
    let scenario = put("scenario.toml", DEFAULT_TOML);
    Path::to_owned(scenario.parent().expect("in a folder"))
}

fuzz_target!(|text: &str| {
    let (summary, series) = text.split_once("\n---\n").unwrap_or((SUMMARY, text));
    let folders = [result("known", SUMMARY, SERIES), result("other", summary, series)];
    let [Ok(known), Ok(other)] = folders.each_ref().map(|folder| Side::read(folder, &[])) else {
        return;
    };
    let target = folders[0].with_file_name("diff");
    let folder = Folder::prepare(&target, DIFF_FILE, true).expect("a folder of its own");
    let names = ["known", "other"].map(str::to_owned);
    let _ = diff_results(&[known, other], folders.each_ref().map(PathBuf::as_path), names, folder);
    let _ = std::fs::remove_dir_all(target);
});

fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| {
    freeplay_fuzz::by_lines(data, size, most, seed)
});
