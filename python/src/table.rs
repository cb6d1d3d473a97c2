//! Columns with names: arrays for numpy, a stream for whatever reads Arrow.

use crate::error::Failure;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{ArrayRef, Float64Array, RecordBatch, RecordBatchIterator, StringArray};
use arrow_schema::ArrowError;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyKeyError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyList};
use std::path::Path;
use std::sync::Arc;

/// A table: its numbers belong to numpy arrays that cannot be written to.
#[pyclass(frozen, module = "pyfreeplay._native")]
pub struct Table {
    names: Vec<String>,
    columns: Vec<Column>,
    rows: usize,
}

enum Column {
    /// Where a cell is empty, NaN; in Arrow null.
    Numbers(Py<PyArray1<f64>>),
    Texts(Vec<String>),
}

impl Table {
    /// A table of numbers; the columns are as long as each other.
    pub fn of_numbers(
        py: Python<'_>,
        names: Vec<String>,
        columns: Vec<Vec<f64>>,
    ) -> PyResult<Self> {
        let rows = columns.first().map_or(0, Vec::len);
        let columns =
            columns.into_iter().map(|values| numbers(py, values)).collect::<PyResult<_>>()?;
        Ok(Self { names, columns, rows })
    }

    /// The table of a CSV file with a header that freeplay wrote: a column is one of numbers if every cell is a number or
    /// empty and one is not empty.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn of_csv(py: Python<'_>, path: &Path) -> Result<Self, Failure> {
        let wrong = |error: csv::Error| Failure::Run(format!("{}: {error}", path.display()));
        let mut reader = csv::Reader::from_path(path).map_err(wrong)?;
        let names: Vec<String> =
            reader.headers().map_err(wrong)?.iter().map(str::to_owned).collect();
        let mut cells: Vec<Vec<String>> = vec![Vec::new(); names.len()];
        for record in reader.records() {
            for (column, cell) in cells.iter_mut().zip(&record.map_err(wrong)?) {
                column.push(cell.to_owned());
            }
        }
        let rows = cells.first().map_or(0, Vec::len);
        let columns = cells.into_iter().map(|cells| column(py, cells)).collect::<PyResult<_>>()?;
        Ok(Self { names, columns, rows })
    }

    fn batch(&self, py: Python<'_>) -> Result<RecordBatch, ArrowError> {
        let arrays = self.columns.iter().map(|column| -> ArrayRef {
            match column {
                Column::Numbers(array) => {
                    let values = array.bind(py).readonly();
                    let values = values.as_array();
                    let values = values.iter().map(|value| (!value.is_nan()).then_some(*value));
                    Arc::new(values.collect::<Float64Array>())
                }
                Column::Texts(texts) => Arc::new(texts.iter().map(Some).collect::<StringArray>()),
            }
        });
        RecordBatch::try_from_iter(self.names.iter().zip(arrays))
    }
}

fn numbers(py: Python<'_>, values: Vec<f64>) -> PyResult<Column> {
    let array = PyArray1::from_vec(py, values);
    array.call_method1("setflags", (false,))?;
    Ok(Column::Numbers(array.unbind()))
}

fn column(py: Python<'_>, cells: Vec<String>) -> PyResult<Column> {
    let number = |cell: &String| match cell.as_str() {
        "" => Some(f64::NAN),
        cell => cell.parse::<f64>().ok(),
    };
    let values: Option<Vec<f64>> = cells.iter().map(number).collect();
    let none = cells.iter().all(String::is_empty) && !cells.is_empty();
    match values.filter(|_| !none) {
        Some(values) => numbers(py, values),
        None if none => numbers(py, vec![f64::NAN; cells.len()]),
        None => Ok(Column::Texts(cells)),
    }
}

#[pymethods]
impl Table {
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.names.clone()
    }

    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let place = self.names.iter().position(|known| known == name);
        match place.map(|place| &self.columns[place]) {
            Some(Column::Numbers(array)) => Ok(array.bind(py).clone().into_any()),
            Some(Column::Texts(texts)) => Ok(PyList::new(py, texts)?.into_any()),
            None => Err(PyKeyError::new_err(format!(
                "`{name}` is no column; there are {}",
                self.names.join(", ")
            ))),
        }
    }

    fn __contains__(&self, name: &str) -> bool {
        self.names.iter().any(|known| known == name)
    }

    fn __len__(&self) -> usize {
        self.rows
    }

    /// The protocol of Arrow's PyCapsules. A schema that is asked for is a wish, which need not be met.
    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        let _ = requested_schema;
        let batch = self.batch(py).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        let schema = batch.schema();
        let reader = RecordBatchIterator::new([Ok(batch)], schema);
        let stream = FFI_ArrowArrayStream::new(Box::new(reader));
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }

    fn __repr__(&self) -> String {
        format!("<Table of {} rows: {}>", self.rows, self.names.join(", "))
    }
}
