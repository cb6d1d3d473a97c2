//! The pages in a real browser.

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

/// At the start: seven bodies, six journals in the middle of their rings.
fn it_plays_and_pauses(browser: &Browser) {
    let start = browser.run(DRAWING);
    assert_eq!(start.as_array().unwrap().len(), 7 + 6, "{start}");
    let centred = |place: &Value| {
        place.as_str().unwrap().split(' ').all(|v| v.parse::<f64>().unwrap().abs() < 1e-6)
    };
    assert!((7..13).all(|i| centred(&start[i])), "{start}");
    assert_eq!(clock(browser), 0.0);

    // Playing moves everything, pausing stops it.
    browser.click("#play");
    wait(browser, "now > 0.005");
    browser.click("#play");
    let (paused, later) = (clock(browser), browser.run(DRAWING));
    assert_eq!(differing(&start, &later), 13, "{later}");
    std::thread::sleep(Duration::from_millis(200));
    assert_eq!((clock(browser), browser.run(DRAWING)), (paused, later));
}

/// The slider is dragged to the middle by a click there; keys step and jump.
fn it_goes_where_it_is_told(browser: &Browser) {
    browser.click("#time");
    let middle = clock(browser);
    assert!((middle - 0.05).abs() < 0.002, "{middle}");
    let there = browser.run(DRAWING);
    browser.press(RIGHT);
    assert!((clock(browser) - middle - 5e-4).abs() < 1e-6);
    assert!(differing(&there, &browser.run(DRAWING)) > 0);
    browser.press(END);
    assert_eq!(clock(browser), 0.1);
}

/// What is drawn is what the time series says: places in the ring, peaks since the row before.
fn it_draws_the_time_series(browser: &Browser, csv: &str) {
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|c| *c == name).unwrap();
    let last = |name: &str| rows[rows.len() - 1][column(name)].parse::<f64>().unwrap();
    let journal = "document.querySelectorAll('.journal')[3]";
    let [x, y] =
        ["cx", "cy"].map(|name| number(browser, &format!("{journal}.getAttribute('{name}')")));
    assert!((x.hypot(y) - last("ecc_C1") / 5e-4).abs() < 1e-5, "{x} {y}");
    let peak = |name: &str| {
        let values = rows[1..].iter().map(|row| row[column(name)].parse::<f64>().unwrap());
        values.fold(0.0, f64::max)
    };
    let strongest = ["A1", "A2", "A3", "C1", "C2", "C3"]
        .map(|joint| peak(&format!("force_{joint}_max")))
        .into_iter()
        .fold(0.0, f64::max);
    assert!((number(browser, "strongest") / strongest - 1.0).abs() < 1e-6);
}

