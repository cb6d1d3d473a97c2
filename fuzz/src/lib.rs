//! What the targets share: scenarios that read, files to read from, and mutations of text by whole lines.

use freeplay::scenario::Scenario;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use tempfile::TempDir;

/// Rigs with sensors, and the machine that the built-in scenario describes: what other input is read beside.
const MACHINES: [&str; 6] = [
    include_str!("../../assets/default.toml"),
    include_str!("../../assets/rigs/rig-1/rig.toml"),
    include_str!("../../assets/rigs-planar/planar-2/rig.toml"),
    include_str!("../../assets/rigs-planar/planar-5/rig.toml"),
    include_str!("../../assets/drive-stage-declared.toml"),
    include_str!("../../assets/pendulum-declared.toml"),
];

/// The texts of [`MACHINES`], one chosen by a byte of the input.
pub fn machine_text(choice: u8) -> &'static str {
    MACHINES[choice as usize % MACHINES.len()]
}

/// Their scenarios.
pub fn machine(choice: u8) -> &'static Scenario {
    static READ: LazyLock<Vec<Scenario>> = LazyLock::new(|| {
        let read = |text: &&str| Scenario::from_text(text, "machine.toml", &[]).expect("an asset");
        MACHINES.iter().map(read).collect()
    });
    &READ[choice as usize % MACHINES.len()]
}

/// A folder of this process, in memory where the system has such.
fn folder() -> &'static Path {
    static FOLDER: LazyLock<TempDir> = LazyLock::new(|| {
        let memory = Path::new("/dev/shm");
        let made = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
        made.expect("a folder")
    });
    FOLDER.path()
}

/// Puts `content` into the file `name`, in the place of what it held.
pub fn file(name: &str, content: &[u8]) -> PathBuf {
    let path = folder().join(name);
    std::fs::create_dir_all(path.parent().expect("in a folder")).expect("a folder");
    std::fs::write(&path, content).expect("written");
    path
}

/// The first byte of an input, and the text after it.
pub fn choice_and_text(input: &[u8]) -> Option<(u8, &str)> {
    let (choice, text) = input.split_first()?;
    Some((*choice, std::str::from_utf8(text).ok()?))
}

/// Values that readers have to stand.
const VALUES: [&str; 28] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "1e-3",
    "1e3",
    "1e-12",
    "1e12",
    "1e-308",
    "5e-324",
    "1e308",
    "-1e308",
    "inf",
    "nan",
    "9223372036854775807",
    "-9223372036854775808",
    "3.141592653589793",
    "[]",
    "[0, 0]",
    "[1e300, -1e300, 1]",
    "[[0, 0]]",
    "{}",
    "true",
    "\"\"",
    "\"ground\"",
    "\"<b>&\\u0007\"",
    "\"../x.csv\"",
    "1979-05-27",
];

/// Changes a text by whole lines: what is random there mostly fails at the first bracket, and never
/// reaches what lies behind the parser. Every other time libFuzzer changes bytes.
pub fn by_lines(data: &mut [u8], size: usize, most: usize, seed: u32) -> usize {
    let mut dice = Dice(u64::from(seed).wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    let text = std::str::from_utf8(&data[..size]).unwrap_or_default();
    if text.is_empty() || dice.below(2) == 0 {
        return libfuzzer_sys::fuzzer_mutate(data, size, most);
    }
    let mut lines: Vec<String> = text.split('\n').map(str::to_owned).collect();
    for _ in 0..=dice.below(3) {
        change(&mut lines, &mut dice);
    }
    let changed = lines.join("\n");
    let mut end = changed.len().min(most);
    while !changed.is_char_boundary(end) {
        end -= 1;
    }
    data[..end].copy_from_slice(&changed.as_bytes()[..end]);
    end
}

fn change(lines: &mut Vec<String>, dice: &mut Dice) {
    let (at, other) = (dice.below(lines.len()), dice.below(lines.len()));
    match dice.below(8) {
        0 if lines.len() > 1 => drop(lines.remove(at)),
        1 => lines.insert(at, lines[other].clone()),
        2 => lines.swap(at, other),
        // One section once more, from its header on.
        3 => {
            let end = (other + 1..lines.len()).find(|i| lines[*i].starts_with('['));
            let section = lines[other..end.unwrap_or(lines.len())].to_vec();
            lines.splice(at..at, section);
        }
        4 => {
            let (key, value) = (lines[at].clone(), lines[other].clone());
            if let (Some((key, _)), Some((_, value))) = (key.split_once('='), value.split_once('='))
            {
                lines[at] = format!("{key}={value}");
            }
        }
        _ => replace_number(&mut lines[at], dice),
    }
}

/// Another value for one of the numbers in a line, or for all that stands after `=`.
fn replace_number(line: &mut String, dice: &mut Dice) {
    let value = VALUES[dice.below(VALUES.len())];
    let Some(equals) = line.find('=') else { return };
    let part_of_number = |c: char| c.is_ascii_digit() || "+-.e".contains(c);
    let starts: Vec<usize> = line[equals..]
        .char_indices()
        .filter(|(i, c)| {
            c.is_ascii_digit()
                && !line[..equals + i].ends_with(|c: char| c.is_alphanumeric() || c == '.')
        })
        .map(|(i, _)| equals + i)
        .collect();
    match starts.get(dice.below(starts.len() + 1)) {
        Some(start) => {
            let end = line[*start..].find(|c| !part_of_number(c)).map_or(line.len(), |n| start + n);
            line.replace_range(*start..end, value);
        }
        None => line.replace_range(equals + 1.., value),
    }
}

/// SplitMix64.
struct Dice(u64);

impl Dice {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % count.max(1) as u64) as usize
    }
}
