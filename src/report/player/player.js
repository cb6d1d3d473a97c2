"use strict";
// Everything on the page is a function of the time `now` (s); see `show`.
const { scene, thinned, frames } = JSON.parse(document.getElementById("data").textContent);
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const SPEEDS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
// In which the mark of a hit fades to a third: s on the viewer's clock, and at most so many simulated s, or the
// marks of many hits would stand at once.
const [FADE, LONGEST_FADE] = [0.3, 0.006];

// ---- The data: a row of numbers per frame -------------------------------------------------------
const numbers = new Float32Array(Uint8Array.from(atob(frames), (c) => c.charCodeAt(0)).buffer);
const signals = Math.max(scene.joints.length, ...scene.charts.flatMap((c) => c.curves.map((k) => k.signal + 1)));
const JOINTS = 1 + 3 * scene.bodies.length;
const DEVIATION = JOINTS + 2 * scene.joints.length;
const SIGNALS = DEVIATION + 2;
const ROW = SIGNALS + 2 * signals;
const count = Math.floor(numbers.length / ROW);
const number = (frame, column) => numbers[frame * ROW + column];
const time = (frame) => number(frame, 0);
const low = (frame, signal) => number(frame, SIGNALS + 2 * signal);
const high = (frame, signal) => number(frame, SIGNALS + 2 * signal + 1);
const end = count ? time(count - 1) : 0;

/** The last frame at or before t. */
function frameAt(t) {
  let [first, last] = [0, count - 1];
  while (first < last) {
    const middle = (first + last + 1) >> 1;
    if (time(middle) <= t) first = middle;
    else last = middle - 1;
  }
  return first;
}

/** A function that reads a column at time t: between frames on a straight line, unless frames are missing. */
function reader(t) {
  const k = frameAt(t);
  const next = Math.min(k + 1, count - 1);
  const share = thinned || next === k ? 0 : (t - time(k)) / (time(next) - time(k));
  const linear = (column) => number(k, column) + share * (number(next, column) - number(k, column));
  const angle = (column) => {
    const turn = number(next, column) - number(k, column);
    return number(k, column) + share * Math.atan2(Math.sin(turn), Math.cos(turn));
  };
  return { linear, angle };
}

// ---- Drawing ------------------------------------------------------------------------------------
function add(parent, tag, attributes = {}, text = "") {
  const svg = parent instanceof SVGElement || tag === "svg";
  const element = svg ? document.createElementNS("http://www.w3.org/2000/svg", tag) : document.createElement(tag);
  set(element, attributes);
  element.textContent = text;
  return parent.appendChild(element);
}
function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
}
const path = (points, close = "") =>
  points.length ? "M" + points.map(([x, y]) => `${+x.toPrecision(6)} ${+(-y).toPrecision(6)}`).join("L") + close : "";

const digits = (value) => Number(value.toPrecision(3)).toString();
function length(metres) {
  const [factor, unit] = [[1e9, "nm"], [1e6, "µm"], [1e3, "mm"]].find(([f]) => metres * f < 1000) ?? [1, "m"];
  return `${digits(metres * factor)} ${unit}`;
}

// ---- The machine: metres, y upwards -------------------------------------------------------------
const stage = document.getElementById("stage");
const machine = [];
const bearings = [];
const pathOf = (frame, deviated) => {
  const [x, y, angle] = [0, 1, 2].map((n) => number(frame, 1 + 3 * scene.tracked + n));
  const [u, v] = scene.tracked_point;
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const place = [x + c * u - s * v, y + s * u + c * v];
  return place.map((at, i) => at - (deviated ? number(frame, DEVIATION + i) : 0));
};
const stretch = [...Array(count).keys()];
let track;

function outline(parent, { points, closed, width_m: width }) {
  const d = path(points, closed ? "Z" : "");
  const kind = closed ? "outline closed" : "outline";
  add(parent, "path", { d, class: kind, "stroke-width": width });
  if (!closed) add(parent, "path", { d, class: "outline skin", "stroke-width": 0.8 * width });
}