/// Every choice of curves draws them, each as wide as the plot but for its margins.
fn it_draws_every_choice_of_curves(browser: &Browser) {
    for (chart, curves) in [6, 6, 2, 1].into_iter().enumerate() {
        browser.run(&format!(
            "const s = document.querySelector('#chart'); s.value = {chart}; \
             s.dispatchEvent(new Event('change'))"
        ));
        let drawn = "[...document.querySelectorAll('#plot .curve')].filter(c => \
                     c.getBBox().width > 0.8 * document.querySelector('#plot').clientWidth).length";
        assert_eq!(number(browser, drawn), f64::from(curves), "curves {chart}");
    }
    browser.click("#legend input");
    assert_eq!(number(browser, "document.querySelectorAll('#plot .curve').length"), 0.0);
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
    assert_eq!(number(&browser, "document.querySelectorAll('figure svg').length"), 7.0);
    browser.click("a[href='player.html']");
    wait(
        &browser,
        "location.pathname.endsWith('player.html') && document.readyState == 'complete'",
    );

    it_plays_and_pauses(&browser);
    it_goes_where_it_is_told(&browser);
    it_draws_the_time_series(&browser, &place.read("r/timeseries.csv"));
    it_draws_every_choice_of_curves(&browser);

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

/// Widths of a desk, a tablet and a phone in pixels.
const WIDTHS: [u32; 3] = [1400, 820, 390];

/// What is wrong with how a page is laid out, in words.
const FLAWS: &str = r#"
    const flaws = [];
    const root = document.documentElement;
    if (root.scrollWidth > root.clientWidth + 1) flaws.push(`scrolls sideways: ${root.scrollWidth} of ${root.clientWidth} px`);
    const inside = (a, b) => a.left >= b.left - 1.5 && a.right <= b.right + 1.5 && a.top >= b.top - 1.5 && a.bottom <= b.bottom + 1.5;
    const over = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1.5 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 2.5;
    const visible = (box) => box.width > 0 && box.height > 0;
    for (const svg of document.querySelectorAll("svg.picture, #plot")) {
        const frame = svg.getBoundingClientRect();
        if (!visible(frame)) flaws.push("a figure of no size");
        const texts = [...svg.querySelectorAll("text")].map((text) => [text.textContent.trim(), text.getBoundingClientRect()]).filter(([text, box]) => text && visible(box));
        texts.forEach(([text, box], i) => {
            if (!inside(box, frame)) flaws.push(`"${text}" is cut off`);
            for (const [other, its] of texts.slice(i + 1)) if (over(box, its)) flaws.push(`"${text}" lies over "${other}"`);
        });
        if (svg.matches(".picture") && !svg.querySelector("polyline, polygon, circle, path")) flaws.push("an empty figure");
        if (texts.some(([text]) => text === "no data")) flaws.push("a figure without data");
    }
    for (const cell of document.querySelectorAll("h1, h2, p, figcaption, td, th, nav a, button, label, .lead")) {
        if (cell.clientWidth && cell.scrollWidth > cell.clientWidth + 2) flaws.push(`"${cell.textContent.trim().slice(0, 40)}" is wider than its place`);
    }
    for (const table of document.querySelectorAll("table.rows")) {
        const rows = [...table.rows].map((row) => [...row.cells].map((cell) => cell.textContent.trim()));
        if (rows.length < 2) flaws.push("a table without rows");
        rows[0].forEach((head, i) => {
            if (rows.slice(1).every((row) => ["", "–"].includes(row[i]))) flaws.push(`nothing under "${head}"`);
        });
    }
    // Words that are broken where nobody would hyphenate them; names of files and hashes may be.
    for (const cell of document.querySelectorAll("h1, h2, p, figcaption, td, th, label, button")) {
        const texts = document.createTreeWalker(cell, NodeFilter.SHOW_TEXT);
        while (texts.nextNode()) {
            const text = texts.currentNode;
            if (text.parentElement.closest("code")) continue;
            const whole = (word) => [...text.data.matchAll(/\S+/g)].find((all) => all.index <= word.index && all.index + all[0].length > word.index);
            for (const word of text.data.matchAll(/\p{L}{2,}/gu)) {
                if (whole(word)[0].length > 25) continue;
                const range = document.createRange();
                range.setStart(text, word.index);
                range.setEnd(text, word.index + word[0].length);
                const tops = new Set([...range.getClientRects()].map((box) => Math.round(box.top)));
                if (tops.size > 1) flaws.push(`"${word[0]}" is broken`);
            }
        }
    }
    const letters = [...document.querySelectorAll(".card svg text")].filter((text) => visible(text.getBoundingClientRect())).map((text) => {
        const place = text.getScreenCTM();
        return parseFloat(getComputedStyle(text).fontSize) * Math.hypot(place.a, place.b);
    });
    const least = Math.min(...letters);
    if (least < 7) flaws.push(`letters of ${least} px`);
    const dark = matchMedia("(prefers-color-scheme: dark)").matches;
    const light = (colour) => { const [r, g, b] = colour.match(/[0-9.]+/g).map(Number); return r + g + b > 384; };
    for (const sheet of document.querySelectorAll("svg.picture > rect:first-of-type")) {
        if (light(getComputedStyle(sheet).fill) === dark) flaws.push(dark ? "a light figure in the dark" : "a dark figure in the light");
    }
    return [...new Set(flaws)];
"#;

/// Every kind of page, as a user makes it, in a folder of its own.
fn every_kind_of_page(place: &Place) -> Vec<&'static str> {
    let assets = concat!(env!("CARGO_MANIFEST_DIR"), "/assets");
    let (rig, three_legs) =
        (format!("{assets}/rigs-planar/planar-1"), format!("{assets}/rigs/rig-2"));
    let four_bar = format!("{assets}/mechanisms/four-bar.toml");
    let lines = [
        ("run", "run --duration 0.1".to_owned()),
        ("four-bar", format!("run {four_bar} --duration 0.1")),
        ("stage", format!("run {assets}/drive-stage.toml --duration 0.1")),
        ("ideal", "run --set contact.law=ideal --duration 0.1".to_owned()),
        (
            "sweep",
            "sweep --vary joints.clearance=1e-8..1e-3:log:3 --vary motion.phase=0..4:3 --duration 0.1".to_owned(),
        ),
        ("compare", "compare --steps 5e-5,2e-5,1e-5 --starts 2 --duration 0.1".to_owned()),
        ("by-law", "compare --laws hertz-step,flores,hunt-crossley --starts 2 --duration 0.1".to_owned()),
        ("paper", "paper --phases 2 --duration 0.05".to_owned()),
        ("record", format!("record {rig}/rig.toml --duration 1.2")),
        (
            "plan",
            format!("plan --rig {rig}/rig.toml --data {rig}/run-a.csv --detect payload --duration 1 --candidates 8"),
        ),
        ("predict", format!("predict {rig}/rig.toml --data {rig}/run-b.csv")),
        (
            "calibrate",
            "calibrate --rig record/rig.toml --data record/run-a.csv --validate record/run-b.csv".to_owned(),
        ),
        (
            "three-legs",
            format!("calibrate --rig {three_legs}/rig.toml --data {three_legs}/run-a.csv"),
        ),
        ("swings", format!("record {assets}/double-pendulum-declared.toml --duration 3")),
        ("windows", "predict swings/rig.toml --data swings/run-a.csv".to_owned()),
        (
            "wear",
            format!("wear {four_bar} --set contact.wear_coefficient=1e-12 --set joints.friction=0.1 --cycles 1e4"),
        ),
        ("diff", "diff run ideal".to_owned()),
        ("models", "diff run/scenario.toml ideal/scenario.toml --starts 2".to_owned()),
    ];
    for (out, line) in &lines {
        let done = place.freeplay(&format!("{line} --out {out}"));
        // A study of a tenth of a second need not come out right.
        assert!(done.code < 2, "{line}: {}", done.err);
    }
    lines.map(|(out, _)| out).into()
}

