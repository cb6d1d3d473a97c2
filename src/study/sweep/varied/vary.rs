//! One `--vary PATH=…`: which key of the scenario, and which values it takes.

use crate::study::StudyError;
use std::fmt;

/// How all of it is written, for messages.
const FORMS: &str = "write PATH=a,b,c or PATH=lo..hi:N, lo..hi:log:N, lo..hi:random:N";

/// A key of the scenario and its values.
///
/// ```
/// use freeplay::study::sweep::Vary;
///
/// let vary = Vary::parse("joints.clearance=1e-6..1e-4:log:3")?;
/// assert_eq!((vary.path.as_str(), vary.count(), vary.is_random()), ("joints.clearance", 3, false));
/// assert_eq!(vary.value(1).parse::<f64>(), Ok(1e-5));
/// # Ok::<(), freeplay::study::StudyError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Vary {
    /// Dotted path of the key.
    pub path: String,
    /// What it takes.
    pub values: Values,
}

/// The values of a varied key.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// These, as TOML.
    List(Vec<String>),
    /// Numbers between two ends.
    Range(Range),
}

/// Numbers between two ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// The smaller end, which is reached unless the numbers are random.
    pub low: f64,
    /// The larger end, which is reached unless the numbers are random.
    pub high: f64,
    /// Spaced evenly in the logarithm.
    pub log: bool,
    /// Drawn, jointly with all other random keys.
    pub random: bool,
    /// How many.
    pub count: usize,
}

impl Vary {
    /// Reads `PATH=…`. Whether the scenario has such a key and takes such values is not known here.
    ///
    /// # Errors
    /// [`StudyError::Input`] that says what is wrong and what would be right.
    pub fn parse(text: &str) -> Result<Vary, StudyError> {
        let (path, values) = text.split_once('=').unwrap_or((text, ""));
        let (path, values) = (path.trim(), values.trim());
        let refuse = |what: String| StudyError::input(format!("--vary {text}: {what}; {FORMS}"));
        if path.is_empty() || values.is_empty() {
            return Err(refuse("has no values or no path".to_owned()));
        }
        let elements = split(values);
        let values = match elements.as_slice() {
            [element] if is_range(element) => Values::Range(Range::parse(element).map_err(refuse)?),
            _ => {
                let values = elements.iter().map(|e| value(e)).collect::<Result<Vec<_>, _>>();
                Values::List(values.and_then(each_once).map_err(refuse)?)
            }
        };
        Ok(Vary { path: path.to_owned(), values })
    }

    /// Whether the values are part of the joint random sample.
    pub fn is_random(&self) -> bool {
        matches!(&self.values, Values::Range(range) if range.random)
    }

    /// How many values there are.
    pub fn count(&self) -> usize {
        match &self.values {
            Values::List(values) => values.len(),
            Values::Range(range) => range.count,
        }
    }

    /// Value `k`, as TOML; of a random key, the one at `k`/count of its range.
    pub fn value(&self, k: usize) -> String {
        match &self.values {
            Values::List(values) => values[k].clone(),
            // One value has no distance to the next; `parse` allows that for random keys only.
            Values::Range(range) => range.at(k as f64 / (range.count - 1).max(1) as f64),
        }
    }
}

/// The values of a list, none of which may stand there twice: equal runs say nothing new.
fn each_once(values: Vec<String>) -> Result<Vec<String>, String> {
    let again = |(i, value): &(usize, &String)| values[..*i].contains(value);
    match values.iter().enumerate().find(again) {
        Some((_, value)) => Err(format!("`{value}` stands there twice: give each value once")),
        None => Ok(values),
    }
}

/// The canonical spelling: two that mean the same read the same.
impl fmt::Display for Vary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.values {
            Values::List(values) => write!(f, "{}={}", self.path, values.join(",")),
            Values::Range(range) => {
                let (low, high) = (number(range.low), number(range.high));
                let log = if range.log { ":log" } else { "" };
                let random = if range.random { ":random" } else { "" };
                write!(f, "{}={low}..{high}{log}{random}:{}", self.path, range.count)
            }
        }
    }
}

impl Range {
    fn parse(text: &str) -> Result<Range, String> {
        let (ends, spacing) = text.split_once(':').unwrap_or((text, ""));
        let (low, high) = ends.split_once("..").unwrap_or((ends, ""));
        let end = |text: &str| match text.trim().parse::<f64>() {
            Ok(end) if end.is_finite() => Ok(end),
            _ => Err(format!(
                "`{text}` is no end of a range (text that contains `..` goes in quotes)"
            )),
        };
        let (low, high) = (end(low)?, end(high)?);
        let (words, count) = spacing.rsplit_once(':').unwrap_or(("", spacing));
        let (log, random) = match words.trim() {
            "" => (false, false),
            "log" => (true, false),
            "random" => (false, true),
            "log:random" => (true, true),
            other => return Err(format!("`{other}` is no way to space a range")),
        };
        let count: usize =
            count.trim().parse().map_err(|_| format!("`{count}` is no number of values"))?;
        let least = if random { 1 } else { 2 };
        if count < least {
            return Err(format!(
                "a range of {count} values is empty or a single value: expected at least {least}"
            ));
        }
        if low >= high {
            return Err(format!(
                "the range {}..{} is empty: expected the smaller end first",
                number(low),
                number(high)
            ));
        }
        if log && low <= 0.0 {
            return Err(format!(
                "a logarithmic range cannot begin at {}: expected above 0",
                number(low)
            ));
        }
        Ok(Range { low, high, log, random, count })
    }

