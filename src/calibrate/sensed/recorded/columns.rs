//! Which columns of a file are of which sensors, by its header.

use crate::measure::spelling::nearest;
use crate::mechanism::{Reads, Sensor};

/// Heads that a column of time may have.
pub(super) const TIME: [&str; 2] = ["t", "t_s"];

/// Where time stands, where each sensor's column does, and what else there is.
pub struct Places {
    pub time: usize,
    pub places: Vec<Option<usize>>,
    pub others: Vec<usize>,
}

/// Finds the columns by the header; what is wrong with it and what would be right. Time stands in the column that was
/// `asked` for. A column that no sensor has is left alone, unless it looks like the misspelt name of a sensor's column
/// that is missing.
pub fn choose(
    heads: &csv::StringRecord,
    sensors: &[Sensor],
    efforts: bool,
    asked: Option<&str>,
) -> Result<Places, (String, String)> {
    let known: Vec<&str> = sensors.iter().map(|sensor| sensor.column.as_str()).collect();
    let named: Vec<&str> = asked.map_or_else(|| TIME.to_vec(), |column| vec![column]);
    let there = heads.iter().collect::<Vec<_>>().join(", ");
    let expected =
        format!("expected `{}` and any of {}; the file has {there}", named[0], known.join(", "));
    let (mut time, mut places) = (None, vec![None; sensors.len()]);
    let mut others = Vec::new();
    for (place, head) in heads.iter().enumerate() {
        let twice = || (format!("column `{head}` twice"), "keep one of them".to_owned());
        if let Some(sensor) = known.iter().position(|column| *column == head) {
            if places[sensor].replace(place).is_some() {
                return Err(twice());
            }
        } else if named.contains(&head) {
            if time.replace(place).is_some() {
                return Err(twice());
            }
        } else {
            others.push(place);
        }
    }
    let missing: Vec<&str> =
        known.iter().zip(&places).filter(|(_, place)| place.is_none()).map(|(k, _)| *k).collect();
    let mut strange = others.iter().map(|place| &heads[*place]);
    if let Some((head, near)) = strange.find_map(|head| Some((head, nearest(head, &missing)?))) {
        let help = format!("did you mean `{near}`? no [[sensor]] has it; {expected}");
        return Err((format!("unknown column `{head}`"), help));
    }
    let Some(time) = time else {
        return Err(match (asked, others.first()) {
            (None, Some(place)) => {
                let help = format!("no [[sensor]] has it; {expected}");
                (format!("unknown column `{}`", &heads[*place]), help)
            }
            _ => (format!("no column `{}`", named[0]), expected),
        });
    };
    if places.iter().all(Option::is_none) {
        let columns = known.iter().map(|column| format!("`{column}`")).collect::<Vec<_>>();
        return Err((format!("no column {}", columns.join(", ")), expected));
    }
    let missing = commands_missing(sensors, &places, efforts);
    if missing.is_empty() {
        return Ok(Places { time, places, others });
    }
    let help = "without its commands nobody knows what the machine was asked to do".to_owned();
    Err((format!("no column {}", missing.join(", ")), help))
}

/// Columns of commands that are not there and that nothing stands in for.
fn commands_missing(sensors: &[Sensor], places: &[Option<usize>], efforts: bool) -> Vec<String> {
    // What was measured of a drive's effort stands in for its command.
    let replaced = |drive: usize| {
        let mut sensors = sensors.iter().zip(places);
        efforts
            && sensors.any(|(s, place)| {
                place.is_some() && matches!(s.reads, Reads::Effort(of) if of == drive)
            })
    };
    sensors
        .iter()
        .zip(places)
        .filter(|(sensor, place)| {
            place.is_none() && matches!(sensor.reads, Reads::Command(drive) if !replaced(drive))
        })
        .map(|(sensor, _)| format!("`{}`", sensor.column))
        .collect()
}
