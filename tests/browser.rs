//! The pages of a run in a real browser.

mod cli_common;
mod webdriver;

use cli_common::Place;
use serde_json::Value;
use std::time::{Duration, Instant};
use webdriver::Browser;

const RIGHT: char = '\u{e014}';
const END: char = '\u{e010}';

/// Where bodies and journals are drawn.
const DRAWING: &str = "return [...document.querySelectorAll('#stage .body')].map(g => \
    g.getAttribute('transform')).concat([...document.querySelectorAll('.journal')].map(j => \
    j.getAttribute('cx') + ' ' + j.getAttribute('cy')))";

fn number(browser: &Browser, expression: &str) -> f64 {
    browser.run(&format!("return Number({expression})")).as_f64().expect(expression)
}

/// The time on the page, in s.
fn clock(browser: &Browser) -> f64 {
    number(browser, "parseFloat(document.querySelector('#clock').textContent)")
}

/// Waits until the page says so; what does not come within half a minute will not come.
fn wait(browser: &Browser, condition: &str) {
    let start = Instant::now();
    while browser.run(&format!("return {condition}")) != Value::Bool(true) {
        assert!(start.elapsed() < Duration::from_secs(30), "in vain: {condition}");
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// How many of two lists' entries differ.
fn differing(a: &Value, b: &Value) -> usize {
    let (a, b) = (a.as_array().unwrap(), b.as_array().unwrap());
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

#[test]
fn the_pages_of_a_run_work_in_a_browser() {
    let Some(browser) = Browser::start() else {
        println!("skipped: chromium not found");
        return;
    };
    let place = Place::new();
    place.good("run --duration 0.1 --out r");

    browser.open(&place.path("r/index.html"));
    assert_eq!(number(&browser, "document.querySelectorAll('figure svg').length"), 6.0);
    browser.click("a[href='player.html']");
    wait(
        &browser,
        "location.pathname.endsWith('player.html') && document.readyState == 'complete'",
    );

    // At the start: seven bodies, six journals in the middle of their rings.
    let start = browser.run(DRAWING);
    assert_eq!(start.as_array().unwrap().len(), 7 + 6, "{start}");
    let centred = |place: &Value| {
        place.as_str().unwrap().split(' ').all(|v| v.parse::<f64>().unwrap().abs() < 1e-6)
    };
    assert!((7..13).all(|i| centred(&start[i])), "{start}");
    assert_eq!(clock(&browser), 0.0);

    // Playing moves everything, pausing stops it.
    browser.click("#play");
    wait(&browser, "now > 0.005");
    browser.click("#play");
    let (paused, later) = (clock(&browser), browser.run(DRAWING));
    assert_eq!(differing(&start, &later), 13, "{later}");
    std::thread::sleep(Duration::from_millis(200));
    assert_eq!((clock(&browser), browser.run(DRAWING)), (paused, later));

    // The slider is dragged to the middle by a click there; keys step and jump.
    browser.click("#time");
    let middle = clock(&browser);
    assert!((middle - 0.05).abs() < 0.002, "{middle}");
    let there = browser.run(DRAWING);
    browser.press(RIGHT);
    assert!((clock(&browser) - middle - 5e-4).abs() < 1e-6);
    assert!(differing(&there, &browser.run(DRAWING)) > 0);
    browser.press(END);
    assert_eq!(clock(&browser), 0.1);

    // What is drawn is what the time series says: places in the ring, peaks since the row before.
    let csv = place.read("r/timeseries.csv");
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|c| *c == name).unwrap();
    let last = |name: &str| rows[rows.len() - 1][column(name)].parse::<f64>().unwrap();
    let journal = "document.querySelectorAll('.journal')[3]";
    let [x, y] =
        ["cx", "cy"].map(|name| number(&browser, &format!("{journal}.getAttribute('{name}')")));
    assert!((x.hypot(y) - last("ecc_C1") / 5e-4).abs() < 1e-5, "{x} {y}");
    let peak = |name: &str| {
        let values = rows[1..].iter().map(|row| row[column(name)].parse::<f64>().unwrap());
        values.fold(0.0, f64::max)
    };
    let strongest = ["A1", "A2", "A3", "C1", "C2", "C3"]
        .map(|joint| peak(&format!("force_{joint}_max")))
        .into_iter()
        .fold(0.0, f64::max);
    assert!((number(&browser, "strongest") / strongest - 1.0).abs() < 1e-6);

    // Every choice of curves draws them, each as wide as the plot but for its margins.
    for (chart, curves) in [6, 6, 2, 1].into_iter().enumerate() {
        browser.run(&format!(
            "const s = document.querySelector('#chart'); s.value = {chart}; \
             s.dispatchEvent(new Event('change'))"
        ));
        let drawn = "[...document.querySelectorAll('#plot .curve')].filter(c => \
                     c.getBBox().width > 0.8 * document.querySelector('#plot').clientWidth).length";
        assert_eq!(number(&browser, drawn), f64::from(curves), "curves {chart}");
    }
    browser.click("#legend input");
    assert_eq!(number(&browser, "document.querySelectorAll('#plot .curve').length"), 0.0);

    // The picture that moves.
    browser.open(&place.path("r/animation.svg"));
    let at = |seconds: f64| {
        browser.run(&format!(
            "const s = document.documentElement; s.pauseAnimations(); s.setCurrentTime({seconds}); \
             return [...document.querySelectorAll('.j')].map(j => {{ const m = j.getCTM(); \
             return m.e + ' ' + m.f; }})"
        ))
    };
    assert_eq!(differing(&at(1.0), &at(6.0)), 6);
    assert_eq!(browser.errors(), [""; 0]);
}
