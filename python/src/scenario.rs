//! A scenario: a text with overrides, as far as it makes sense by itself.

use crate::error::{DICT, Failure};
use crate::value::{from_table, from_toml, in_line, table, to_toml};
use freeplay::scenario::{self, Source};
use pyo3::exceptions::{PyKeyError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping, PyTuple};
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// A scenario whose every number makes sense by itself. It never changes: `set` makes another one.
#[pyclass(frozen, module = "pyfreeplay._native")]
pub struct Scenario {
    /// What it is made of, to be varied.
    pub source: Source,
    /// The overrides, in their order.
    pub sets: Vec<String>,
    pub scenario: scenario::Scenario,
}

impl Scenario {
    fn make(source: Source, sets: Vec<String>) -> Result<Self, Failure> {
        let scenario = source.scenario(&sets)?;
        Ok(Self { source, sets, scenario })
    }

    fn of_any(source: Option<&Bound<'_, PyAny>>) -> Result<Self, Failure> {
        let Some(source) = source else {
            return Self::make(Source::read(None)?, Vec::new());
        };
        if let Ok(dict) = source.cast::<PyMapping>() {
            let text = table("", dict)?.to_string();
            return Self::make(Source::of(&text, DICT, Path::new("")), Vec::new());
        }
        match source.extract::<PathBuf>() {
            Ok(path) => Self::make(Source::read(Some(&path))?, Vec::new()),
            Err(_) => {
                let kind = source.get_type().qualname()?;
                Err(PyTypeError::new_err(format!(
                    "a scenario is made of a file's name, a dict, or nothing for the built-in one, not of `{kind}`; text \
                     is read by Scenario.from_toml"
                ))
                .into())
            }
        }
    }

    fn table(&self) -> Table {
        // What was written reads back.
        self.scenario.to_toml().parse().unwrap_or_default()
    }

    /// What stands at a dotted path, lists by number or by the name of the element.
    fn find(&self, path: &str) -> Option<Value> {
        let mut node = Value::Table(self.table());
        for key in path.split('.') {
            node = match node {
                Value::Table(mut table) => table.remove(key)?,
                Value::Array(elements) => {
                    let named = |element: &Value| {
                        let name = ["name", "joint", "column"].into_iter();
                        name.filter_map(|n| element.get(n)?.as_str()).next() == Some(key)
                    };
                    let place = elements.iter().position(named).or_else(|| key.parse().ok())?;
                    elements.get(place)?.clone()
                }
                _ => return None,
            };
        }
        Some(node)
    }
}

#[pymethods]
impl Scenario {
    #[new]
    #[pyo3(signature = (source = None, /))]
    fn new(py: Python<'_>, source: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        Self::of_any(source).map_err(|failure| failure.exception(py))
    }

    #[staticmethod]
    #[pyo3(signature = (text, *, name = "text", folder = PathBuf::new()))]
    fn from_toml(py: Python<'_>, text: &str, name: &str, folder: PathBuf) -> PyResult<Self> {
        let made = Self::make(Source::of(text, name, &folder), Vec::new());
        made.map_err(|failure| failure.exception(py))
    }

    #[staticmethod]
    fn _restore(
        py: Python<'_>,
        text: &str,
        file: &str,
        folder: PathBuf,
        sets: Vec<String>,
    ) -> PyResult<Self> {
        Self::make(Source::of(text, file, &folder), sets).map_err(|failure| failure.exception(py))
    }