function buildMachine() {
  const everywhere = scene.ground.flatMap((o) => o.points);
  const sample = Math.max(1, Math.floor(count / 50));
  for (let k = 0; k < count; k += sample) {
    scene.bodies.forEach((body, i) => {
      const [x, y, angle] = [0, 1, 2].map((n) => number(k, 1 + 3 * i + n));
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      for (const o of body.outlines) for (const [u, v] of o.points) everywhere.push([x + c * u - s * v, y + s * u + c * v]);
    });
  }
  const [xs, ys] = [everywhere.map((p) => p[0]), everywhere.map((p) => -p[1])];
  const [left, top] = [Math.min(...xs), Math.min(...ys)];
  const [width, height] = [Math.max(...xs) - left, Math.max(...ys) - top];
  const size = Math.max(width, height);
  const margin = 0.1 * size;
  set(stage, { viewBox: [left - margin, top - margin, width + 2 * margin, height + 2 * margin].join(" ") });
  const ground = add(stage, "g", { class: "ground" });
  for (const o of scene.ground) outline(ground, o);
  for (const body of scene.bodies) {
    const group = add(stage, "g", { class: "body" });
    add(group, "title", {}, body.name);
    for (const o of body.outlines) outline(group, o);
    machine.push(group);
  }
  const thin = { "vector-effect": "non-scaling-stroke" };
  add(stage, "path", { class: "ideal", d: path(stretch.map((k) => pathOf(k, true))), ...thin });
  track = add(stage, "path", { class: "track", "stroke-width": 2, ...thin });
  scene.joints.forEach((joint, i) => {
    const group = add(stage, "g");
    const radius = Math.max(joint.radius_m, 0.012 * size);
    add(group, "circle", { class: "bearing", r: radius, stroke: COLOURS[i % 6], "stroke-width": 0.006 * size });
    const glow = add(group, "circle", { r: 2 * radius, fill: "var(--force)", opacity: 0 });
    const text = add(group, "text", { x: 1.5 * radius, y: -1.5 * radius }, joint.name);
    text.style.fontSize = `${0.032 * size}px`;
    bearings.push({ group, glow });
  });
}

function showMachine({ linear, angle }) {
  const poses = machine.map((group, i) => {
    const [x, y, turn] = [linear(1 + 3 * i), linear(2 + 3 * i), angle(3 + 3 * i)];
    group.setAttribute("transform", `translate(${x} ${-y}) rotate(${(-turn * 180) / Math.PI})`);
    return { x, y, c: Math.cos(turn), s: Math.sin(turn) };
  });
  bearings.forEach(({ group, glow }, i) => {
    const { body, point: [u, v] } = scene.joints[i];
    const { x, y, c, s } = body === null ? { x: 0, y: 0, c: 1, s: 0 } : poses[body];
    group.setAttribute("transform", `translate(${x + c * u - s * v} ${-(y + s * u + c * v)})`);
    glow.setAttribute("opacity", 0.7 * hits[i].strength);
  });
  const k = frameAt(now);
  const step = Math.ceil((k + 1) / 2000);
  const points = stretch.slice(0, k + 1).filter((n) => n % step === 0).map((n) => pathOf(n, false));
  const { x: left, y: low, c, s } = poses[scene.tracked];
  const [u, v] = scene.tracked_point;
  const [x, y] = [left + c * u - s * v, low + s * u + c * v];
  track.setAttribute("d", path([...points, [x, y]]));
}

// ---- The joints: one clearance is one unit ------------------------------------------------------
const hardest = scene.joints.map((_, i) => stretch.reduce((most, k) => Math.max(most, high(k, i)), 0));
const strongest = Math.max(...hardest, 1e-30);
let hits = [];
const circles = [];

/** The hit that leaves the brightest mark at t: its force, where, and what is left of the mark (0 to 1). */
function mark(joint, t) {
  const fade = Math.min(FADE / SPEEDS[speed.value], LONGEST_FADE);
  let best = { strength: 0, force: 0, direction: [1, 0] };
  if (scene.joints[joint].clearance_m === null) return best;
  const k = Math.min(frameAt(t) + 1, count - 1);
  // The force of a frame is the largest since the frame before.
  for (let n = time(k) > t && k > 0 && time(k - 1) === t ? k - 1 : k; n > 0 && t - time(n) < 4 * fade; n--) {
    const force = high(n, joint);
    const strength = Math.sqrt(force / strongest) * Math.exp(-Math.max(0, t - time(n)) / fade);
    if (strength > best.strength) {
      best = { strength, force, direction: [0, 1].map((i) => number(n, JOINTS + 2 * joint + i)) };
    }
  }
  return best;
}

