//! What ARCHITECTURE.md says of the code holds: rooms use what stands below them, files do not use each other in circles,
//! folders stay small, a name means one type, and one room knows the physics engine.

mod use_paths;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use use_paths::{declared, used};

/// Folders that may hold more files than others: ARCHITECTURE.md says why.
const FLAT: [&str; 1] = ["contact/laws"];

/// Files that a folder may hold beside its `mod.rs`.
const DOZEN: usize = 12;

/// A kind of effect says how its settings act, a setting says of which kind it is, and tables of what has no name are values of
/// a setting: one concept in three files.
const ONE_CONCEPT: [&str; 3] = ["effects/kind.rs", "effects/setting.rs", "effects/unnamed/mod.rs"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All source files, by their paths inside `src`, without comments and unit tests; files that are unit tests as a whole
/// are left out.
fn sources() -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    let mut folders = vec![root().join("src")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path: PathBuf = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let inside = path.strip_prefix(root().join("src")).unwrap();
                found.insert(
                    inside.to_str().unwrap().to_owned(),
                    fs::read_to_string(&path).unwrap(),
                );
            }
        }
    }
    let tests: Vec<String> =
        found.iter().flat_map(|(path, text)| test_modules(path, text)).collect();
    found.retain(|path, _| {
        !tests.iter().any(|test| path == test || path.starts_with(&test.replace(".rs", "/")))
    });
    found.into_iter().map(|(path, text)| (path, without_tests(&text))).collect()
}

/// Files that `#[cfg(test)] mod NAME;` names.
fn test_modules(path: &str, text: &str) -> Vec<String> {
    let folder = path.strip_suffix("mod.rs").unwrap_or_else(|| path.strip_suffix(".rs").unwrap());
    let folder = if folder.is_empty() || folder.ends_with('/') {
        folder.to_owned()
    } else {
        format!("{folder}/")
    };
    let after = text.split("#[cfg(test)]").skip(1);
    let named = after.filter_map(|rest| {
        let line = rest.trim_start().lines().next()?.trim_start_matches("pub(crate) ");
        line.strip_prefix("mod ")?.strip_suffix(';')
    });
    named.map(|name| format!("{folder}{name}.rs")).collect()
}

fn without_tests(text: &str) -> String {
    let until = text.find("#[cfg(test)]\nmod tests {").unwrap_or(text.len());
    let lines = text[..until].lines().map(|line| line.split("//").next().unwrap_or_default());
    lines.collect::<Vec<_>>().join("\n")
}

/// The floor of each room, as the table says it.
fn floors() -> BTreeMap<String, u32> {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let rows = text.lines().filter_map(|line| {
        let mut cells = line.strip_prefix("| ")?.split('|');
        let floor: u32 = cells.next()?.trim().parse().ok()?;
        let rooms = cells.next()?.split('`').filter_map(|name| name.strip_suffix('/'));
        Some(rooms.map(move |room| (room.to_owned(), floor)).collect::<Vec<_>>())
    });
    rows.flatten().collect()
}

