//! A prediction as a file with the recording's own rows, columns, names and units.

use crate::identify::Recorded;
use crate::measure::log::{Channel, Log};
use std::io;
use std::path::Path;

/// The recording's CSV text with what was predicted in place of what was measured. Commands, time and
/// columns that nothing asks for stay as they are, letter by letter.
///
/// # Errors
/// A file that has changed since it was read.
pub fn predicted(recorded: &Recorded, model: &Log) -> io::Result<String> {
    let mut reader =
        csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(Path::new(&recorded.path))?;
    let head = reader.headers()?.clone();
    let replaced: Vec<(usize, f64, &[f64])> = recorded
        .sources
        .iter()
        .filter_map(|(channel, source)| {
            let place = head.iter().position(|name| name == source.column)?;
            Some((place, source.scale, model.get(*channel)?))
        })
        .collect();
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(&head)?;
    for (row, record) in reader.records().enumerate() {
        let record = record?;
        let mut cells: Vec<String> = record.iter().map(str::to_owned).collect();
        for (place, scale, values) in &replaced {
            if let (Some(cell), Some(value)) = (cells.get_mut(*place), values.get(row)) {
                *cell = format!("{:.9}", value / scale);
            }
        }
        writer.write_record(&cells)?;
    }
    let bytes = writer.into_inner().map_err(|error| io::Error::other(error.to_string()))?;
    String::from_utf8(bytes).map_err(io::Error::other)
}

/// The measured channels of a recording: what a prediction is held against.
pub fn measured(log: &Log) -> impl Iterator<Item = Channel> + '_ {
    log.channels().filter(|channel| !matches!(channel, Channel::Command(_) | Channel::Added(_)))
}
