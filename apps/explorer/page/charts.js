"use strict";
// Charts: axes, bands, lines and points in an SVG.

const byId = (id) => document.getElementById(id);

function svg(name, attributes, text) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

function element(name, text, kind) {
  const made = document.createElement(name);
  if (text !== undefined) made.textContent = text;
  if (kind) made.className = kind;
  return made;
}

function shortest(value, digits = 4) {
  return String(Number(value.toFixed(digits)));
}

/// Four digits of any number: 0.01234, 1234, 1.2e-7.
function readable(value) {
  return String(Number(value.toPrecision(4)));
}

/// About `count` round numbers from low to high.
function ticks(low, high, count) {
  const raw = (high - low) / count || 1;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= raw);
  const found = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) found.push(i * step);
  return found;
}

/// Lowest and highest with a margin; nothing to draw for no number.
function room(values) {
  const low = Math.min(...values), high = Math.max(...values);
  const margin = 0.04 * (high - low) || 0.04 * Math.abs(high) || 1;
  return [low - margin, high + margin];
}

/// Draws `spec` into an SVG and returns where a point lies in it: {x, y, width, height of the view, xLabel, yLabel,
/// xRange, yRange, bands, lines, circles: [{kind, points: [[x, y], ...]}]}, in the units of the axes.
function drawChart(chart, spec) {
  const view = chart.viewBox.baseVal;
  const [left, right, top, bottom] = [66, view.width - 15, 12, view.height - 50];
  const [lowX, highX] = spec.xRange, [lowY, highY] = spec.yRange;
  const x = (value) => left + ((right - left) * (value - lowX)) / (highX - lowX);
  const y = (value) => bottom - ((bottom - top) * (value - lowY)) / (highY - lowY);
  chart.replaceChildren();
  for (const value of ticks(lowX, highX, 8)) {
    chart.append(svg("line", { class: "grid", x1: x(value), x2: x(value), y1: top, y2: bottom }));
    chart.append(svg("text", { x: x(value), y: bottom + 18, "text-anchor": "middle" }, readable(value)));
  }
  for (const value of ticks(lowY, highY, view.height > 350 ? 8 : 5)) {
    chart.append(svg("line", { class: "grid", x1: left, x2: right, y1: y(value), y2: y(value) }));
    chart.append(svg("text", { x: left - 8, y: y(value) + 4, "text-anchor": "end" }, readable(value)));
  }
  chart.append(svg("rect", { class: "frame", x: left, y: top, width: right - left, height: bottom - top }));
  chart.append(svg("text", { x: (left + right) / 2, y: bottom + 40, "text-anchor": "middle" }, spec.xLabel));
  chart.append(
    svg("text", { transform: `translate(16 ${(top + bottom) / 2}) rotate(-90)`, "text-anchor": "middle" }, spec.yLabel));
  const at = (points) => points.map(([a, b]) => `${x(a)},${y(b)}`).join(" ");
  for (const band of spec.bands ?? []) chart.append(svg("polygon", { class: band.kind, points: at(band.points) }));
  for (const line of spec.lines ?? []) chart.append(svg("polyline", { class: line.kind, points: at(line.points) }));
  for (const circle of spec.circles ?? []) {
    for (const [a, b] of circle.points) chart.append(svg("circle", { class: circle.kind, cx: x(a), cy: y(b), r: circle.radius ?? 3 }));
  }
  return { x, y, at, top, bottom };
}
