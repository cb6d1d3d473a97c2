//! Tables of numbers as other people's programs write them: separators, decimal commas, encodings, a row of units.
//! What can be read in one way only is; nothing is guessed.

use super::bounded::{self, Bounded};
use csv::StringRecord;
use std::io::{self, Cursor, ErrorKind, Read};
use std::path::Path;

/// How much of a file shows how it is written: the header and some hundred rows.
const BEGINNING: usize = 64 << 10;

/// Units in which columns are expected, as they are written, brackets left out.
const UNITS: [&str; 16] = [
    "", "-", "1", "s", "m", "rad", "N", "Nm", "N m", "N*m", "V", "A", "m/s", "rad/s", "m/s^2",
    "m/s2",
];

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dialect {
    /// What stands between two columns.
    separator: u8,
    /// Numbers have a comma where others have a point.
    decimal_comma: bool,
    /// Encoded as UTF-16.
    wide: bool,
    /// The second row holds units.
    units: bool,
}

/// A table that is read row by row.
///
/// ```
/// use freeplay::measure::{bounded, dialect::Rows};
///
/// let folder = tempfile::tempdir()?;
/// let file = folder.path().join("run.csv");
/// std::fs::write(&file, "t;x\n0,0;1,5\n0,1;1,6\n")?;
/// let mut rows = Rows::begin(bounded::open(&file, bounded::TABLE)?)?;
/// let mut row = csv::StringRecord::new();
/// assert!(rows.next(&mut row)?);
/// assert_eq!(rows.number(&row[1]), Some(1.5), "semicolons and decimal commas are seen");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Rows {
    reader: csv::Reader<Box<dyn Read>>,
    dialect: Dialect,
    heads: StringRecord,
}

impl Dialect {
    /// Of a table that begins so, as text.
    fn of(beginning: &str, wide: bool) -> Self {
        let mut lines = beginning.lines().filter(|line| !line.trim().is_empty());
        let header = lines.next().unwrap_or_default();
        let count = |c: char| header.matches(c).count();
        let separator = [';', '\t'].into_iter().max_by_key(|c| count(*c)).filter(|c| count(*c) > 0);
        let separator = separator.filter(|c| count(*c) >= count(',')).unwrap_or(',');
        let fields = |line: &'_ str| -> Vec<String> {
            line.split(separator).map(|field| field.trim().to_owned()).collect()
        };
        // The last line may be cut off.
        let rows: Vec<Vec<String>> = lines.map(fields).collect();
        let whole = &rows[..rows.len().saturating_sub(1).max(rows.len().min(1))];
        let all = || whole.iter().flatten();
        let is_comma = |field: &String| field.contains(',') && number(field, true).is_some();
        let decimal_comma =
            separator != ',' && all().any(is_comma) && !all().any(|field| field.contains('.'));
        let is_number = |field: &String| number(field, decimal_comma).is_some();
        let units = whole.first().is_some_and(|row| {
            row.iter().all(|field| !is_number(field)) && row.iter().any(|field| !field.is_empty())
        }) && whole.get(1).is_some_and(|row| row.iter().any(is_number));
        Self { separator: separator as u8, decimal_comma, wide, units }
    }

    /// What is unusual about it, in words; nothing where nothing is.
    fn remark(self) -> Option<String> {
        let separator = match self.separator {
            b';' => Some("semicolons between columns"),
            b'\t' => Some("tabs between columns"),
            _ => None,
        };
        let parts = [
            self.wide.then_some("UTF-16"),
            separator,
            self.decimal_comma.then_some("decimal commas"),
            self.units.then_some("a row of units"),
        ];
        let parts: Vec<&str> = parts.into_iter().flatten().collect();
        (!parts.is_empty()).then(|| format!("read with {}", parts.join(", ")))
    }
}

/// A finite number, with a decimal comma where that is so.
fn number(field: &str, comma: bool) -> Option<f64> {
    let value = match comma {
        true => field.replacen(',', ".", 1).parse::<f64>(),
        false => field.parse::<f64>(),
    };
    value.ok().filter(|value| value.is_finite())
}

