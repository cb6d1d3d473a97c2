//! Text from files as it may be shown: on a terminal, on a page, in a picture.

use std::borrow::Cow;
use std::fmt::Write as _;

/// Whether a character does something to what shows it: moves the cursor, changes colours, hides or turns around the
/// text beside it.
pub fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

/// `text` with such characters as the numbers that JSON writes for them; line breaks and tabs stay. JSON means the same
/// afterwards.
///
/// ```
/// use freeplay::measure::shown::shown;
///
/// assert_eq!(shown("two\nlines"), "two\nlines");
/// assert_eq!(shown("red \u{1b}[31m"), "red \\u001b[31m", "no text of a file colours a terminal");
/// ```
pub fn shown(text: &str) -> Cow<'_, str> {
    let acts = |c: char| is_hidden(c) && !matches!(c, '\n' | '\t');
    if !text.contains(acts) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if acts(c) {
            // Writing to a string cannot fail.
            let _ = write!(shown, "\\u{:04x}", u32::from(c));
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_acts_on_a_terminal() {
        assert_eq!(shown("kä<b>\n\t’"), "kä<b>\n\t’");
        assert_eq!(shown("\u{1b}[31m\r\u{9b}2J\u{7f}"), "\\u001b[31m\\u000d\\u009b2J\\u007f");
        assert_eq!(shown("a\u{202e}b\u{2066}"), "a\\u202eb\\u2066");
        let json = serde_json::to_string("a\u{9b}\u{202e}").expect("JSON");
        let again: String = serde_json::from_str(&shown(&json)).expect("JSON");
        assert_eq!(again, "a\u{9b}\u{202e}");
    }
}