/** What a signal is at the frame shown: of the largest and the smallest since the frame before the one farther from 0. */
function instant(signal) {
  const k = frameAt(now);
  const [least, most] = [low(k, signal), high(k, signal)];
  return Math.abs(least) > Math.abs(most) ? least : most;
}

function buildJoints() {
  const place = document.getElementById("joints");
  scene.joints.forEach((joint, i) => {
    if (joint.clearance_m === null) return;
    const figure = add(place, "figure", { class: "joint" });
    const svg = add(figure, "svg", { viewBox: "-1.75 -1.75 3.5 3.5", role: "img", "aria-label": `Joint ${joint.name}, magnified` });
    add(svg, "circle", { class: "room", r: 1.5, style: `stroke:${COLOURS[i % 6]};stroke-width:.08` });
    add(svg, "circle", { r: 1, fill: "none", stroke: "var(--edge)", "stroke-width": 0.012, "stroke-dasharray": ".06 .05" });
    const glow = add(svg, "path", { class: "glow" });
    const orbit = add(svg, "path", { class: "orbit" });
    const journal = add(svg, "circle", { class: "journal", r: 0.5 });
    add(svg, "circle", { r: 0.05, fill: "var(--track)" });
    const centre = svg.lastChild;
    const arrow = add(svg, "path", { class: "arrow" });
    const caption = add(figure, "figcaption");
    const name = add(caption, "b", { style: `color:${COLOURS[i % 6]}` }, joint.name);
    circles.push({ i, glow, orbit, journal, centre, arrow, name, force: add(caption, "span") });
    add(figure, "small", {}, `clearance ${length(joint.clearance_m)}`);
  });
  if (!circles.length) place.remove();
}

function showJoints({ linear }) {
  const k = frameAt(now);
  for (const { i, glow, orbit, journal, centre, arrow, force } of circles) {
    const clearance = scene.joints[i].clearance_m;
    const column = JOINTS + 2 * i;
    const here = [linear(column) / clearance, linear(column + 1) / clearance];
    const trail = [];
    for (let n = Math.max(0, k - 120); n <= k; n++) trail.push([number(n, column) / clearance, number(n, column + 1) / clearance]);
    if (!thinned) orbit.setAttribute("d", path([...trail, here]));
    for (const element of [journal, centre]) set(element, { cx: here[0], cy: -here[1] });
    const hit = hits[i];
    // The number is the instant's, as in the legend of the curves; the mark fades after the hit.
    force.textContent = `${digits(instant(i))} N`;
    const towards = Math.atan2(hit.direction[1], hit.direction[0]);
    const at = (radius, turn = 0) => [radius * Math.cos(towards + turn), radius * Math.sin(towards + turn)];
    // The force on the journal, from the ring inwards; the square root lets weak hits be seen.
    const long = 1.35 * Math.sqrt(hit.force / strongest);
    const [tip, head] = [1.5 - long, Math.min(0.16, 0.5 * long)];
    const shown = Math.min(1, 1.6 * hit.strength / Math.max(1e-9, Math.sqrt(hit.force / strongest)));
    const turn = head / Math.max(0.3, tip + head);
    set(arrow, { d: path([at(1.5), at(tip), at(tip + head, 0.6 * turn), at(tip + head, -0.6 * turn), at(tip)]), opacity: hit.force && !thinned ? shown : 0 });
    // Where frames are missing, so is the place of the hit: the whole ring lights up.
    const arc = Array.from({ length: 31 }, (_, n) => at(1.5, (thinned ? Math.PI / 15 : 0.024) * (n - 15)));
    set(glow, { d: path(arc), opacity: hit.force ? Math.min(1, 1.5 * hit.strength) : 0 });
  }
}

// ---- The curves ---------------------------------------------------------------------------------
const [plot, legend] = ["plot", "legend"].map((id) => document.getElementById(id));
const hidden = new Set();
const readings = [];
const EDGE = { left: 52, right: 8, top: 18, bottom: 24 };
let cursor;
let shown; // from and to of the stretch shown, s

