//! `sweep.parquet`: the table with types, for programs that read columns. Only with the feature
//! `parquet`.
//!
//! Figures are doubles or, where they count, 64-bit integers; a varied key is a column of doubles if all
//! its values are numbers, and of texts otherwise; `status` is a text. An empty cell is null.

use super::journal::RunRows;
use super::row::{COUNTS, FIGURES};
use crate::study::sweep::Identity;
use csv::StringRecord;
use parquet::basic::{LogicalType, Repetition, Type as PhysicalType};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::io;
use std::sync::Arc;

/// A column by what it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ColumnKind {
    Count,
    Number,
    Text,
}

/// The rows by the number of their run, as a Parquet file.
///
/// # Errors
/// If the library refuses. No rows lead there.
pub(in crate::study::sweep) fn table(identity: &Identity, rows: &RunRows) -> io::Result<Vec<u8>> {
    bytes(identity, rows).map_err(io::Error::other)
}

fn bytes(identity: &Identity, rows: &RunRows) -> Result<Vec<u8>, ParquetError> {
    let kinds: Vec<ColumnKind> =
        identity.columns.iter().enumerate().map(|(i, name)| kind(name, i, rows)).collect();
    let fields = identity.columns.iter().zip(&kinds).map(|(name, kind)| field(name, *kind));
    let fields = fields.collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("sweep").with_fields(fields).build()?;
    let properties = Arc::new(WriterProperties::builder().build());
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), properties)?;
    let mut group = writer.next_row_group()?;
    for (i, kind) in kinds.iter().enumerate() {
        let cells = || rows.values().map(move |row| row.get(i).unwrap_or_default());
        match kind {
            ColumnKind::Count => {
                column::<Int64Type>(&mut group, cells().map(|cell| cell.parse().ok()))?
            }
            ColumnKind::Number => {
                column::<DoubleType>(&mut group, cells().map(|cell| cell.parse().ok()))?;
            }
            ColumnKind::Text => {
                column::<ByteArrayType>(&mut group, cells().map(|c| Some(ByteArray::from(c))))?;
            }
        }
    }
    group.close()?;
    writer.into_inner()
}

/// What column `i` holds.
fn kind(name: &str, i: usize, rows: &RunRows) -> ColumnKind {
    let number = |row: &StringRecord| row.get(i).is_some_and(|cell| cell.parse::<f64>().is_ok());
    if COUNTS.contains(&name) {
        ColumnKind::Count
    } else if FIGURES.contains(&name) || rows.values().all(number) {
        ColumnKind::Number
    } else {
        ColumnKind::Text
    }
}

fn field(name: &str, kind: ColumnKind) -> Result<Arc<Type>, ParquetError> {
    let (physical, logical) = match kind {
        ColumnKind::Count => (PhysicalType::INT64, None),
        ColumnKind::Number => (PhysicalType::DOUBLE, None),
        ColumnKind::Text => (PhysicalType::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let builder = Type::primitive_type_builder(name, physical);
    let built = builder.with_repetition(Repetition::OPTIONAL).with_logical_type(logical).build()?;
    Ok(Arc::new(built))
}

/// Writes the next column; what is none becomes null.
fn column<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    cells: impl Iterator<Item = Option<T::T>>,
) -> Result<(), ParquetError> {
    let (mut levels, mut values) = (Vec::new(), Vec::new());
    for cell in cells {
        levels.push(i16::from(cell.is_some()));
        values.extend(cell);
    }
    // There is one column for each name of the schema.
    let Some(mut column) = group.next_column()? else { return Ok(()) };
    column.typed::<T>().write_batch(&values, Some(&levels), None)?;
    column.close()
}
