//! One self-contained HTML page: nothing is fetched, everything is inline.

use super::{Fact, Picture};
use crate::measure::shown::shown;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// Builds the page: headline, lead sentence, table of contents, table of facts, the pictures in the
/// given order, and where the numbers come from as (label, value) pairs.
///
/// All texts are escaped; the pictures' SVG goes in as it is.
///
/// ```
/// use freeplay::report::{Fact, page};
///
/// let fact = Fact { label: "Peak force".to_owned(), value: "12 N".to_owned(), note: String::new() };
/// let html = page("A run", "Forces < 20 N.", &[fact], &[], &[("seed".to_owned(), "1".to_owned())]);
/// assert!(html.contains("Forces &lt; 20 N.") && html.contains("12 N"));
/// ```
pub fn page(
    title: &str,
    lead: &str,
    facts: &[Fact],
    pictures: &[Picture],
    provenance: &[(String, String)],
) -> String {
    let parts =
        [PagePart::Facts(facts), PagePart::Pictures(pictures), PagePart::Provenance(provenance)];
    document(title, lead, &parts)
}

/// A part of a page.
///
/// [`document`] has an example.
#[derive(Debug)]
pub enum PagePart<'a> {
    /// The table of main results.
    Facts(&'a [Fact]),
    /// Any other table.
    Table(PageTable),
    /// Pictures, each with its heading and caption, numbered through the page.
    Pictures(&'a [Picture]),
    /// Paragraphs.
    Text {
        /// Where links find it.
        id: &'static str,
        /// Heading.
        title: &'a str,
        /// One text each.
        paragraphs: &'a [String],
    },
    /// A link to another page of the result, by itself.
    Link {
        /// The file beside this page.
        file: &'a str,
        /// What is there.
        text: &'a str,
    },
    /// Where the numbers come from, as (label, value) pairs.
    Provenance(&'a [(String, String)]),
}

/// A table with a heading and a remark. Without rows it is left out of its page, and so are columns in which no row has a
/// value.
///
/// [`document`] has an example.
#[derive(Clone, Debug)]
pub struct PageTable {
    /// Where links find it.
    pub id: &'static str,
    /// Heading.
    pub title: String,
    /// Heads of the columns.
    pub header: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
    /// What to know about it.
    pub note: String,
}

/// Builds a page of any parts: headline, lead sentence, table of contents, the parts in their order.
///
/// All texts are escaped; the pictures' SVG goes in as it is.
///
/// ```
/// use freeplay::report::{PagePart, PageTable, document};
///
/// let table = PageTable {
///     id: "joints",
///     title: "Joints".to_owned(),
///     header: vec!["joint".to_owned(), "force (N)".to_owned()],
///     rows: vec![vec!["A1".to_owned(), "12".to_owned()]],
///     note: String::new(),
/// };
/// let html = document("A run", "All of it.", &[PagePart::Table(table)]);
/// assert!(html.contains("id=\"joints\"") && html.contains("A1"));
/// ```
pub fn document(title: &str, lead: &str, parts: &[PagePart]) -> String {
    let title = escaped(title);
    let lead = escaped(lead);
    let contents = contents(parts);
    let sections: String = numbered(parts).map(|(first, part)| section(first, part)).collect();
    format!(
        "<!DOCTYPE html>\n\
         <html lang=\"en\">\n\
         <head>\n\
         <meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n\
         <style>\n{STYLE}</style>\n\
         </head>\n\
         <body>\n\
         <header>\n<h1>{title}</h1>\n<p class=\"lead\">{lead}</p>\n</header>\n\
         {contents}<main>\n{sections}</main>\n\
         <script>\n{SCRIPT}</script>\n\
         </body>\n\
         </html>\n"
    )
}

/// Parts, each with the number that its first picture has.
fn numbered<'a>(parts: &'a [PagePart<'a>]) -> impl Iterator<Item = (usize, &'a PagePart<'a>)> {
    parts.iter().scan(1, |next, part| {
        let first = *next;
        if let PagePart::Pictures(pictures) = part {
            *next += pictures.len();
        }
        Some((first, part))
    })
}

fn section(first: usize, part: &PagePart) -> String {
    match part {
        PagePart::Facts(facts) => facts_section(facts),
        PagePart::Table(table) if table.rows.is_empty() => String::new(),
        PagePart::Table(table) => table_section(table),
        PagePart::Pictures(pictures) => {
            (first..).zip(*pictures).map(|(n, p)| figure(n, p)).collect()
        }
        PagePart::Text { id, title, paragraphs } => text_section(id, title, paragraphs),
        PagePart::Link { file, text } => {
            format!("<p><a href=\"{}\">{}</a></p>\n", escaped(file), escaped(text))
        }
        PagePart::Provenance(provenance) => provenance_section(provenance),
    }
}

fn contents(parts: &[PagePart]) -> String {
    let mut entries = String::new();
    let mut entry = |id: &str, text: &str| {
        entries += &format!("<li><a href=\"#{id}\">{text}</a></li>\n");
    };
    for (first, part) in numbered(parts) {
        match part {
            PagePart::Facts([]) | PagePart::Provenance([]) | PagePart::Link { .. } => {}
            PagePart::Table(table) if table.rows.is_empty() => {}
            PagePart::Facts(_) => entry("facts", "Results"),
            PagePart::Table(table) => entry(table.id, &escaped(&table.title)),
            PagePart::Pictures(pictures) => {
                for (n, picture) in (first..).zip(*pictures) {
                    entry(&format!("figure-{n}"), &escaped(&picture.title));
                }
            }
            PagePart::Text { id, title, .. } => entry(id, &escaped(title)),
            PagePart::Provenance(_) => entry("provenance", "Provenance"),
        }
    }
    format!("<nav aria-label=\"Contents\">\n<ul>\n{entries}</ul>\n</nav>\n")
}

fn facts_section(facts: &[Fact]) -> String {
    if facts.is_empty() {
        return String::new();
    }
    let row = |fact: &Fact| {
        format!(
            "<tr><th scope=\"row\">{}</th><td class=\"value\">{}</td><td class=\"note\">{}</td></tr>\n",
            escaped(&fact.label),
            escaped(&fact.value),
            escaped(&fact.note)
        )
    };
    let rows: String = facts.iter().map(row).collect();
    format!(
        "<section id=\"facts\">\n<h2>Results</h2>\n<div class=\"table\"><table>\n{rows}</table></div>\n\
         </section>\n"
    )
}

fn table_section(table: &PageTable) -> String {
    let has_values = |column: &usize| {
        let cells = table.rows.iter().filter_map(|row| row.get(*column));
        cells.into_iter().any(|cell| !matches!(cell.as_str(), "" | "–"))
    };
    let columns: Vec<usize> = (0..table.header.len()).filter(has_values).collect();
    let head = |column: usize| escaped(&table.header[column]);
    let heads: String =
        columns.iter().map(|&column| format!("<th>{}</th>", head(column))).collect();
    // On a phone each row is a list, and its cells say their heads themselves.
    let row = |row: &Vec<String>| {
        let cell = |&column: &usize| {
            let text = row.get(column).map_or_else(String::new, |text| escaped(text));
            format!("<td data-head=\"{}\">{text}</td>", head(column))
        };
        format!("<tr>{}</tr>\n", columns.iter().map(cell).collect::<String>())
    };
    let rows: String = table.rows.iter().map(row).collect();
    format!(
        "<section id=\"{}\">\n<h2>{}</h2>\n<div class=\"table\"><table class=\"rows\">\n\
         <tr class=\"heads\">{heads}</tr>\n{rows}</table></div>\n<p class=\"note\">{}</p>\n</section>\n",
        table.id,
        escaped(&table.title),
        escaped(&table.note)
    )
}

fn text_section(id: &str, title: &str, paragraphs: &[String]) -> String {
    let paragraphs: String =
        paragraphs.iter().map(|text| format!("<p>{}</p>\n", escaped(text))).collect();
    format!("<section id=\"{id}\">\n<h2>{}</h2>\n{paragraphs}</section>\n", escaped(title))
}

fn figure(n: usize, picture: &Picture) -> String {
    let title = escaped(&picture.title);
    format!(
        "<section id=\"figure-{n}\">\n<h2>{title}</h2>\n<figure>\n\
         <div class=\"card\" role=\"img\" aria-label=\"{title}\">\n{}</div>\n\
         <figcaption><b>Figure {n}.</b> {} <code>{}</code></figcaption>\n</figure>\n</section>\n",
        picture.svg,
        escaped(&picture.caption),
        escaped(&picture.file)
    )
}

fn provenance_section(provenance: &[(String, String)]) -> String {
    if provenance.is_empty() {
        return String::new();
    }
    let row = |(label, value): &(String, String)| {
        let (label, value) = (escaped(label), escaped(value));
        format!("<tr><th scope=\"row\">{label}</th><td><code>{value}</code></td></tr>\n")
    };
    let rows: String = provenance.iter().map(row).collect();
    format!(
        "<section id=\"provenance\">\n<h2>Provenance</h2>\n<div class=\"table\"><table>\n{rows}</table>\
         </div>\n</section>\n"
    )
}

/// `text` with everything that HTML would read as markup written as entities, and nothing hidden in it.
pub(super) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in shown(text).chars() {
        match c {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\'' => escaped += "&#39;",
            _ => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    const MARKUP: &str = "<script>alert('a') & \"b\"</script>";

    fn picture(svg: String) -> Picture {
        Picture {
            file: MARKUP.to_owned(),
            title: MARKUP.to_owned(),
            caption: MARKUP.to_owned(),
            svg,
        }
    }

    fn sample() -> String {
        let fact =
            Fact { label: MARKUP.to_owned(), value: MARKUP.to_owned(), note: MARKUP.to_owned() };
        let orbits = super::super::orbits_svg(&[]).unwrap();
        let pictures = [picture(orbits), picture("<svg>second</svg>".to_owned())];
        let provenance = [(MARKUP.to_owned(), MARKUP.to_owned())];
        page(MARKUP, MARKUP, &[fact], &pictures, &provenance)
    }

    #[test]
    fn all_text_is_escaped() {
        let html = sample();
        assert!(!html.contains("<script>alert"));
        assert_eq!(
            html.matches("&lt;script&gt;alert(&#39;a&#39;) &amp; &quot;b&quot;").count(),
            18
        );
    }

    #[test]
    fn every_picture_is_in_the_page_and_in_its_contents() {
        let html = sample();
        assert!(html.contains("no data") && html.contains("<svg>second</svg>"));
        for id in ["facts", "figure-1", "figure-2", "provenance"] {
            assert!(html.contains(&format!("href=\"#{id}\"")));
            assert!(html.contains(&format!("id=\"{id}\"")));
        }
    }

    #[test]
    fn nothing_is_fetched() {
        let html = sample().replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
        for fetch in ["http", "src=", "url(", "@import", "<link"] {
            assert!(!html.contains(fetch), "{fetch}");
        }
    }

    #[test]
    fn what_a_table_does_not_know_is_left_out_of_it() {
        let table = |rows: &[[&str; 3]]| PageTable {
            id: "t",
            title: "Errors".to_owned(),
            header: ["channel", "before", "after"].map(str::to_owned).into(),
            rows: rows.iter().map(|row| row.map(str::to_owned).into()).collect(),
            note: "A note.".to_owned(),
        };
        let known = table(&[["x", "–", "1 mm"], ["y", "", "–"]]);
        let html = document("T", "", &[PagePart::Table(known)]);
        assert!(html.contains("<th>channel</th><th>after</th>"), "{html}");
        assert!(html.contains("<td data-head=\"after\">1 mm</td>") && !html.contains("before<"));
        let none = document("T", "", &[PagePart::Table(table(&[]))]);
        assert!(!none.contains("Errors") && !none.contains("A note."), "{none}");
    }

    #[test]
    fn a_page_without_content_is_still_a_page() {
        let html = page("Nothing", "", &[], &[], &[]);
        assert!(html.starts_with("<!DOCTYPE html>") && html.ends_with("</html>\n"));
        assert!(!html.contains("<table>"));
    }
}