const chart = () => scene.charts[document.getElementById("chart").value];
const windowLength = () => Number(document.getElementById("window").value) || end;
const xOf = (t) => EDGE.left + ((t - shown[0]) / (shown[1] - shown[0] || 1)) * (plot.clientWidth - EDGE.left - EDGE.right);
// A joint's curve has the colour of its ring: its signal is its place among the joints.
const colour = (i) => {
  const { signal } = chart().curves[i];
  const joint = scene.joints[signal] ? signal : i;
  return COLOURS[joint % COLOURS.length];
};

function ticks(from, to, most) {
  const rough = (to - from) / most || 1;
  const decade = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * decade).find((s) => s >= rough * 0.999);
  const first = Math.ceil(from / step - 1e-6);
  return Array.from({ length: Math.max(0, Math.floor(to / step + 1e-6) - first + 1) }, (_, n) => +((first + n) * step).toPrecision(9));
}

function drawCurves() {
  const [width, height] = [plot.clientWidth, plot.clientHeight];
  const long = windowLength();
  const from = Math.min(Math.max(0, now - long / 2), end - long);
  shown = [from, from + long];
  const [first, last] = [frameAt(from), Math.min(count - 1, frameAt(from + long) + 1)];
  const curves = chart().curves.filter((c) => !hidden.has(c.name));
  let [bottom, top] = [0, 0];
  for (const { signal } of curves) {
    for (let k = 0; k < count; k++) {
      bottom = Math.min(bottom, low(k, signal));
      top = Math.max(top, high(k, signal));
    }
  }
  if (bottom === top) top = 1;
  const yOf = (v) => height - EDGE.bottom - ((v - bottom) / (top - bottom)) * (height - EDGE.top - EDGE.bottom);
  plot.replaceChildren();
  set(plot, { viewBox: `0 0 ${width} ${height}` });
  for (const v of ticks(bottom, top, 5)) {
    add(plot, "line", { class: "grid", x1: EDGE.left, x2: width - EDGE.right, y1: yOf(v), y2: yOf(v) });
    add(plot, "text", { x: EDGE.left - 6, y: yOf(v) + 4, "text-anchor": "end" }, v);
  }
  for (const t of ticks(...shown, Math.max(2, width / 90))) {
    add(plot, "text", { x: xOf(t), y: height - 8, "text-anchor": t > shown[1] - 0.04 * long ? "end" : "middle" }, `${t} s`);
  }
  add(plot, "text", { x: EDGE.left, y: 11 }, `${chart().title} (${chart().unit})`);
  for (const c of curves) {
    const points = [];
    for (let k = first; k <= last; k++) {
      const x = xOf(time(k));
      if (x < EDGE.left - 1 || x > width - EDGE.right + 1) continue;
      points.push([x, -yOf(low(k, c.signal))]);
      if (high(k, c.signal) !== low(k, c.signal)) points.push([x, -yOf(high(k, c.signal))]);
    }
    const own = c.reference ? { class: "curve reference" } : { class: "curve", stroke: colour(chart().curves.indexOf(c)) };
    add(plot, "path", { d: path(points), ...own });
  }
  cursor = add(plot, "line", { class: "cursor", y1: EDGE.top - 4, y2: height - EDGE.bottom });
}

function buildLegend() {
  legend.replaceChildren();
  hidden.clear();
  readings.length = 0;
  chart().curves.forEach((c, i) => {
    const label = add(legend, "label", c.reference ? {} : { style: `color:${colour(i)}` });
    const box = add(label, "input", { type: "checkbox" });
    box.checked = true;
    box.addEventListener("change", () => {
      hidden[box.checked ? "delete" : "add"](c.name);
      drawCurves();
      show();
    });
    add(label, "span", {}, ` ${c.name} `);
    readings.push({ value: add(label, "span"), signal: c.signal });
  });
  drawCurves();
}

function showCurves() {
  if (windowLength() < end) drawCurves();
  const x = xOf(now);
  set(cursor, { x1: x, x2: x });
  for (const { value, signal } of readings) {
    value.textContent = digits(instant(signal));
  }
}

// ---- Time ---------------------------------------------------------------------------------------
const [play, slider, clock, speed] = ["play", "time", "clock", "speed"].map((id) => document.getElementById(id));
let now = 0;
let playing = false;
let before = 0;

