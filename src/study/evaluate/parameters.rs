//! Parameters of one run as other programs write them.

use crate::measure::bounded;
use crate::study::StudyError;
use serde_json::{Map, Value};
use std::path::Path;

/// Values of a scenario by their paths.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameters(Vec<[String; 2]>);

/// How a file may be written, for messages.
const FORMS: &str = "expected lines `PATH = VALUE`, a JSON object, or a parameters file of Dakota";

impl Parameters {
    /// Reads a file: lines `PATH = VALUE` (`#` begins a comment), one JSON object, or what Dakota writes in its
    /// standard format (`VALUE PATH` after a line `N variables`) or for APREPRO (`{ PATH = VALUE }` after
    /// `{ DAKOTA_VARS = N }`; what follows the N variables is Dakota's own and is not read).
    ///
    /// # Errors
    /// [`StudyError::Input`] with file and line.
    pub fn read(path: &Path) -> Result<Parameters, StudyError> {
        let wrong = |what: String| StudyError::Input(format!("{}{what}", path.display()));
        let text = bounded::text(path, bounded::SCENARIO)
            .map_err(|error| wrong(format!(": cannot be read: {error}")))?;
        let parameters = Self::parse(&text).map_err(|(line, what)| match line {
            0 => wrong(format!(": {what}; {FORMS}")),
            line => wrong(format!(":{line}: {what}; {FORMS}")),
        })?;
        match parameters.0.is_empty() {
            true => Err(wrong(format!(": holds no parameter; {FORMS}"))),
            false => Ok(parameters),
        }
    }

    /// As overrides of a scenario, `PATH=VALUE` each.
    pub fn sets(self) -> Vec<String> {
        self.0.into_iter().map(|[path, value]| format!("{path}={value}")).collect()
    }

    fn parse(text: &str) -> Result<Parameters, (usize, String)> {
        if let Ok(object) = serde_json::from_str::<Map<String, Value>>(text) {
            return of_json(object).map_err(|what| (0, what));
        }
        let mut lines = text.lines().map(without_comment).zip(1..);
        let mut lines = lines.by_ref().filter(|(line, _)| !line.is_empty()).peekable();
        let first = lines.peek().map_or("", |(line, _)| *line);
        let variables = count(first, "variables").or_else(|| {
            let [name, value] = assignment(first)?;
            (name == "DAKOTA_VARS").then(|| value.parse().ok())?
        });
        let Some(variables) = variables else {
            let parameters: Result<_, _> = lines
                .map(|(line, number)| assignment(line).ok_or((number, not_one(line))))
                .collect();
            return Ok(Parameters(parameters?));
        };
        let parameters: Vec<[String; 2]> = lines
            .skip(1)
            .take(variables)
            .map(|(line, number)| {
                assignment(line).or_else(|| tagged(line)).ok_or((number, not_one(line)))
            })
            .collect::<Result<_, _>>()?;
        match parameters.len() {
            there if there == variables => Ok(Parameters(parameters)),
            there => Err((0, format!("announces {variables} variables and has {there}"))),
        }
    }
}

fn not_one(line: &str) -> String {
    format!("`{line}` is no parameter")
}

fn without_comment(line: &str) -> &str {
    let line = line.trim();
    if line.starts_with('#') { "" } else { line }
}

/// `N WORD`
fn count(line: &str, word: &str) -> Option<usize> {
    let (number, rest) = line.split_once(char::is_whitespace)?;
    (rest.trim() == word).then(|| number.parse().ok())?
}

/// `PATH = VALUE`, in braces or not. APREPRO quotes texts as TOML does.
fn assignment(line: &str) -> Option<[String; 2]> {
    let inner = line.strip_prefix('{').and_then(|line| line.strip_suffix('}')).unwrap_or(line);
    let (path, value) = inner.split_once('=')?;
    let (path, value) = (path.trim(), value.trim());
    (!path.is_empty() && !value.is_empty()).then(|| [path.to_owned(), value.to_owned()])
}

/// `VALUE PATH`
fn tagged(line: &str) -> Option<[String; 2]> {
    let (value, path) = line.rsplit_once(char::is_whitespace)?;
    Some([path.to_owned(), value.trim().to_owned()])
}

fn of_json(object: Map<String, Value>) -> Result<Parameters, String> {
    let parameters = object.into_iter().map(|(path, value)| match value {
        Value::Null | Value::Object(_) => Err(format!("`{path}` is {value}, which is no value")),
        // Numbers, texts and lists of them are written alike in JSON and in TOML.
        value => Ok([path, value.to_string()]),
    });
    Ok(Parameters(parameters.collect::<Result<_, _>>()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sets(text: &str) -> Vec<String> {
        Parameters::parse(text).expect("right").sets()
    }

    #[test]
    fn every_form_says_the_same() {
        let expected = ["joints.clearance=1e-4", "drive.mode=servo"];
        let dakota = "                    2 variables\n  1e-4 joints.clearance\n servo drive.mode\n \
                      1 functions\n 1 ASV_1:force\n 2 derivative_variables\n 0 analysis_components\n 1 eval_id\n";
        let aprepro = "{ DAKOTA_VARS = 2 }\n{ joints.clearance = 1e-4 }\n{ drive.mode = servo }\n\
                       { DAKOTA_FNS = 1 }\n{ ASV_1:force = 1 }\n";
        for text in ["# mine\njoints.clearance = 1e-4\n\ndrive.mode=servo\n", dakota, aprepro] {
            assert_eq!(sets(text), expected, "{text}");
        }
        let json = r#"{"joints.clearance": 0.0001, "drive.mode": "servo", "g": [0, -9.81]}"#;
        assert_eq!(sets(json), ["joints.clearance=0.0001", "drive.mode=\"servo\"", "g=[0,-9.81]"]);
        assert_eq!(sets(""), [""; 0]);
    }

    #[test]
    fn what_is_no_parameter_is_refused_with_its_line() {
        for (text, line, fragment) in [
            ("a = 1\nb\n", 2, "`b` is no parameter"),
            ("a =\n", 1, "`a =` is no parameter"),
            ("3 variables\n1 a\n", 0, "announces 3 variables and has 1"),
            ("2 variables\n1 a\nb\n", 3, "`b` is no parameter"),
            (r#"{"a": null}"#, 0, "`a` is null"),
            (r#"{"a": {"b": 1}}"#, 0, "`a` is {"),
        ] {
            let (at, said) = Parameters::parse(text).expect_err(text);
            assert!(at == line && said.contains(fragment), "{text}: {at}: {said}");
        }
    }
}
