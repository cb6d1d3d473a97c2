"use strict";
// A convenience only: a button shows a picture as large as the window and wider, a second one puts it back; a pointer over a
// curve reads its values.
for (const card of document.querySelectorAll(".card")) {
  const button = document.createElement("button");
  button.type = "button";
  button.className = "enlarge";
  const say = () => { button.textContent = card.classList.contains("enlarged") ? "Close" : "Enlarge"; };
  button.addEventListener("click", () => { card.classList.toggle("enlarged"); say(); });
  say();
  card.prepend(button);
}
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") document.querySelector(".enlarged .enlarge")?.click();
});

// ---- Read-outs ----------------------------------------------------------------------------------
const readout = document.body.appendChild(document.createElement("div"));
readout.className = "readout";
readout.hidden = true;
const digits = (value) => Number(value.toPrecision(4)).toString();

/** The points of the curves of a plot, curve by curve, as the picture draws them. */
function curvesOf(picture, { area: [left, top, width, height], curves }) {
  const inside = ([x, y]) => x >= left - 5 && x <= left + width + 5 && y >= top - 5 && y <= top + height + 5;
  return curves.map(([name, colour]) => {
    const points = [];
    for (const line of picture.querySelectorAll(`polyline[stroke="${colour}"]`)) {
      for (const pair of line.getAttribute("points").trim().split(/\s+/)) points.push(pair.split(",").map(Number));
    }
    for (const dot of picture.querySelectorAll(`circle[fill="${colour}"]`)) {
      points.push([Number(dot.getAttribute("cx")), Number(dot.getAttribute("cy"))]);
    }
    return { name, colour, points: points.filter(inside) };
  });
}

for (const picture of document.querySelectorAll("svg[data-plots]")) {
  const plots = JSON.parse(picture.dataset.plots);
  const cursor = document.createElementNS(picture.namespaceURI, "line");
  cursor.setAttribute("class", "cursor");
  picture.append(cursor);
  const hide = () => { readout.hidden = true; cursor.setAttribute("visibility", "hidden"); };
  hide();
  picture.addEventListener("pointerleave", hide);
  picture.addEventListener("pointermove", (event) => {
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(picture.getScreenCTM().inverse());
    const plot = plots.find(({ area: [left, top, width, height] }) => x >= left && x <= left + width && y >= top && y <= top + height);
    if (!plot) return hide();
    plot.points ??= curvesOf(picture, plot);
    const [left, top, width, height] = plot.area;
    const value = (share, [from, to], log) => (log ? 10 ** (from + share * (to - from)) : from + share * (to - from));
    const xOf = (at) => value((at - left) / width, plot.x, plot.log[0]);
    const yOf = (at) => value(1 - (at - top) / height, plot.y, plot.log[1]);
    const rows = [`${plot.labels[0]}: ${digits(xOf(x))}`];
    for (const { name, points } of plot.points) {
      const near = points.reduce((best, point) => (!best || Math.abs(point[0] - x) < Math.abs(best[0] - x) ? point : best), null);
      if (near && Math.abs(near[0] - x) < 0.03 * width) rows.push(`${name}: ${digits(yOf(near[1]))}`);
    }
    rows[0] += rows.length > 1 ? `, ${plot.labels[1]}` : "";
    readout.replaceChildren(...rows.map((text) => Object.assign(document.createElement("div"), { textContent: text })));
    readout.hidden = false;
    const [wide, high] = [readout.offsetWidth, readout.offsetHeight];
    readout.style.left = `${Math.max(4, Math.min(event.clientX + 14, document.documentElement.clientWidth - wide - 4))}px`;
    readout.style.top = `${Math.max(4, Math.min(event.clientY + 14, innerHeight - high - 4))}px`;
    for (const [name, at] of Object.entries({ x1: x, x2: x, y1: top, y2: top + height })) cursor.setAttribute(name, at);
    cursor.setAttribute("visibility", "visible");
  });
}