function show() {
  const read = reader(now);
  hits = scene.joints.map((_, i) => mark(i, now));
  showMachine(read);
  showJoints(read);
  showCurves();
  slider.value = frameAt(now);
  clock.textContent = `${now.toFixed(end < 10 ? 4 : 2)} s`;
  slider.setAttribute("aria-valuetext", clock.textContent);
}

function go(t) {
  now = Math.min(Math.max(0, t), end);
  show();
}

function setPlaying(on) {
  if (on && now >= end) now = 0;
  playing = on;
  play.textContent = on ? "❚❚" : "▶";
  play.setAttribute("aria-label", on ? "Pause" : "Play");
  before = performance.now();
  if (on) requestAnimationFrame(tick);
}

function tick(clockTime) {
  if (!playing) return;
  go(now + Math.max(0, clockTime - before) / 1000 / SPEEDS[speed.value]);
  before = clockTime;
  if (now >= end) setPlaying(false);
  else requestAnimationFrame(tick);
}

function pause(t) {
  setPlaying(false);
  go(t);
}

const step = (frames) => pause(time(Math.min(Math.max(0, frameAt(now) + frames), count - 1)));
const faster = (by) => {
  speed.value = Math.min(Math.max(0, Number(speed.value) + by), SPEEDS.length - 1);
  show();
};
const KEYS = {
  " ": () => setPlaying(!playing),
  ArrowLeft: (event) => step(event.shiftKey ? -10 : -1),
  ArrowRight: (event) => step(event.shiftKey ? 10 : 1),
  ArrowUp: () => faster(-1),
  ArrowDown: () => faster(1),
  Home: () => pause(0),
  End: () => pause(end),
};

function start() {
  set(slider, { max: count - 1 });
  for (const [i, n] of SPEEDS.entries()) add(speed, "option", { value: i }, `1:${n}`);
  speed.value = SPEEDS.indexOf(thinned ? 1 : 50);
  scene.charts.forEach((c, i) => add(document.getElementById("chart"), "option", { value: i }, c.title));
  const choices = document.getElementById("window");
  add(choices, "option", { value: "" }, "whole run");
  for (const n of [1, 0.1, 0.02]) if (n < end) add(choices, "option", { value: n }, n < 1 ? `${1000 * n} ms` : `${n} s`);
  const gap = digits(1000 * (time(Math.min(1, count - 1)) - time(0)));
  document.getElementById("note").textContent =
    `One frame each ${gap} ms` + (thinned ? " (a long run: instants between are left out; no peak is). " : ", straight lines between. ") +
    (circles.length ? "In the joints the ring is drawn so that its clearance fills it; the blue dot is the journal's centre, and touches the dashed " +
      "circle when journal and ring touch. " + (thinned ? "The ring lights up with the largest contact force since the frame before. Shorter runs show " +
      "every row, with the direction of the hits." : "Arrow and glow: largest contact force on the journal since the frame before, " +
      `along the line of centres, fading after the hit; the arrow grows with the square root of the force, the longest is ${digits(strongest)} N.`) : "");
  play.addEventListener("click", () => setPlaying(!playing));
  slider.addEventListener("input", () => pause(time(Number(slider.value))));
  speed.addEventListener("change", show);
  document.getElementById("chart").addEventListener("change", () => { buildLegend(); show(); });
  choices.addEventListener("change", () => { drawCurves(); show(); });
  document.addEventListener("keydown", (event) => {
    const { target, key } = event;
    if (!KEYS[key] || target.matches("select") || (key === " " && target.matches("button, [type=checkbox]"))) return;
    event.preventDefault();
    KEYS[key](event);
  });
  const choose = (event) => {
    const { clientX, buttons } = event;
    if (!buttons) return;
    // A drag chooses a time, not the text beside it.
    event.preventDefault();
    const { left, width } = plot.getBoundingClientRect();
    pause(shown[0] + ((clientX - left - EDGE.left) / (width - EDGE.left - EDGE.right)) * (shown[1] - shown[0]));
  };
  plot.addEventListener("pointerdown", (event) => {
    plot.setPointerCapture(event.pointerId);
    choose(event);
  });
  plot.addEventListener("pointermove", choose);
  new ResizeObserver(() => { drawCurves(); show(); }).observe(plot);
  buildLegend();
  show();
}

buildMachine();
buildJoints();
if (count) start();
