//! What a page needs to read values off a picture: where its plots are, and what their axes and colours mean.

use super::Label;
use serde_json::{Value, json};

/// A plot of a picture.
#[derive(Debug)]
pub(super) struct Plot<'a> {
    /// Left, top, width and height in canvas units.
    pub area: [i32; 4],
    /// First and last value of x and of y; decimal logarithms where the axis is logarithmic.
    pub ranges: [[f64; 2]; 2],
    /// Of x and y.
    pub labels: [&'a Label; 2],
    /// Names of the curves, with their colours.
    pub curves: Vec<(&'a str, String)>,
}

impl Plot<'_> {
    fn json(&self) -> Value {
        let [x, y] = self.labels;
        json!({
            "area": self.area,
            "x": self.ranges[0],
            "y": self.ranges[1],
            "log": [x.logarithmic, y.logarithmic],
            "labels": [x.text, y.text],
            "curves": self.curves,
        })
    }
}

/// The attribute of the picture that holds them.
pub(super) fn attribute<'a>(plots: impl IntoIterator<Item = Plot<'a>>) -> String {
    let plots: Vec<Value> = plots.into_iter().map(|plot| plot.json()).collect();
    if plots.is_empty() {
        return String::new();
    }
    format!(" data-plots=\"{}\"", super::page::escaped(&Value::from(plots).to_string()))
}
