//! Tables and paragraphs that fit the terminal: cells and lines are wrapped by words.

use comfy_table::presets::NOTHING;
use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, Table, Width};
use std::io::{IsTerminal, stderr, stdout};
use unicode_width::UnicodeWidthStr;

/// Columns of text where nobody says how wide the reader's window is: what terminals have had since punched cards.
const USUAL: usize = 80;

/// Narrower than this a table is one letter a line, and wider than this a line is hard to follow to the next.
const WIDTHS: std::ops::RangeInclusive<usize> = 40..=120;

/// Between columns.
const PADDING: usize = 2;

/// Longest number with its unit.
const LONGEST_NUMBER: usize = 14;

/// A space at which no line ends.
const FIXED: &str = "\u{a0}";

/// Columns of text that fit a line of standard output: $COLUMNS where it is a number, then the terminal's.
pub(super) fn width() -> usize {
    let asked = std::env::var("COLUMNS").ok().and_then(|text| text.parse().ok());
    let terminal = || {
        let size = stdout().is_terminal().then(terminal_size::terminal_size).flatten();
        size.map(|(terminal_size::Width(width), _)| usize::from(width))
    };
    asked.or_else(terminal).unwrap_or(USUAL).clamp(*WIDTHS.start(), *WIDTHS.end())
}

/// A table with heads; `sides` says of each column whether it stands left (`l`: words) or right (`r`: numbers). It is
/// indented by two, as results are.
pub(in crate::cli) fn table<const N: usize>(
    sides: &str,
    heads: [&str; N],
    rows: impl IntoIterator<Item = [String; N]>,
) -> String {
    of_width(width(), sides, &heads, rows.into_iter().map(Vec::from))
}

/// The same of any number of columns: the first one of words, the others of numbers.
pub(in crate::cli) fn words_and_numbers(heads: &[String], rows: &[Vec<String>]) -> String {
    let sides = format!("l{}", "r".repeat(heads.len().saturating_sub(1)));
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    of_width(width(), &sides, &heads, rows.iter().cloned())
}

fn of_width(
    width: usize,
    sides: &str,
    heads: &[&str],
    rows: impl Iterator<Item = Vec<String>>,
) -> String {
    let mut table = Table::new();
    table.load_preset(NOTHING).set_content_arrangement(ContentArrangement::Dynamic);
    table.set_width(u16::try_from(width).unwrap_or(u16::MAX));
    // A number stays with its unit, if it is one.
    let is_number = |i: usize, cell: &str| {
        sides.chars().nth(i) == Some('r') && cell.chars().count() <= LONGEST_NUMBER
    };
    let whole = |(i, cell): (usize, String)| {
        if is_number(i, &cell) { cell.replace(' ', FIXED) } else { cell }
    };
    let rows: Vec<Vec<String>> =
        rows.map(|row| row.into_iter().enumerate().map(whole).collect()).collect();
    let longest = |i: usize| {
        let cells = rows.iter().filter_map(|row| row.get(i)).map(String::as_str);
        let words = cells.chain(heads.get(i).copied()).flat_map(|cell| cell.split(' '));
        words.map(UnicodeWidthStr::width).max().unwrap_or(0) + PADDING
    };
    let least: Vec<usize> = (0..heads.len()).map(longest).collect();
    if least.iter().sum::<usize>() > width {
        return blocks(width, heads, &rows);
    }
    table.set_header(heads);
    table.add_rows(rows);
    for ((column, side), least) in table.column_iter_mut().zip(sides.chars()).zip(least) {
        column.set_padding((PADDING as u16, 0));
        // No word is broken.
        let least = u16::try_from(least).unwrap_or(u16::MAX);
        column.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(least)));
        if side == 'r' {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let lines = table.lines().map(|line| line.replace(FIXED, " ").trim_end().to_owned() + "\n");
    lines.collect()
}

