//! Values of Python as values of TOML, and back.

use crate::error::Failure;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyMapping, PyString, PyTuple};
use toml::{Table, Value};

/// Most levels of lists and dicts in each other: a scenario has four.
const DEEPEST: usize = 32;

/// The TOML of a value; `path` says where it stands.
///
/// # Errors
/// What TOML has no value for, with its path: None, numbers beyond 64 bits, other objects.
pub fn to_toml(path: &str, value: &Bound<'_, PyAny>) -> Result<Value, Failure> {
    convert(path, value, 0)
}

fn convert(path: &str, value: &Bound<'_, PyAny>, depth: usize) -> Result<Value, Failure> {
    let wrong = |what: &str| Failure::Input(format!("{path}: {what}"));
    if depth > DEEPEST {
        return Err(wrong("lists and dicts in each other without end"));
    }
    if value.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(value.extract()?));
    }
    if value.is_instance_of::<PyInt>() {
        let whole = value.extract::<i64>();
        return whole.map(Value::Integer).map_err(|_| wrong("is beyond the range of 64 bits"));
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(value.extract()?));
    }
    if let Ok(text) = value.cast::<PyString>() {
        let text = text.to_cow().map_err(|_| wrong("is no text that UTF-8 can hold"))?;
        return Ok(Value::String(text.into_owned()));
    }
    if let Ok(mapping) = value.cast::<PyMapping>() {
        return table_of(path, mapping, depth).map(Value::Table);
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let elements = value.try_iter()?.enumerate();
        let elements =
            elements.map(|(i, element)| convert(&join(path, &i.to_string()), &element?, depth + 1));
        return elements.collect::<Result<_, _>>().map(Value::Array);
    }
    // Arrays and numbers of numpy, and whatever else knows how to be a list or a number.
    if let Ok(list) = value.call_method0("tolist") {
        return convert(path, &list, depth + 1);
    }
    if let Ok(name) = value.call_method0("__fspath__") {
        return convert(path, &name, depth + 1);
    }
    let kind = value.get_type().qualname()?;
    let help = "expected a number, a text, a bool, or a list or dict of those";
    Err(wrong(&format!("is of type `{kind}`; {help}")))
}

fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

/// A dict as a table.
///
/// # Errors
/// As [`to_toml`], and keys that are no texts.
pub fn table(path: &str, mapping: &Bound<'_, PyMapping>) -> Result<Table, Failure> {
    table_of(path, mapping, 0)
}

fn table_of(path: &str, mapping: &Bound<'_, PyMapping>, depth: usize) -> Result<Table, Failure> {
    let mut table = Table::new();
    for item in mapping.items()?.iter() {
        let (key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item.extract()?;
        let Ok(key) = key.cast::<PyString>() else {
            let place = if path.is_empty() { "the dict" } else { path };
            return Err(Failure::Input(format!("{place}: the key {key:?} is no text")));
        };
        let key = key.to_string();
        let value = convert(&join(path, &key), &value, depth + 1)?;
        table.insert(key, value);
    }
    Ok(table)
}

/// A value as TOML writes it in one line.
pub fn in_line(value: &Value) -> String {
    match value {
        Value::Table(table) => {
            let entries = table
                .iter()
                .map(|(key, value)| format!("{} = {}", Value::String(key.clone()), in_line(value)));
            format!("{{{}}}", entries.collect::<Vec<_>>().join(", "))
        }
        Value::Array(elements) => {
            let elements: Vec<String> = elements.iter().map(in_line).collect();
            format!("[{}]", elements.join(", "))
        }
        Value::String(text) => in_quotes(text),
        value => value.to_string(),
    }
}

/// A text as TOML has it between double quotes in one line (what JSON escapes TOML reads), with no quote inside: a list of
/// `--vary` is split before it is TOML.
fn in_quotes(text: &str) -> String {
    let json = serde_json::Value::from(text).to_string();
    let inside = json.strip_prefix('"').and_then(|json| json.strip_suffix('"')).unwrap_or_default();
    format!("\"{}\"", inside.replace("\\\"", "\\u0022"))
}

/// A value of TOML as one of Python.
pub fn from_toml<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Value::String(text) => text.into_bound_py_any(py),
        Value::Integer(number) => number.into_bound_py_any(py),
        Value::Float(number) => number.into_bound_py_any(py),
        Value::Boolean(truth) => truth.into_bound_py_any(py),
        Value::Datetime(time) => time.to_string().into_bound_py_any(py),
        Value::Array(elements) => {
            let elements: PyResult<Vec<_>> = elements.iter().map(|e| from_toml(py, e)).collect();
            elements?.into_bound_py_any(py)
        }
        Value::Table(table) => from_table(py, table).map(Bound::into_any),
    }
}

/// A table as a dict.
pub fn from_table<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (key, value) in table {
        dict.set_item(key, from_toml(py, value)?)?;
    }
    Ok(dict)
}
