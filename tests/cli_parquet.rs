//! `sweep.parquet`, the real binary. Only with the feature `parquet`.
#![cfg(feature = "parquet")]

mod cli_common;

use cli_common::{Place, names};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::fs::File;

/// The file as (name, one field a row) of each column.
fn columns(place: &Place, folder: &str) -> Vec<(String, Vec<Field>)> {
    let file = File::open(place.path(&format!("{folder}/sweep.parquet"))).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let mut columns: Vec<(String, Vec<Field>)> = Vec::new();
    for row in reader.get_row_iter(None).unwrap() {
        for (i, (name, field)) in row.unwrap().into_columns().into_iter().enumerate() {
            if columns.len() == i {
                columns.push((name, Vec::new()));
            }
            columns[i].1.push(field);
        }
    }
    columns
}

/// A cell of `sweep.csv` as the field that it should be.
fn field(name: &str, cell: &str) -> Field {
    match name {
        "status" | "contact.law" => Field::Str(cell.to_owned()),
        _ if cell.is_empty() => Field::Null,
        "impacts" | "steps" => Field::Long(cell.parse().unwrap()),
        _ => Field::Double(cell.parse().unwrap()),
    }
}

/// Numbers, texts, and two runs that the machine refuses, whose figures are null.
const VARY: &str = "--vary contact.law=hertz-step,ideal --vary motion.radius=0.05,0.1";

#[test]
fn the_file_says_what_the_table_says() {
    let place = Place::new();
    let line = format!("sweep --duration 0.02 --set simulation.tolerance=1e-4 {VARY}");
    let done = place.freeplay(&format!("{line} --out s"));
    assert_eq!(done.code, 0, "{}", done.err);
    let table = place.read("s/sweep.csv");
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let header: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 4);
    let columns = columns(&place, "s");
    assert_eq!(columns.len(), header.len());
    for (i, (name, fields)) in columns.iter().enumerate() {
        assert_eq!(*name, header[i]);
        let expected: Vec<Field> = rows.iter().map(|row| field(name, &row[i])).collect();
        assert_eq!(*fields, expected, "{name}");
    }
    let nulls = columns.iter().flat_map(|(_, fields)| fields).filter(|f| **f == Field::Null);
    assert!(nulls.count() >= 36, "two runs are refused");

    // Parts merge to the same bytes, and a sweep that goes on does not leave the old file.
    for i in 1..=2 {
        place.freeplay(&format!("{line} --shard {i}/2 --out part-{i}"));
    }
    let bytes =
        |folder: &str| std::fs::read(place.path(&format!("{folder}/sweep.parquet"))).unwrap();
    place.good("merge part-1 part-2 --out m");
    assert_eq!(bytes("m"), bytes("s"));
    place.good("merge part-1 --partial --out some");
    assert_ne!(bytes("some"), bytes("s"));
    assert_eq!(place.freeplay(&format!("{line} --out some")).code, 0);
    assert_eq!(bytes("some"), bytes("s"));
    assert_eq!(place.freeplay(&format!("{line} --out some --force")).code, 0);
    assert!(names(&place.path("some")).contains(&"sweep.parquet".to_owned()));
}
