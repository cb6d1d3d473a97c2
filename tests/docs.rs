//! Every shell block of the README and of the docs, pasted into a shell in a fresh copy of the project's files.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// How a block can be tried.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// As it stands.
    Quick,
    /// As it stands, by those who have minutes.
    Minutes,
    /// Its flags alone: it reads what its reader has.
    OwnFiles,
}

/// A block and the line that it begins at.
#[derive(Clone, Debug)]
struct Block {
    line: usize,
    kind: Kind,
    text: String,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The README and all docs.
fn pages() -> Vec<PathBuf> {
    let docs = fs::read_dir(root().join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let mut pages: Vec<PathBuf> =
        docs.filter(|path| path.extension().is_some_and(|extension| extension == "md")).collect();
    pages.push(root().join("README.md"));
    pages.sort();
    pages
}

fn blocks(page: &Path) -> Vec<Block> {
    let text = fs::read_to_string(page).unwrap();
    let (mut blocks, mut before, mut open) = (Vec::new(), "", false);
    for (i, line) in text.lines().enumerate() {
        match line {
            "```sh" => {
                let kind = match before {
                    "<!-- minutes -->" => Kind::Minutes,
                    "<!-- files of your own -->" => Kind::OwnFiles,
                    _ => Kind::Quick,
                };
                blocks.push(Block { line: i + 2, kind, text: String::new() });
                open = true;
            }
            "```" => open = false,
            line if open => {
                let text = &mut blocks.last_mut().unwrap().text;
                *text += line;
                text.push('\n');
            }
            _ => {}
        }
        before = line;
    }
    blocks
}

/// Copies what a clone has and blocks use.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let target = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &target);
        } else {
            fs::copy(&path, &target).unwrap();
        }
    }
}

/// A clone, and programs that stand for `freeplay` and `cargo`. `freeplay` runs as it is; under `FLAGS_ALONE` it
/// explains itself instead, after it has looked at its flags. `cargo install` and `pip install` have happened.
fn clone() -> TempDir {
    let place = TempDir::new().unwrap();
    copy(&root().join("assets"), &place.path().join("assets"));
    let bin = place.path().join(".bin");
    fs::create_dir(&bin).unwrap();
    let freeplay = format!(
        "#!/bin/sh\nif [ -n \"$FLAGS_ALONE\" ]; then exec {0} \"$@\" --help >/dev/null; fi\nexec {0} \"$@\"\n",
        env!("CARGO_BIN_EXE_freeplay")
    );
    let done = ["cargo", "pip", "pytest"].map(|name| (name, "#!/bin/sh\n"));
    for (name, text) in [("freeplay", freeplay.as_str())].iter().chain(&done) {
        let path = bin.join(name);
        fs::write(&path, text).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    }
    place
}

/// Runs a block as pasted, line by line; the first line that fails ends it.
fn paste(shell: &[&str], place: &Path, page: &Path, block: &Block, flags_alone: bool) {
    let path = std::env::var("PATH").unwrap_or_default();
    let mut command = Command::new(shell[0]);
    command.args(&shell[1..]).arg(&block.text).current_dir(place);
    command.env("PATH", format!("{}:{path}", place.join(".bin").display()));
    command.env_remove("FREEPLAY_MEASURED");
    if flags_alone {
        command.env("FLAGS_ALONE", "yes");
    }
    let output = command.output().unwrap();
    let place = format!("{}:{} in {}", page.display(), block.line, shell[0]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{place}\n{}{said}", block.text);
}

const BASH: [&str; 3] = ["bash", "--norc", "-euc"];
const ZSH: [&str; 3] = ["zsh", "-f", "-euc"];

#[test]
fn the_readme_is_short_and_what_it_names_is_there() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    assert!(readme.lines().count() <= 150, "{} lines", readme.lines().count());
    for page in pages() {
        let text = fs::read_to_string(&page).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = link.split('#').next().unwrap();
            if !file.is_empty() && !link.starts_with("http") {
                let target = page.parent().unwrap().join(file);
                assert!(target.exists(), "{}: {link}", page.display());
            }
        }
    }
}

/// Interactive zsh takes comments for words, and an apostrophe in one for an open quote.
#[test]
fn blocks_hold_no_comments() {
    for page in pages() {
        for block in blocks(&page) {
            assert!(!block.text.contains('#'), "{}:{}\n{}", page.display(), block.line, block.text);
        }
    }
}

#[test]
fn every_quick_block_works_in_bash() {
    let mut tried = 0;
    for page in pages() {
        let clone = clone();
        for block in blocks(&page) {
            paste(&BASH, clone.path(), &page, &block, block.kind != Kind::Quick);
            tried += 1;
        }
    }
    assert!(tried > 20, "{tried} blocks");
}

/// What zsh would make of brackets, braces and equal signs: only words are at stake, so flags are enough.
#[test]
fn every_block_is_safe_in_zsh() {
    if Command::new("zsh").arg("--version").output().is_err() {
        println!("skipped: zsh not found");
        return;
    }
    for page in pages() {
        let clone = clone();
        for block in blocks(&page) {
            paste(&ZSH, clone.path(), &page, &block, true);
        }
    }
}

#[test]
#[ignore = "the paper's study and whole calibrations: ten minutes on two cores"]
fn every_long_block_works_in_bash() {
    for page in pages() {
        let clone = clone();
        for block in blocks(&page).iter().filter(|block| block.kind != Kind::OwnFiles) {
            paste(&BASH, clone.path(), &page, block, false);
        }
    }
}