/// A table whose words do not fit side by side: its rows one below the other, each cell after its head.
fn blocks(width: usize, heads: &[&str], rows: &[Vec<String>]) -> String {
    let row = |row: &Vec<String>| {
        let (first, others) = (row.first(), heads.iter().zip(row).skip(1));
        let first = first.map(|first| filled(width, "  ", "  ", first)).unwrap_or_default();
        let others = others.filter(|(_, cell)| !cell.trim().is_empty());
        let line = |(head, cell): (&&str, &String)| {
            let named = if head.is_empty() { cell.clone() } else { format!("{head}: {cell}") };
            filled(width, "    ", "      ", &named)
        };
        first + &others.map(line).collect::<String>()
    };
    rows.iter().map(row).collect()
}

/// Lines as they fit the terminal that standard error is, wrapped by words; none where it is no terminal.
pub(super) fn for_stderr(text: &str) -> Option<String> {
    let (terminal_size::Width(columns), _) = terminal_size::terminal_size_of(stderr())?;
    stderr().is_terminal().then(|| wrapped(text, usize::from(columns)))
}

/// Lines no longer than `columns`, as far as words allow; what goes on below a line is indented.
fn wrapped(text: &str, columns: usize) -> String {
    let options = textwrap::Options::new(columns.max(*WIDTHS.start()))
        .subsequent_indent("  ")
        .break_words(false)
        .word_splitter(textwrap::WordSplitter::NoHyphenation);
    let lines = text.lines().flat_map(|line| textwrap::wrap(line, &options));
    lines.map(|line| line.trim_end().to_owned()).collect::<Vec<_>>().join("\n")
}

/// Words after `first`, lines after the first one after `next`.
pub(in crate::cli) fn paragraph(first: &str, next: &str, words: &str) -> String {
    filled(width(), first, next, words)
}

fn filled(width: usize, first: &str, next: &str, words: &str) -> String {
    let options = textwrap::Options::new(width)
        .initial_indent(first)
        .subsequent_indent(next)
        .break_words(false)
        .word_splitter(textwrap::WordSplitter::NoHyphenation);
    let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
    textwrap::wrap(&words, options).iter().map(|line| line.trim_end().to_owned() + "\n").collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_wrapped_by_words_where_they_do_not_fit() {
        let words = "a claim that is far too long for the column that it stands in";
        let rows = [vec![words.to_owned(), "1.5 µm".to_owned()], vec!["short".into(), "2".into()]];
        let text = of_width(40, "lr", &["claim", "value"], rows.into_iter());
        assert!(text.lines().all(|line| line.width() <= 40), "{text}");
        let said: Vec<&str> = text.split_whitespace().collect();
        for word in words.split(' ') {
            assert!(said.contains(&word), "{word} is broken:\n{text}");
        }
        // Numbers stand below each other at the right.
        let ends = |needle: &str| {
            let line = text.lines().find(|line| line.ends_with(needle));
            line.map(UnicodeWidthStr::width)
        };
        assert_eq!(ends("value"), ends("1.5 µm"));
        assert_eq!(ends(" 2"), ends("value"));
    }

    #[test]
    fn rows_whose_words_do_not_fit_side_by_side_stand_below_each_other() {
        let heads = ["machine", "explained-by-itself", "explained-by-others", "misunderstood", ""];
        let row = ["six-bar", "3.5 % to 4.5 %", "", "1.5 µm", "too long"].map(str::to_owned);
        let text = of_width(40, "lrrrl", &heads, [row.to_vec()].into_iter());
        let expected = "  six-bar\n    explained-by-itself: 3.5 % to 4.5 %\n    misunderstood: 1.5 µm\n    too long\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn complaints_are_wrapped_by_words_and_lose_none() {
        let text = "error: --set joints.clearance: is -1 m at A1, A2 and A3; expected a radial clearance above 0 m";
        let said = wrapped(&format!("{text}\n{text}"), 40);
        assert!(said.lines().all(|line| line.width() <= 40), "{said}");
        assert_eq!(said.lines().filter(|line| line.starts_with("error: ")).count(), 2, "{said}");
        let words: Vec<&str> = said.split_whitespace().collect();
        assert_eq!(words.join(" "), format!("{text} {text}"));
    }
}