#[test]
fn every_page_reads_well_on_a_desk_a_tablet_and_a_phone_by_day_and_by_night() {
    let Some(browser) = Browser::start() else {
        println!("skipped: chromium not found");
        return;
    };
    let place = Place::new();
    let mut pages: Vec<String> =
        every_kind_of_page(&place).iter().map(|out| format!("{out}/index.html")).collect();
    pages.push("run/player.html".to_owned());
    let mut found = Vec::new();
    for page in &pages {
        for (width, dark) in WIDTHS.into_iter().flat_map(|width| [(width, false), (width, true)]) {
            browser.look(width, dark);
            browser.open(&place.path(page));
            let figures = number(&browser, "document.querySelectorAll('svg').length");
            if figures < 1.0 {
                found.push(format!("{page}: no figure"));
            }
            for flaw in browser.run(FLAWS).as_array().unwrap() {
                let light = if dark { "dark" } else { "light" };
                found.push(format!("{page} at {width} px, {light}: {}", flaw.as_str().unwrap()));
            }
        }
    }
    assert!(found.is_empty(), "{} flaws:\n{}", found.len(), found.join("\n"));
    assert_eq!(browser.errors(), [""; 0]);
}

#[test]
fn a_pointer_reads_values_off_a_figure_and_a_button_makes_it_larger() {
    let Some(browser) = Browser::start() else {
        println!("skipped: chromium not found");
        return;
    };
    let place = Place::new();
    place.good("run --duration 0.1 --out r");
    browser.look(820, false);
    browser.open(&place.path("r/index.html"));
    // In the middle of the plot of the path error.
    let said = browser.run(
        "const svg = document.querySelectorAll('svg[data-plots]')[1]; svg.scrollIntoView(); \
         const { left, top, width, height } = svg.getBoundingClientRect(); \
         svg.dispatchEvent(new PointerEvent('pointermove', { clientX: left + 0.55 * width, clientY: top + 0.4 * height, bubbles: true })); \
         return document.querySelector('.readout').hidden ? '' : document.querySelector('.readout').innerText",
    );
    let said = said.as_str().unwrap();
    assert!(said.starts_with("time (s): 0.0") && said.contains("distance: "), "{said}");
    // What it says is what the figure was drawn from: between 0 and what six clearances leave.
    let value: f64 = said.lines().nth(1).unwrap().rsplit(' ').next().unwrap().parse().unwrap();
    assert!((0.05..1.5).contains(&value), "{said}");
    let wide = "document.querySelector('.card svg').getBoundingClientRect().width";
    let before = number(&browser, wide);
    browser.click(".enlarge");
    assert!(number(&browser, wide) > 1.15 * before);
    browser.click(".enlarge");
    assert!((number(&browser, wide) - before).abs() < 1.0);
    assert_eq!(browser.errors(), [""; 0]);
}
