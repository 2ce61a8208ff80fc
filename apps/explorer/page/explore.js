"use strict";
// Asks the server for the curve at the operating point of the sliders and draws it. The state stands behind the # of the address.

const byId = (id) => document.getElementById(id);
const pointsOfCurve = 25;
let model = null;
let asked = null; // the request under way

function svg(name, attributes, text) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

function shortest(value, digits = 4) {
  return String(Number(value.toFixed(digits)));
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

function isOfSetting(curve) {
  const same = (a, b) => a === null || Math.abs(a - b) <= 1e-6 * Math.abs(b);
  return same(curve.frequency_Hz, Number(byId("frequency").value)) && same(curve.drive, Number(byId("drive").value));
}

function draw(curve) {
  const points = curve.points.filter((point) => point.flow_l_per_min !== null);
  const flows = points.flatMap((point) => {
    const error = point.error_l_per_min ?? 0;
    return [point.flow_l_per_min - error, point.flow_l_per_min + error];
  });
  const heads = points.map((point) => point.head_mmHg);
  for (const measured of model.measured) {
    flows.push(...measured.flow_l_per_min);
    heads.push(...measured.head_mmHg);
  }
  const room = (values) => {
    const low = Math.min(...values), high = Math.max(...values);
    const margin = 0.04 * (high - low) || 1;
    return [low - margin, high + margin];
  };
  const [left, right, top, bottom] = [60, 625, 12, 390];
  const [lowFlow, highFlow] = room(flows), [lowHead, highHead] = room(heads);
  const x = (flow) => left + ((right - left) * (flow - lowFlow)) / (highFlow - lowFlow);
  const y = (head) => bottom - ((bottom - top) * (head - lowHead)) / (highHead - lowHead);
  const chart = byId("chart");
  chart.replaceChildren();
  for (const flow of ticks(lowFlow, highFlow, 8)) {
    chart.append(svg("line", { class: "grid", x1: x(flow), x2: x(flow), y1: top, y2: bottom }));
    chart.append(svg("text", { x: x(flow), y: bottom + 18, "text-anchor": "middle" }, shortest(flow)));
  }
  for (const head of ticks(lowHead, highHead, 8)) {
    chart.append(svg("line", { class: "grid", x1: left, x2: right, y1: y(head), y2: y(head) }));
    chart.append(svg("text", { x: left - 8, y: y(head) + 4, "text-anchor": "end" }, shortest(head)));
  }
  chart.append(svg("rect", { class: "frame", x: left, y: top, width: right - left, height: bottom - top }));
  chart.append(svg("text", { x: (left + right) / 2, y: bottom + 40, "text-anchor": "middle" }, "flow (l/min)"));
  chart.append(
    svg("text", { transform: `translate(16 ${(top + bottom) / 2}) rotate(-90)`, "text-anchor": "middle" }, "head (mmHg)"));

  // The band where the error is known; the line; the samples.
  const known = points.filter((point) => point.error_l_per_min !== null);
  const edge = (list, sign) =>
    list.map((point) => `${x(point.flow_l_per_min + sign * point.error_l_per_min)},${y(point.head_mmHg)}`);
  if (known.length > 1) {
    chart.append(svg("polygon", { class: "band", points: [...edge(known, -1), ...edge(known, 1).reverse()].join(" ") }));
  }
  const line = points.map((point) => `${x(point.flow_l_per_min)},${y(point.head_mmHg)}`).join(" ");
  chart.append(svg("polyline", { class: "curve", points: line }));
  for (const measured of model.measured) {
    const kind = isOfSetting(measured) ? "sample" : "sample other";
    measured.head_mmHg.forEach((head, i) => {
      chart.append(svg("circle", { class: kind, cx: x(measured.flow_l_per_min[i]), cy: y(head), r: 3 }));
    });
  }
  drawKey();
}

function drawKey() {
  const drive = model.ranges.drive;
  const entries = [["of-curve", model.level], ["of-band", "stated error"]];
  for (const measured of model.measured) {
    const setting = [
      measured.frequency_Hz === null ? "" : `${shortest(measured.frequency_Hz)} Hz`,
      measured.drive === null ? "" : `${drive.name} ${shortest(measured.drive)} ${drive.unit}`,
    ].filter(Boolean).join(", ");
    entries.push(isOfSetting(measured) ? ["of-data", `measured, ${setting}`] : ["of-other", `measured at another point: ${setting}`]);
  }
  byId("key").replaceChildren(...entries.map(([kind, text]) => {
    const item = document.createElement("li"), mark = document.createElement("span");
    mark.className = kind;
    item.append(mark, text);
    return item;
  }));
}

function list(curve) {
  const rows = curve.points.map((point) => {
    const row = document.createElement("tr");
    for (const key of ["head_mmHg", "flow_l_per_min", "error_l_per_min"]) {
      const cell = document.createElement("td");
      const value = point[key];
      cell.textContent = value === null ? (key === "error_l_per_min" ? "unknown" : "failed") : value.toFixed(key === "head_mmHg" ? 2 : 4);
      if (value !== null) cell.dataset.value = String(value); // every digit
      row.append(cell);
    }
    return row;
  });
  byId("numbers").tBodies[0].replaceChildren(...rows);
}

function say(curve) {
  const points = curve.points.filter((point) => point.flow_l_per_min !== null);
  const first = points[0], last = points[points.length - 1];
  byId("summary").textContent = points.length === 0 ? "The curve has no point." :
    `Flow ${shortest(first.flow_l_per_min, 2)} l/min at ${shortest(first.head_mmHg, 1)} mmHg, ` +
    `${shortest(last.flow_l_per_min, 2)} l/min at ${shortest(last.head_mmHg, 1)} mmHg.`;
  byId("remarks").replaceChildren(...curve.remarks.map((remark) => {
    const item = document.createElement("li");
    item.textContent = remark;
    return item;
  }));
}

function showValues() {
  byId("frequency-value").textContent = `${byId("frequency").value} Hz`;
  byId("drive-value").textContent = `${byId("drive").value} ${model.ranges.drive.unit}`;
}

/// No curve stays beside controls that say something else.
function fail(message) {
  byId("error").textContent = message;
  byId("chart").replaceChildren();
  byId("key").replaceChildren();
  byId("remarks").replaceChildren();
  byId("numbers").tBodies[0].replaceChildren();
  byId("summary").textContent = byId("status").textContent = "";
}

async function update() {
  showValues();
  const state = { frequency: byId("frequency").value, drive: byId("drive").value, low: byId("head-low").value, high: byId("head-high").value };
  history.replaceState(null, "", "#" + new URLSearchParams(state));
  asked?.abort();
  if (state.low === "" || state.high === "") return fail("The heads are not stated.");
  const low = Number(state.low), high = Number(state.high);
  const heads = low < high ? `${low}:${high}:${(high - low) / (pointsOfCurve - 1)}` : String(low);
  const request = (asked = new AbortController());
  const begin = performance.now();
  try {
    const query = new URLSearchParams({ frequency: state.frequency, drive: state.drive, heads });
    const response = await fetch("/curve?" + query, { signal: request.signal });
    const curve = await response.json();
    if (request !== asked) return;
    if (!response.ok) throw new Error(curve.error);
    byId("error").textContent = "";
    draw(curve);
    list(curve);
    say(curve);
    byId("status").textContent = `${curve.level}: ${curve.points.length} points in ${Math.round(performance.now() - begin)} ms`;
  } catch (error) {
    if (error.name === "AbortError") return;
    fail(error.message);
  }
}

/// A slider over a range; one without width stays where it is.
function setSlider(slider, range, wanted) {
  const width = range.high - range.low;
  slider.min = range.low;
  slider.max = range.high;
  slider.step = width > 0 ? Number((10 ** Math.floor(Math.log10(width / 50))).toPrecision(1)) : "any";
  slider.disabled = width === 0;
  slider.value = Number.isFinite(wanted) ? wanted : (range.low + range.high) / 2;
}

async function start() {
  try {
    const response = await fetch("/model");
    model = await response.json();
    if (!response.ok) throw new Error(model.error);
  } catch (error) {
    byId("error").textContent = `The model cannot be read: ${error.message}`;
    return;
  }
  const state = new URLSearchParams(location.hash.slice(1));
  const wanted = (name) => (state.has(name) ? Number(state.get(name)) : NaN);
  for (const range of Object.values(model.ranges)) {
    // What the conversion of units leaves in the last digits.
    range.low = Number(range.low.toPrecision(12));
    range.high = Number(range.high.toPrecision(12));
  }
  const { frequency, drive, head } = model.ranges;
  byId("model").textContent = `${model.model}, ${model.level}; ${shortest(head.low)} to ${shortest(head.high)} mmHg`;
  document.title = `${model.model} - Undula explorer`;
  byId("drive-label").textContent = drive.name === "voltage" ? "Voltage" : "Stroke";
  const measured = model.measured.find((curve) => curve.drive !== null && curve.frequency_Hz !== null);
  setSlider(byId("frequency"), frequency, state.has("frequency") ? wanted("frequency") : measured?.frequency_Hz);
  setSlider(byId("drive"), drive, state.has("drive") ? wanted("drive") : measured?.drive);
  for (const [id, fallback] of [["head-low", head.low], ["head-high", head.high]]) {
    const field = byId(id), value = wanted(id === "head-low" ? "low" : "high");
    field.min = head.low;
    field.max = head.high;
    field.step = "any";
    field.value = Number.isFinite(value) ? value : fallback;
  }
  byId("controls").addEventListener("input", update);
  byId("controls").addEventListener("submit", (event) => event.preventDefault());
  await update();
}

start();
