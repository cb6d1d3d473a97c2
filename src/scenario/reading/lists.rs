//! Sections and lists of sections: `[section]` or `[[section]]`, so many at most, each of its kind.

use super::reader::Reader;
use serde::Deserialize;
use toml::Table;

/// `[section]` or `[[section]]`.
#[derive(Deserialize)]
#[serde(untagged, expecting = "a section with keys, or a list of them")]
pub(super) enum OneOrMany {
    One(Table),
    Many(Vec<Table>),
}

/// `[[section]]`, a list; a single `[section]` is kept to be complained about.
#[derive(Deserialize, Default)]
#[serde(from = "OneOrMany")]
pub(super) struct Many {
    pub tables: Vec<Table>,
    pub single: bool,
}

impl From<OneOrMany> for Many {
    fn from(section: OneOrMany) -> Self {
        match section {
            OneOrMany::One(table) => Many { tables: vec![table], single: true },
            OneOrMany::Many(tables) => Many { tables, single: false },
        }
    }
}

impl Many {
    pub fn is_empty(&self) -> bool {
        self.tables.is_empty()
    }

    /// The tables, after a complaint if there is one without a list around it.
    pub fn take(&mut self, reader: &mut Reader<'_>, section: &str) -> Vec<Table> {
        if self.single {
            let help = match section {
                "joint" => {
                    "did you mean `joints`? A machine that describes itself lists them by [[joint]]"
                        .to_owned()
                }
                _ => format!("write [[{section}]], once for each"),
            };
            reader.complain(section, "is one section, not a list".to_owned(), help);
            return Vec::new();
        }
        few(reader, section, std::mem::take(&mut self.tables))
    }
}

/// Most bodies, and most of any other list: equations are solved for all bodies at once, and to look at the motion of
/// fifty takes some ten seconds.
const MOST_BODIES: usize = 50;
const MOST_OTHERS: usize = 300;

/// The tables of a list, after a complaint and none of them if they are too many.
pub(super) fn few(reader: &mut Reader<'_>, section: &str, tables: Vec<Table>) -> Vec<Table> {
    let most = if section == "body" { MOST_BODIES } else { MOST_OTHERS };
    if tables.len() <= most {
        return tables;
    }
    let message = format!("is a list of {}", tables.len());
    reader.complain(section, message, format!("expected at most {most} of them"));
    Vec::new()
}

/// Reads every table of a list.
pub(super) fn each<T>(
    reader: &mut Reader<'_>,
    section: &str,
    tables: Vec<Table>,
    mut one: impl FnMut(&mut Reader<'_>, &str, Table) -> Option<T>,
) -> Vec<T> {
    let tables = tables.into_iter().enumerate();
    tables.filter_map(|(i, table)| one(reader, &format!("{section}.{i}"), table)).collect()
}

/// Takes the kind of a list's table; complains where it is missing or unknown.
pub(super) fn kind(
    reader: &mut Reader<'_>,
    path: &str,
    table: &mut Table,
    known: &[&'static str],
    what: &str,
) -> Option<&'static str> {
    if !table.contains_key("kind") {
        let help = format!("write kind = \"{}\", or {}", known[0], known[1..].join(", "));
        reader.complain(&format!("{path}.kind"), "is missing".to_owned(), help);
        return None;
    }
    reader.take_kind_of(path, what, table, known)
}