/// The beginning of a table as text, all of it where it is UTF-16, and what reads the table as UTF-8.
fn begun(mut opened: Bounded) -> io::Result<(String, bool, Box<dyn Read>)> {
    let mut beginning = Vec::new();
    Read::by_ref(&mut opened).take(BEGINNING as u64).read_to_end(&mut beginning)?;
    let pair: Option<fn([u8; 2]) -> u16> = match beginning.get(..2) {
        Some([0xff, 0xfe]) => Some(u16::from_le_bytes),
        Some([0xfe, 0xff]) => Some(u16::from_be_bytes),
        _ => None,
    };
    if let Some(pair) = pair {
        opened.read_to_end(&mut beginning)?;
        let pairs = beginning[2..].chunks_exact(2).map(|bytes| pair([bytes[0], bytes[1]]));
        let text: Result<String, _> = char::decode_utf16(pairs).collect();
        let wrong = |_| io::Error::new(ErrorKind::InvalidData, "UTF-16 with half a character");
        let text = text.map_err(wrong)?;
        return Ok((text.clone(), true, Box::new(Cursor::new(text.into_bytes()))));
    }
    if beginning.starts_with(&[0xef, 0xbb, 0xbf]) {
        beginning.drain(..3);
    }
    let text = String::from_utf8_lossy(&beginning).into_owned();
    Ok((text, false, Box::new(Cursor::new(beginning).chain(opened))))
}

impl Rows {
    /// Reads the header of a table.
    ///
    /// # Errors
    /// What the system says, a table that is none, units that are not those of numbers here.
    pub fn begin(opened: Bounded) -> Result<Self, csv::Error> {
        let scales = ", or no row of units and a `scale` of each [[sensor]] in the rig (`freeplay expand` writes those of a \
                      template)";
        Self::begun(opened, scales)
    }

    /// The same of a table whose reader knows no scales.
    ///
    /// # Errors
    /// As of [`begin`](Self::begin).
    pub fn begin_unscaled(opened: Bounded) -> Result<Self, csv::Error> {
        Self::begun(opened, "")
    }

    fn begun(opened: Bounded, otherwise: &str) -> Result<Self, csv::Error> {
        let (text, wide, rest) = begun(opened)?;
        let dialect = Dialect::of(&text, wide);
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(dialect.separator)
            .trim(csv::Trim::All)
            .from_reader(rest);
        let heads = reader.headers()?.clone();
        let mut rows = Self { reader, dialect, heads };
        if dialect.units {
            let mut units = StringRecord::new();
            rows.reader.read_record(&mut units)?;
            let plain = |unit: &str| {
                let brackets = |c: char| "[]()".contains(c) || c.is_whitespace();
                UNITS.contains(&unit.trim_matches(brackets))
            };
            if let Some(place) = units.iter().position(|unit| !plain(unit)) {
                let message = format!(
                    "line 2: column `{}` is in `{}`; expected SI units and radians{otherwise}",
                    rows.heads.get(place).unwrap_or_default(),
                    &units[place]
                );
                return Err(io::Error::new(ErrorKind::InvalidData, message).into());
            }
        }
        Ok(rows)
    }

    /// The heads of the columns.
    pub fn heads(&self) -> &StringRecord {
        &self.heads
    }

    /// Reads the next row; false at the end.
    ///
    /// # Errors
    /// A row that is none.
    pub fn next(&mut self, row: &mut StringRecord) -> Result<bool, csv::Error> {
        self.reader.read_record(row).map_err(|error| match error.kind() {
            csv::ErrorKind::UnequalLengths { pos, expected_len, len }
                if self.dialect.separator == b',' && (expected_len + 1..=2 * expected_len).contains(len) =>
            {
                let line = pos.as_ref().map_or(0, csv::Position::line);
                let message = format!(
                    "line {line}: {len} values under {expected_len} heads: commas stand between columns, and in \
                     numbers, too? write points in numbers, or semicolons between columns"
                );
                io::Error::new(ErrorKind::InvalidData, message).into()
            }
            _ => error,
        })
    }

