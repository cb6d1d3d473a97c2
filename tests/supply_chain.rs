//! What is built comes from crates.io alone, under the licences of `deny.toml`, and each library in one version but for
//! those that `deny.toml` lists with their reason.

use serde_json::Value;
use std::collections::BTreeMap;
use std::process::Command;

/// `deny.toml`, whose lists `cargo deny` reads as well.
fn rules() -> toml::Table {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/deny.toml");
    std::fs::read_to_string(file).unwrap().parse().unwrap()
}

fn output(arguments: &[&str]) -> String {
    let mut cargo = Command::new(env!("CARGO"));
    let done = cargo.current_dir(env!("CARGO_MANIFEST_DIR")).args(arguments).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    String::from_utf8(done.stdout).unwrap()
}

/// The packages that are built on this platform, this one included; all of them were fetched for the build.
fn packages() -> Vec<Value> {
    let version = output(&["-vV"]);
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).unwrap();
    let metadata = "metadata --locked --offline --format-version 1 --filter-platform";
    let arguments: Vec<&str> = metadata.split(' ').chain([host]).collect();
    let all: Value = serde_json::from_str(&output(&arguments)).unwrap();
    all["packages"].as_array().unwrap().clone()
}

/// Whether an SPDX expression is met by the `allowed` licences: AND binds closer than OR. Older manifests write a slash for OR.
fn met(expression: &str, allowed: &[&str]) -> bool {
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ");
    any(&mut spaced.split_whitespace().peekable(), allowed)
}

type Words<'a, 'b> = &'a mut std::iter::Peekable<std::str::SplitWhitespace<'b>>;

fn any(words: Words, allowed: &[&str]) -> bool {
    let mut met = all(words, allowed);
    while words.next_if_eq(&"OR").is_some() {
        met |= all(words, allowed);
    }
    met
}

fn all(words: Words, allowed: &[&str]) -> bool {
    let mut met = one(words, allowed);
    while words.next_if_eq(&"AND").is_some() {
        met &= one(words, allowed);
    }
    met
}

fn one(words: Words, allowed: &[&str]) -> bool {
    if words.next_if_eq(&"(").is_some() {
        let met = any(words, allowed);
        return words.next_if_eq(&")").is_some() && met;
    }
    let name = words.next().unwrap_or_default();
    // A licence with an exception is another licence.
    let excepted = words.next_if_eq(&"WITH").and_then(|_| words.next());
    excepted.is_none() && allowed.contains(&name)
}

#[test]
fn licences_are_those_that_are_allowed() {
    let rules = rules();
    let allowed = rules["licenses"]["allow"].as_array().unwrap();
    let allowed: Vec<&str> = allowed.iter().map(|name| name.as_str().unwrap()).collect();
    for package in packages() {
        let licence = package["license"].as_str().unwrap_or("none");
        assert!(met(licence, &allowed), "{}: licence {licence}", package["name"]);
    }
    for (expression, meets) in [
        ("MIT", true),
        ("GPL-3.0", false),
        ("GPL-3.0 OR MIT", true),
        ("GPL-3.0 AND MIT", false),
        ("(GPL-3.0 OR MIT) AND Zlib", true),
        ("MIT WITH LLVM-exception", false),
        ("Unlicense/MIT", true),
    ] {
        assert_eq!(met(expression, &["MIT", "Zlib"]), meets, "{expression}");
    }
}

#[test]
fn every_library_comes_from_the_registry() {
    let lock = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.lock")).unwrap();
    let lock: toml::Table = lock.parse().unwrap();
    for package in lock["package"].as_array().unwrap() {
        let source = package.get("source").map_or("", |source| source.as_str().unwrap());
        let ours = package["name"].as_str() == Some("freeplay") && source.is_empty();
        let registry = "registry+https://github.com/rust-lang/crates.io-index";
        assert!(ours || source == registry, "{}: from `{source}`", package["name"]);
    }
}

#[test]
fn no_library_is_there_twice_without_a_reason() {
    let rules = rules();
    let skip = rules["bans"]["skip"].as_array().unwrap();
    let skipped = |name: &str, version: &str| {
        skip.iter().any(|entry| {
            let (skipped, from) = match entry["crate"].as_str().unwrap().split_once('@') {
                Some((name, from)) => (name, format!("{from}.")),
                None => (entry["crate"].as_str().unwrap(), String::new()),
            };
            skipped == name && version.starts_with(&from)
        })
    };
    let mut versions: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in packages() {
        let [name, version] = ["name", "version"].map(|key| package[key].as_str().unwrap());
        if !skipped(name, version) {
            versions.entry(name.to_owned()).or_default().push(version.to_owned());
        }
    }
    versions.retain(|_, versions| versions.len() > 1);
    assert!(versions.is_empty(), "{versions:?}: agree on one, or say why not in deny.toml");
}