    /// The number at `fraction` of the way from end to end, as TOML.
    pub fn at(&self, fraction: f64) -> String {
        // The ends as they were given, not as rounding leaves them.
        let value = match fraction {
            0.0 => self.low,
            1.0 => self.high,
            _ if self.log => self.low * (fraction * (self.high / self.low).ln()).exp(),
            _ => self.low + fraction * (self.high - self.low),
        };
        // Fifteen digits: 0.3 for 0.30000000000000004, and the same value whatever the last digit of
        // this platform's logarithm.
        number(format!("{value:.14e}").parse().unwrap_or(value))
    }
}

/// A number as the shortest TOML that reads back as it. Whole ones without a point, which keys that
/// want a whole number (`seed`) insist on and others do not mind.
fn number(value: f64) -> String {
    // −0 is 0, and reads back as that.
    let value = value + 0.0;
    if value == value.trunc() && value.abs() < 1e15 {
        format!("{value}")
    } else {
        format!("{value:?}")
    }
}

fn is_range(element: &str) -> bool {
    element.contains("..") && !element.starts_with(['"', '\'', '['])
}

/// An element of a list as TOML, numbers in their canonical spelling.
fn value(element: &str) -> Result<String, String> {
    if element.is_empty() {
        return Err("the list has an empty element".to_owned());
    }
    if is_range(element) {
        return Err(format!(
            "`{element}` is a range within a list (text that contains `..` goes in quotes)"
        ));
    }
    // Whole numbers first: a seed may have more digits than a float holds.
    if let Ok(whole) = element.parse::<i64>() {
        return Ok(whole.to_string());
    }
    Ok(match element.parse::<f64>() {
        Ok(float) if float.is_finite() => number(float),
        _ => element.to_owned(),
    })
}

/// Splits at commas that are not within brackets or quotes.
fn split(text: &str) -> Vec<&str> {
    let (mut elements, mut start, mut depth, mut quote) = (Vec::new(), 0, 0, None);
    for (i, c) in text.char_indices() {
        match (quote, c) {
            (Some(open), _) if c == open => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(c),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth -= 1,
            (None, ',') if depth == 0 => {
                elements.push(text[start..i].trim());
                start = i + 1;
            }
            _ => {}
        }
    }
    elements.push(text[start..].trim());
    elements
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        let vary = Vary::parse(text).expect("right");
        (0..vary.count()).map(|k| vary.value(k)).collect()
    }

    #[test]
    fn lists_and_ranges() {
        assert_eq!(values("a.b=1e-4, 0.50,3"), ["0.0001", "0.5", "3"]);
        assert_eq!(values("g=[0,-9.81],[0,0]"), ["[0,-9.81]", "[0,0]"]);
        assert_eq!(values("f=\"../a,b.csv\",x"), ["\"../a,b.csv\"", "x"]);
        assert_eq!(values("s=9007199254740993"), ["9007199254740993"]);
        assert_eq!(values("a=0..0.4:5"), ["0", "0.1", "0.2", "0.3", "0.4"]);
        assert_eq!(
            values("a=1e-8..1e-3:log:6"),
            ["1e-8", "1e-7", "1e-6", "1e-5", "0.0001", "0.001"]
        );
        assert_eq!(values("seed=1..4:4"), ["1", "2", "3", "4"]);
    }

    #[test]
    fn mistakes_say_what_would_be_right() {
        for (text, fragment) in [
            ("joints.clearance", "no values"),
            ("=1", "no path"),
            ("a=1,,2", "empty element"),
            ("a=1e-4,0.0001", "stands there twice"),
            ("a=1..2", "`` is no number of values"),
            ("a=1..2:0", "at least 2"),
            ("a=1..2:1", "at least 2"),
            ("a=1..2:random:0", "at least 1"),
            ("a=1..2:-3", "`-3` is no number of values"),
            ("a=2..1:3", "smaller end first"),
            ("a=1..1:3", "smaller end first"),
            ("a=0..1:log:3", "above 0"),
            ("a=..1:3", "`` is no end of a range"),
            ("a=1..x:3", "`x` is no end"),
            ("a=1..inf:3", "`inf` is no end"),
            ("a=1..2:cubic:3", "`cubic` is no way"),
            ("a=1..2:3,5", "range within a list"),
        ] {
            let said = Vary::parse(text).expect_err(text).to_string();
            assert!(said.contains(fragment) && said.contains("PATH=lo..hi:N"), "{text}: {said}");
        }
    }

    #[test]
    fn the_canonical_spelling_reads_back() {
        for text in ["a=0.0001,x", "a=1e-8..0.001:log:6", "a=1..2:log:random:7", "a=-1..1:random:1"]
        {
            assert_eq!(Vary::parse(text).expect("right").to_string(), text);
        }
        for zero in ["a=-0", "a=-0.0"] {
            assert_eq!(values(zero), ["0"]);
        }
    }
}