    /// The number in a cell, if it is a finite one.
    pub fn number(&self, cell: &str) -> Option<f64> {
        number(cell, self.dialect.decimal_comma)
    }

    /// A cell as a table with points and commas has it.
    pub fn plain<'a>(&self, cell: &'a str) -> std::borrow::Cow<'a, str> {
        match self.dialect.decimal_comma && self.number(cell).is_some() {
            true => cell.replacen(',', ".", 1).into(),
            false => cell.into(),
        }
    }

    /// Lines above the first row of numbers.
    pub fn lines_above(&self) -> u64 {
        1 + u64::from(self.dialect.units)
    }
}

/// What is unusual about how a file is written, in words. Of a pipe nothing is said (it can be read but once), nor of
/// what cannot be read.
pub fn remark(path: &Path) -> Option<String> {
    let opened = bounded::open_plain(path, bounded::TABLE).ok()?;
    Rows::begin(opened).ok()?.dialect.remark()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<(Vec<Vec<f64>>, Option<String>), String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        std::fs::write(&path, bytes).unwrap();
        let opened = crate::measure::bounded::open(&path, 1 << 20).unwrap();
        let mut rows = Rows::begin(opened).map_err(|error| error.to_string())?;
        assert_eq!(rows.heads().iter().collect::<Vec<_>>(), ["t", "q1"]);
        let (mut row, mut read) = (StringRecord::new(), Vec::new());
        while rows.next(&mut row).map_err(|error| error.to_string())? {
            read.push(row.iter().map(|cell| rows.number(cell).unwrap_or(f64::NAN)).collect());
        }
        Ok((read, remark(&path)))
    }

    #[test]
    fn every_way_of_writing_holds_the_same_numbers() {
        let wide = |text: &str, to: fn(u16) -> [u8; 2], mark: [u8; 2]| {
            mark.into_iter().chain(text.encode_utf16().flat_map(to)).collect::<Vec<u8>>()
        };
        let german = "t;q1\n0,0;0,25\n0,001;-1,5e-3\n";
        for (bytes, said) in [
            (b"t,q1\n0.0,0.25\n0.001,-1.5e-3\n".to_vec(), None),
            (b"\xef\xbb\xbft, q1\r\n0.0, 0.25\r\n0.001, -1.5e-3\r\n".to_vec(), None),
            (
                b"t;q1\n0.0;0.25\n0.001;-1.5e-3\n".to_vec(),
                Some("read with semicolons between columns"),
            ),
            (german.into(), Some("read with semicolons between columns, decimal commas")),
            (
                b"t\tq1\n0.0\t0.25\n0.001\t-1.5e-3\n".to_vec(),
                Some("read with tabs between columns"),
            ),
            (
                b"t,q1\n[s],[m]\n0.0,0.25\n0.001,-1.5e-3\n".to_vec(),
                Some("read with a row of units"),
            ),
            (
                wide(german, u16::to_le_bytes, [0xff, 0xfe]),
                Some("read with UTF-16, semicolons between columns, decimal commas"),
            ),
            (
                wide("t,q1\n0.0,0.25\n0.001,-1.5e-3\n", u16::to_be_bytes, [0xfe, 0xff]),
                Some("read with UTF-16"),
            ),
        ] {
            let (rows, remark) = read(&bytes).unwrap();
            assert_eq!(rows, [[0.0, 0.25], [0.001, -1.5e-3]], "{bytes:?}");
            assert_eq!(remark.as_deref(), said);
        }
    }

    #[test]
    fn what_could_be_meant_in_two_ways_is_not_read() {
        let units = read(b"t;q1\ns;mm\n0,0;0,25\n0,001;1,5\n").unwrap_err();
        assert!(units.contains("column `q1` is in `mm`"), "{units}");
        // Points and commas in one file: thousands or decimals?
        let (rows, _) = read(b"t;q1\n0.0;1,250\n0.001;1,5\n").unwrap();
        assert!(rows[0][1].is_nan());
        let commas = read(b"t,q1\n0,0,0,25\n0,001,1,5\n").unwrap_err();
        assert!(commas.contains("line 2: 4 values under 2 heads"), "{commas}");
    }
}