#[test]
fn rooms_use_what_stands_below_them() {
    let floors = floors();
    assert!(floors.len() > 10, "{floors:?}");
    let (mut wrong, mut uses) = (Vec::new(), 0);
    for (path, text) in sources() {
        let Some((room, _)) = path.split_once('/') else { continue };
        for other in used(&path, &text).iter().filter_map(|used| used.first()) {
            let Some(floor) = floors.get(other) else { continue };
            uses += 1;
            if other != room && *floor >= floors[room] {
                wrong.push(format!("{path} uses {other}"));
            }
        }
    }
    assert!(uses > 1000, "{uses}");
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn one_room_knows_the_physics_engine() {
    let knows = |text: &str| text.contains("rapier2d_f64") || text.contains("parry2d_f64");
    let known: BTreeSet<String> =
        sources().into_iter().filter(|(_, text)| knows(text)).map(|(path, _)| path).collect();
    assert!(known.len() > 5);
    let elsewhere: Vec<&String> =
        known.iter().filter(|path| !path.starts_with("engine/")).collect();
    assert!(elsewhere.is_empty(), "{elsewhere:?}");
}

#[test]
fn folders_hold_a_dozen_files() {
    let mut files: BTreeMap<String, usize> = BTreeMap::new();
    for path in sources().keys() {
        if let Some((folder, name)) = path.rsplit_once('/') {
            *files.entry(folder.to_owned()).or_default() += usize::from(name != "mod.rs");
        }
    }
    files.retain(|folder, files| *files > DOZEN && !FLAT.contains(&folder.as_str()));
    assert!(files.is_empty(), "these need floors: {files:?}");
}

/// Types of the same name are `Arguments` of commands, and sections of the file with what they become in a mechanism.
#[test]
fn a_name_means_one_type() {
    let mut types: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (path, text) in sources() {
        let words: Vec<&str> = text.split_whitespace().collect();
        for pair in words.windows(2).filter(|pair| ["struct", "enum", "trait"].contains(&pair[0])) {
            let name: String =
                pair[1].chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            types.entry(name).or_default().push(path.clone());
        }
    }
    assert!(types.len() > 500, "{}", types.len());
    let section = |path: &String| path.starts_with("scenario/sections/");
    types.retain(|name, paths| {
        let commands = name == "Arguments" && paths.iter().all(|path| path.starts_with("cli/"));
        let pair = paths.len() == 2 && paths.iter().filter(|path| section(path)).count() == 1;
        paths.len() > 1 && !commands && !pair
    });
    assert!(types.is_empty(), "{types:#?}");
}

#[test]
fn files_do_not_use_each_other_in_circles() {
    let sources = sources();
    let exported: BTreeMap<&String, _> =
        sources.iter().map(|(path, text)| (path, declared(path, text))).collect();
    // What a file uses, followed through the names that folders pass on.
    let mut uses: BTreeMap<&String, BTreeSet<&String>> = BTreeMap::new();
    for (path, text) in &sources {
        let own = uses.entry(path).or_default();
        for wanted in used(path, text) {
            let mut wanted = wanted;
            for _ in 0..8 {
                let Some((file, rest)) = file_of(&sources, &wanted) else { break };
                let passed = rest.first().and_then(|name| exported[file].get(name));
                match passed {
                    Some(on) => wanted = [on.as_slice(), &rest[1..]].concat(),
                    None => {
                        // A folder's own file names what is in it.
                        if file != path && !(passes_on(path, file)) {
                            own.insert(file);
                        }
                        break;
                    }
                }
            }
        }
    }
    assert!(uses.values().map(BTreeSet::len).sum::<usize>() > 1000);
    let mut circles = circles(&uses);
    circles.retain(|way| !ONE_CONCEPT.contains(&way[0].as_str()));
    assert!(circles.is_empty(), "{circles:#?}");
}

/// Runs of a sweep share a machine without clearance whose text is the same: that has to say all there is. What hears of
/// progress is no part of a machine.
#[test]
fn the_text_of_a_machine_hides_nothing() {
    let own =
        |(path, text): &(String, String)| text.contains("Debug for") && path != "study/watch.rs";
    let by_hand: Vec<_> = sources().into_iter().filter(own).map(|(path, _)| path).collect();
    assert!(by_hand.is_empty(), "derive Debug in {by_hand:?}");
}

/// Whether `path` is the `mod.rs` of a folder that `file` is in.
fn passes_on(path: &str, file: &str) -> bool {
    path.strip_suffix("mod.rs").is_some_and(|folder| file.starts_with(folder))
}

/// The file of the longest part of a path that is one, and what is left of the path.
fn file_of<'a>(
    sources: &'a BTreeMap<String, String>,
    wanted: &[String],
) -> Option<(&'a String, Vec<String>)> {
    (1..=wanted.len()).rev().find_map(|length| {
        let start = wanted[..length].join("/");
        let names = [format!("{start}.rs"), format!("{start}/mod.rs")];
        let (file, _) = names.iter().find_map(|name| sources.get_key_value(name))?;
        Some((file, wanted[length..].to_vec()))
    })
}

/// Files that come back to themselves, each with what it uses on the way.
fn circles<'a>(uses: &BTreeMap<&'a String, BTreeSet<&'a String>>) -> Vec<Vec<&'a String>> {
    // Files that nothing left uses, or that use nothing left, are in no circle.
    let mut left: BTreeSet<&String> = uses.keys().copied().collect();
    loop {
        let inner = |file: &&String| {
            let forth = uses[*file].iter().any(|other| left.contains(*other));
            let back = left.iter().any(|other| uses[*other].contains(*file));
            forth && back
        };
        let kept: BTreeSet<&String> = left.iter().copied().filter(inner).collect();
        if kept.len() == left.len() {
            break;
        }
        left = kept;
    }
    let way = |file: &'a String| {
        [file].into_iter().chain(uses[file].iter().copied().filter(|other| left.contains(*other)))
    };
    uses.keys()
        .copied()
        .filter(|file| left.contains(*file))
        .map(|file| way(file).collect())
        .collect()
}