    #[pyo3(signature = (path, value = None, /))]
    fn set(
        &self,
        py: Python<'_>,
        path: &Bound<'_, PyAny>,
        value: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let set = |path: &str, value: &Bound<'_, PyAny>| {
            let value = in_line(&to_toml(path, value)?);
            Ok::<_, Failure>(format!("{path}={value}"))
        };
        let more: Result<Vec<String>, Failure> = match (path.cast::<PyMapping>(), value) {
            (Ok(values), None) => {
                let items = values.items()?;
                let items = items.iter().map(|item| {
                    let (path, value): (String, Bound<'_, PyAny>) = item.extract()?;
                    set(&path, &value)
                });
                items.collect()
            }
            (Err(_), Some(value)) => set(&path.extract::<String>()?, value).map(|set| vec![set]),
            _ => {
                return Err(PyTypeError::new_err(
                    "set takes a path and a value, or a dict of paths and values",
                ));
            }
        };
        let made = more.and_then(|more| {
            // What is set again, or with all that stands above it, is not what it was before.
            let path = |set: &str| set.split_once('=').map_or(set, |(path, _)| path).to_owned();
            let again = |set: &&String| {
                more.iter().any(|later| {
                    let below = path(set).strip_prefix(&path(later)).map(str::to_owned);
                    below.is_some_and(|below| below.is_empty() || below.starts_with('.'))
                })
            };
            let kept = self.sets.iter().filter(|set| !again(set)).cloned();
            let sets = kept.chain(more.iter().cloned()).collect();
            Self::make(self.source.clone(), sets)
        });
        made.map_err(|failure| failure.exception(py))
    }

    #[pyo3(signature = (function, *, body = None, point = None, joint = None, interval = 1e-3, file = None))]
    #[allow(clippy::too_many_arguments)]
    fn with_motion<'py>(
        slf: &Bound<'py, Self>,
        function: &Bound<'py, PyAny>,
        body: Option<&str>,
        point: Option<&str>,
        joint: Option<&str>,
        interval: f64,
        file: Option<PathBuf>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let sampled = slf.py().import("pyfreeplay._motion")?.getattr("sampled")?;
        sampled.call1((slf, function, body, point, joint, interval, file))
    }

    fn __getitem__<'py>(&self, py: Python<'py>, path: &str) -> PyResult<Bound<'py, PyAny>> {
        match self.find(path) {
            Some(value) => from_toml(py, &value),
            None => Err(PyKeyError::new_err(path.to_owned())),
        }
    }

    fn __contains__(&self, path: &str) -> bool {
        self.find(path).is_some()
    }

    fn to_toml(&self) -> String {
        self.scenario.to_toml()
    }

    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        from_table(py, &self.table())
    }

    /// The mechanism file that a template stands for, as a scenario.
    fn expand(&self, py: Python<'_>) -> PyResult<Self> {
        let made = freeplay::model::expand(&self.scenario).map_err(Failure::from).and_then(|s| {
            let name = format!("{}, expanded", self.source.name());
            Self::make(Source::of(&s.to_toml(), &name, self.source.folder()), Vec::new())
        });
        made.map_err(|failure| failure.exception(py))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.scenario.name
    }

    #[getter]
    fn hash(&self) -> String {
        self.scenario.hash()
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        let other = other.cast::<Scenario>();
        other.is_ok_and(|other| other.get().to_toml() == self.to_toml())
    }

    fn __hash__(&self) -> u64 {
        u64::from_str_radix(&self.scenario.hash()[..15], 16).unwrap_or_default()
    }

    fn __repr__(&self) -> String {
        let of = self.source.name();
        let of = if of == DICT { "a dict" } else { of };
        let sets = match self.sets.len() {
            0 => String::new(),
            1 => ", 1 value set".to_owned(),
            n => format!(", {n} values set"),
        };
        format!("<Scenario {:?} from {of}{sets}>", self.scenario.name)
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let restore = slf.get_type().getattr("_restore")?;
        Ok((restore, slf.get()._parts(slf.py())?))
    }

    /// Text, name, folder from the root, overrides: what another process needs to make the same scenario.
    fn _parts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let source = &self.source;
        let folder = source.folder();
        // Without a folder, relative names mean the working directory.
        let folder =
            std::path::absolute(Path::new(".").join(folder)).unwrap_or_else(|_| folder.to_owned());
        (source.text(), source.name(), folder, self.sets.clone()).into_pyobject(py)
    }
}
