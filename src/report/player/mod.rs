//! A page that plays a run: one HTML file with everything in it.

use super::page::escaped;
use super::scene::Scene;
use crate::measure::frames::Frames;
use serde::Serialize;

const PAGE: &str = include_str!("player.html");
const STYLE: &str = include_str!("player.css");
const SCRIPT: &str = include_str!("player.js");

/// What the script reads.
#[derive(Serialize)]
struct Data<'a> {
    scene: &'a Scene,
    thinned: bool,
    /// All frames as 32-bit floats, little-endian, in base 64: of each frame time, values, then
    /// lowest and highest of each signal.
    frames: String,
}

/// The page as HTML. Nothing is fetched: style, script and data are inline.
pub fn player_html(scene: &Scene, frames: &Frames) -> String {
    let mut bytes = Vec::new();
    for frame in frames.all() {
        let numbers = [frame.t as f32].into_iter().chain(frame.values.iter().copied());
        for number in numbers.chain(frame.extremes.iter().flatten().copied()) {
            bytes.extend(number.to_le_bytes());
        }
    }
    let data = Data { scene, thinned: frames.thinned(), frames: base64(&bytes) };
    let data = serde_json::to_string(&data).expect("numbers, texts and lists are JSON");
    // In one pass: what is filled in may contain such marks itself.
    let mut page = String::with_capacity(PAGE.len() + STYLE.len() + SCRIPT.len() + data.len());
    for piece in PAGE.split("%%") {
        match piece {
            "TITLE" => page += &escaped(&scene.title),
            "STYLE" => page += STYLE,
            "SCRIPT" => page += SCRIPT,
            // A name with "</script>" must not end the element.
            "DATA" => page += &data.replace('<', "\\u003c"),
            text => page += text,
        }
    }
    page
}

/// RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |i: usize| u32::from(*chunk.get(i).unwrap_or(&0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for i in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * i)) as usize & 63];
            text.push(if i <= chunk.len() { char::from(digit) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::frames::FilmFrame;

    #[test]
    fn base64_is_that_of_the_standard() {
        for (plain, coded) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn names_do_not_become_markup_and_nothing_is_fetched() {
        let name = "</script><script>alert(1)%%DATA%%";
        let scene = Scene {
            title: name.into(),
            ground: vec![],
            bodies: vec![],
            joints: vec![],
            tracked: 0,
            tracked_point: [0.0, 0.0],
            charts: vec![],
        };
        let mut frames = Frames::new(2);
        frames.push(FilmFrame { t: 1.0, values: vec![2.0], extremes: vec![] });
        let html = player_html(&scene, &frames);
        assert!(!html.contains("<script>alert"));
        assert!(html.contains("\"frames\":\"AACAPwAAAEA=\""), "1.0 and 2.0");
        for fetch in ["src=", "url(", "@import", "<link", "fetch("] {
            assert!(!html.contains(fetch), "{fetch}");
        }
        assert_eq!(
            html.matches("http").count(),
            html.matches("http://www.w3.org/2000/svg").count()
        );
    }
}
