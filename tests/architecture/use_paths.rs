//! Paths of modules in Rust source.

use std::collections::BTreeMap;

/// Paths inside the crate that a file uses, in `use` items and elsewhere; from the crate's root on.
pub fn used(path: &str, text: &str) -> Vec<Vec<String>> {
    let items = items(text);
    let mut found: Vec<Vec<String>> =
        items.iter().filter_map(|(_, path_of)| absolute(path, path_of)).collect();
    // Paths in the text: `crate::a::b`, `super::b`.
    for start in ["crate::", "super::"] {
        for (at, _) in text.match_indices(start) {
            let before = text[..at].chars().next_back().unwrap_or(' ');
            if before.is_alphanumeric() || before == ':' || before == '_' {
                continue;
            }
            let word: String = text[at..]
                .chars()
                .take_while(|c| c.is_alphanumeric() || "_:".contains(*c))
                .collect();
            found.extend(absolute(path, word.trim_end_matches(':')));
        }
    }
    found
}

/// Names that a file passes on (`pub use`), each with where it is from.
pub fn declared(path: &str, text: &str) -> BTreeMap<String, Vec<String>> {
    let items = items(text).into_iter().filter(|(public, _)| *public);
    let named = items.filter_map(|(_, path_of)| {
        let name = path_of.rsplit([':', ' ']).next()?.to_owned();
        Some((name, absolute(path, &path_of)?))
    });
    named.collect()
}

/// Each single path of the `use` items of a text, and whether the item is public.
fn items(text: &str) -> Vec<(bool, String)> {
    let mut found = Vec::new();
    for (at, _) in text.match_indices("use ") {
        let line = &text[text[..at].rfind('\n').map_or(0, |end| end + 1)..at];
        let public = line.trim_start().starts_with("pub");
        if !public && !line.trim().is_empty() {
            continue;
        }
        if let Some(item) = text[at + 4..].split(';').next() {
            let item = item.split_whitespace().collect::<Vec<_>>().join(" ");
            found.extend(single(&item).into_iter().map(|path| (public, path)));
        }
    }
    found
}

/// `a::{b, c::d}` as `a::b` and `a::c::d`.
fn single(tree: &str) -> Vec<String> {
    let Some((start, rest)) = tree.split_once('{') else { return vec![tree.trim().to_owned()] };
    let inner = rest.rsplit_once('}').map_or(rest, |(inner, _)| inner);
    let (mut parts, mut depth) = (vec![String::new()], 0);
    for c in inner.chars() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        parts.last_mut().unwrap().push(c);
    }
    let parts = parts.iter().map(|part| part.trim()).filter(|part| !part.is_empty());
    parts.flat_map(|part| single(&format!("{}{part}", start.trim()))).collect()
}

/// A path of a file from the crate's root on; none of other crates, and of what is in the file itself.
fn absolute(path: &str, path_of: &str) -> Option<Vec<String>> {
    let path_of = path_of.split(" as ").next()?;
    let mut words = path_of.split("::").map(str::to_owned).peekable();
    let own = path.strip_suffix("/mod.rs").or_else(|| path.strip_suffix(".rs"))?;
    let mut from: Vec<String> = own.split('/').map(str::to_owned).collect();
    match words.peek()?.as_str() {
        "crate" => {
            from.clear();
            words.next();
        }
        "self" => {
            words.next();
        }
        "super" => {
            while words.peek().is_some_and(|word| word == "super") {
                from.pop();
                words.next();
            }
        }
        // A module below this file, if there is one of that name; the caller finds nothing else.
        word if word.chars().next().is_some_and(char::is_lowercase) && path.ends_with("mod.rs") => {
        }
        _ => return None,
    }
    from.extend(words.filter(|word| word != "self"));
    Some(from)
}
