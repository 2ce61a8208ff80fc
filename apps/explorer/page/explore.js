"use strict";
// Asks the server for curve, point and period at the state of the controls and shows them. The state stands behind the # of
// the address.

const pointsOfCurve = 25, everyCoarse = 6; // a model that takes long is asked for every sixth head first
const mostCompared = 3;
let all = null; // what the server knows
let asked = null; // the requests under way
let shown = null; // the curve on the page
let othersShown = []; // curves beside it
let pointShown = null; // at the chosen head

// Quantities of a point: [place in the answer, words, digits].
const quantities = [
  ["holder.stroke_mm", "stroke of the holder (mm)"],
  ["hydraulic_power_mW", "hydraulic power (mW)"],
  ["holder_power_mW", "power of the holder (mW)"],
  ["holder.actuator_power_mW", "power of the actuator (mW)"],
  ["holder.electrical_power_mW", "electrical power (mW)"],
  ["holder.efficiency_percent", "efficiency (%)"],
  ["clearance_min_mm", "least clearance (mm)"],
  ["speed_max_cm_per_s", "greatest speed (cm/s)"],
  ["blood.scalar_stress_max_Pa", "greatest shear stress, scalar (Pa)"],
  ["blood.stressed_volume_mm3", "volume beyond the threshold of stress (mm³)"],
];

const model = () => all.models[Number(byId("model-number").value)];
const driveName = () => model().ranges.drive.name;
const driveKey = () => (driveName() === "voltage" ? "voltage_V" : "stroke_mm");
const quantityOf = (point, place) => place.split(".").reduce((part, name) => part?.[name] ?? null, point);

function state() {
  const found = { model: byId("model-number").value };
  for (const id of ["frequency", "drive", "head"]) found[id] = byId(id).value;
  found.low = byId("head-low").value;
  found.high = byId("head-high").value;
  found.quantity = byId("quantity").value;
  if (byId("tolerance").value !== "") found.tolerance = byId("tolerance").value;
  const beside = [...document.querySelectorAll("#other-list input:checked")].map((box) => box.value);
  if (all.models.length > 1) found.beside = beside.join(".");
  return found;
}

async function ask(path, question, signal) {
  const response = await fetch(`${path}?${new URLSearchParams(question)}`, { signal });
  const answer = await response.json();
  if (!response.ok) throw new Error(answer.error);
  return answer;
}

function isOfSetting(curve) {
  const same = (a, b) => a === null || Math.abs(a - b) <= 1e-6 * Math.abs(b);
  return same(curve.frequency_Hz, Number(byId("frequency").value)) && same(curve[driveName()], Number(byId("drive").value));
}

const drawn = (curve) => curve.points.filter((point) => point.flow_l_per_min !== null);

/// The chosen head, where it lies on the curve that is drawn.
function hereOnCurve() {
  const heads = shown.points.map((point) => point.head_mmHg);
  const inside = pointShown !== null && pointShown.head_mmHg >= Math.min(...heads) && pointShown.head_mmHg <= Math.max(...heads);
  return inside && pointShown.flow_l_per_min !== null ? [[pointShown.flow_l_per_min, pointShown.head_mmHg]] : [];
}

function draw() {
  const points = drawn(shown);
  const flows = points.flatMap((point) => {
    const error = point.error_l_per_min ?? 0;
    return [point.flow_l_per_min - error, point.flow_l_per_min + error];
  });
  const heads = points.map((point) => point.head_mmHg);
  for (const curve of othersShown) flows.push(...drawn(curve).map((point) => point.flow_l_per_min));
  for (const measured of all.measured) {
    flows.push(...measured.flow_l_per_min);
    heads.push(...measured.head_mmHg);
  }
  const known = points.filter((point) => point.error_l_per_min !== null);
  const edge = (sign) => known.map((point) => [point.flow_l_per_min + sign * point.error_l_per_min, point.head_mmHg]);
  const line = (curve) => drawn(curve).map((point) => [point.flow_l_per_min, point.head_mmHg]);
  drawChart(byId("chart"), {
    xLabel: "flow (l/min)", yLabel: "head (mmHg)", xRange: room(flows), yRange: room(heads),
    bands: known.length > 1 ? [{ kind: "band", points: [...edge(-1), ...edge(1).reverse()] }] : [],
    lines: [
      ...othersShown.map((curve, i) => ({ kind: `curve beside-${i + 1}`, points: line(curve) })),
      { kind: "curve", points: line(shown) },
    ],
    circles: [
      ...all.measured.map((measured) => ({
        kind: isOfSetting(measured) ? "sample" : "sample other",
        points: measured.head_mmHg.map((head, i) => [measured.flow_l_per_min[i], head]),
      })),
      { kind: "here", radius: 6, points: hereOnCurve() },
    ],
  });
  drawKey();
  drawQuantity();
}

function drawKey() {
  const drive = model().ranges.drive;
  const entries = [["of-here", "the chosen head"], ["of-curve", shown.level === "hybrid" ? "first model within the tolerance" : `${model().model}, ${shown.level}`], ["of-band", "stated error"]];
  othersShown.forEach((curve, i) => entries.push([`of-beside-${i + 1}`, `${curve.model}, ${curve.level}`]));
  for (const measured of all.measured) {
    const setting = [
      measured.frequency_Hz === null ? "" : `${shortest(measured.frequency_Hz)} Hz`,
      measured[drive.name] === null ? "" : `${drive.name} ${shortest(measured[drive.name])} ${drive.unit}`,
    ].filter(Boolean).join(", ");
    entries.push(isOfSetting(measured) ? ["of-data", `measured, ${setting}`] : ["of-other", `measured at another point: ${setting}`]);
  }
  byId("key").replaceChildren(...entries.map(([kind, text]) => {
    const item = element("li");
    item.append(element("span", undefined, kind), text);
    return item;
  }));
}

function drawQuantity() {
  const place = byId("quantity").value;
  const words = quantities.find(([name]) => name === place)[1];
  const of = (curve) => curve.points.map((point) => [point.head_mmHg, quantityOf(point, place)]).filter(([, value]) => value !== null);
  const lines = [...othersShown.map((curve, i) => ({ kind: `curve beside-${i + 1}`, points: of(curve) })), { kind: "curve", points: of(shown) }]
    .filter((line) => line.points.length > 0);
  byId("quantity-chart").replaceChildren();
  if (lines.length > 0) {
    const points = lines.flatMap((line) => line.points);
    drawChart(byId("quantity-chart"), {
      xLabel: "head (mmHg)", yLabel: words, xRange: room(points.map(([head]) => head)), yRange: room(points.map(([, value]) => value)), lines,
    });
  }
  const own = of(shown);
  byId("quantity-summary").textContent = own.length === 0 ? `${model().model} does not know: ${words}.` :
    `${words}: ${readable(own[0][1])} at ${readable(own[0][0])} mmHg, ${readable(own[own.length - 1][1])} at ${readable(own[own.length - 1][0])} mmHg.`;
}

/// A cell that shows some digits and keeps all of them.
function cell(value, text) {
  const made = element("td", text);
  if (typeof value === "number") made.dataset.value = String(value);
  return made;
}

function list() {
  const known = quantities.filter(([place]) => shown.points.some((point) => quantityOf(point, place) !== null));
  const tiers = shown.points.some((point) => point.tier);
  const titles = ["head (mmHg)", "flow (l/min)", "stated error (l/min)", ...known.map(([, words]) => words), ...(tiers ? ["answered by", "because"] : [])];
  byId("numbers").tHead.rows[0].replaceChildren(...titles.map((title) => {
    const head = element("th", title);
    head.scope = "col";
    return head;
  }));
  byId("numbers").tBodies[0].replaceChildren(...shown.points.map((point) => {
    const row = element("tr");
    row.append(
      cell(point.head_mmHg, point.head_mmHg.toFixed(2)),
      cell(point.flow_l_per_min, point.flow_l_per_min?.toFixed(4) ?? "failed"),
      cell(point.error_l_per_min, point.error_l_per_min?.toFixed(4) ?? "unknown"),
      ...known.map(([place]) => quantityOf(point, place)).map((value) => cell(value, value === null ? "unknown" : readable(value))),
      ...(tiers ? [cell(null, point.tier), cell(null, point.why)] : []));
    return row;
  }));
}

function say() {
  const points = drawn(shown);
  const first = points[0], last = points[points.length - 1];
  byId("summary").textContent = points.length === 0 ? "The curve has no point." :
    `Flow ${shortest(first.flow_l_per_min, 2)} l/min at ${shortest(first.head_mmHg, 1)} mmHg, ` +
    `${shortest(last.flow_l_per_min, 2)} l/min at ${shortest(last.head_mmHg, 1)} mmHg.`;
  byId("remarks").replaceChildren(...shown.remarks.map((remark) => element("li", remark)));
}

function showPoint(answer) {
  const point = (pointShown = answer.points[0]);
  const rows = [
    ["flow (l/min)", point.flow_l_per_min], ["stated error (l/min)", point.error_l_per_min],
    ...quantities.map(([place, words]) => [words, quantityOf(point, place)]),
  ];
  byId("point").replaceChildren(...rows.flatMap(([words, value]) => {
    const imposed = words.startsWith("stroke") && value === null && driveName() === "stroke";
    const number = element("dd", imposed ? `${byId("drive").value}, imposed` : value === null ? "not known" : readable(value));
    if (value !== null) number.dataset.value = String(value);
    return [element("dt", words), number];
  }));
  if (point.tier) byId("point").append(element("dt", "answered by"), element("dd", point.tier));
}

function showValues() {
  byId("frequency-value").textContent = `${byId("frequency").value} Hz`;
  byId("drive-value").textContent = `${byId("drive").value} ${model().ranges.drive.unit}`;
  byId("head-value").textContent = `${byId("head").value} mmHg`;
}

/// No answer stays beside controls that say something else.
function fail(message) {
  shown = pointShown = null;
  othersShown = [];
  byId("error").textContent = message;
  for (const id of ["chart", "key", "remarks", "point", "quantity-chart"]) byId(id).replaceChildren();
  byId("numbers").tBodies[0].replaceChildren();
  for (const id of ["summary", "status", "quantity-summary"]) byId(id).textContent = "";
  hidePeriod("");
}

/// Curves of the ticked models over the heads that they know; why one is not drawn stands beside its name.
async function askOthers(now, heads, signal) {
  const boxes = [...document.querySelectorAll("#other-list input")];
  const answers = await Promise.all(boxes.map(async (box) => {
    const note = byId(`why-${box.value}`), { ranges } = all.models[Number(box.value)];
    const within = (value, range) => Number(value) >= range.low && Number(value) <= range.high;
    note.textContent = "";
    if (box.disabled) note.textContent = `: driven by a ${ranges.drive.name}`;
    if (box.disabled || !box.checked) return null;
    const low = Math.max(heads.low, ranges.head.low), high = Math.min(heads.high, ranges.head.high);
    if (!within(now.frequency, ranges.frequency) || !within(now.drive, ranges.drive) || low > high) {
      note.textContent = ": this point is outside of its box";
      return null;
    }
    return ask("/curve", { model: box.value, frequency: now.frequency, drive: now.drive, heads: headList(low, high, pointsOfCurve) }, signal);
  }));
  return answers.filter((answer) => answer !== null).slice(0, mostCompared);
}

const headList = (low, high, count) => (low < high ? `${low}:${high}:${(high - low) / (count - 1)}` : String(low));

async function update() {
  showValues();
  const now = state();
  history.replaceState(null, "", "#" + new URLSearchParams(now));
  byId("saved").textContent = "";
  asked?.abort();
  if (now.low === "" || now.high === "") return fail("The heads are not stated.");
  const heads = { low: Number(now.low), high: Number(now.high) };
  const request = (asked = new AbortController());
  const point = { model: now.model, frequency: now.frequency, drive: now.drive };
  if (now.tolerance !== undefined) point.tolerance = now.tolerance;
  const begin = performance.now(), times = [];
  const show = (curve) => {
    if (request !== asked) return;
    shown = curve;
    byId("error").textContent = "";
    draw();
    list();
    say();
    times.push(`${curve.points.length} points after ${Math.round(performance.now() - begin)} ms`);
    byId("status").textContent = `${curve.level}: ${times.join(", ")}`;
  };
  try {
    // 1. The curve; of a model that takes long some of its heads first.
    othersShown = [];
    pointShown = null;
    const slow = model().level !== "emulator" && heads.low < heads.high;
    if (slow) show(await ask("/curve", { ...point, heads: headList(heads.low, heads.high, (pointsOfCurve - 1) / everyCoarse + 1) }, request.signal));
    const whole = await ask("/curve", { ...point, heads: headList(heads.low, heads.high, pointsOfCurve) }, request.signal);
    show(whole);

    // 2. The chosen head, its period, and the other models.
    const one = { ...point, heads: now.head };
    const [answer, others] = await Promise.all([ask("/curve", one, request.signal), askOthers(now, heads, request.signal)]);
    if (request !== asked) return;
    showPoint(answer);
    othersShown = others;
    draw();
    if (model().no_period !== "") return hidePeriod(model().no_period);
    const course = await ask("/period", { model: now.model, frequency: now.frequency, drive: now.drive, head: now.head }, request.signal);
    if (request === asked) showPeriod(course);
  } catch (error) {
    if (error.name === "AbortError" || request !== asked) return;
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

/// Controls for the chosen model, at `wanted` where the model knows it.
function setControls(wanted) {
  const { frequency, drive, head } = model().ranges;
  byId("model").textContent = `${model().model}, ${model().level}; ${shortest(head.low)} to ${shortest(head.high)} mmHg`;
  document.title = `${model().model} - Undula explorer`;
  byId("drive-label").textContent = drive.name === "voltage" ? "Voltage" : "Stroke";
  const measured = all.measured.find((curve) => curve[drive.name] !== null && curve.frequency_Hz !== null);
  setSlider(byId("frequency"), frequency, wanted.frequency ?? measured?.frequency_Hz);
  setSlider(byId("drive"), drive, wanted.drive ?? measured?.[drive.name]);
  setSlider(byId("head"), head, wanted.head);
  for (const [id, value, fallback] of [["head-low", wanted.low, head.low], ["head-high", wanted.high, head.high]]) {
    const field = byId(id);
    field.min = head.low;
    field.max = head.high;
    field.step = "any";
    field.value = Number.isFinite(value) ? value : fallback;
  }
  const fluid = model().fluid;
  byId("fluid").textContent = fluid === null ? "The model does not tell the fluid of its runs, and knows no other." :
    `Fluid: ${readable(fluid.viscosity_poise)} poise, ${readable(fluid.density_g_per_cm3)} g/cm³. There is no slider: all runs of the model had this fluid, so it knows no other.`;

  // The other models, and which of them can be drawn beside it.
  byId("others").hidden = all.models.length < 2;
  const own = Number(byId("model-number").value);
  const comparable = all.models.map((other, i) => i !== own && other.ranges.drive.name === drive.name);
  byId("tolerance-choice").hidden = !comparable.some(Boolean);
  if (!comparable.some(Boolean)) byId("tolerance").value = "";
  byId("other-list").replaceChildren(...all.models.flatMap((other, i) => {
    if (i === own) return [];
    const line = element("div"), label = element("label"), box = element("input"), why = element("span");
    box.type = "checkbox";
    box.value = i;
    box.disabled = !comparable[i];
    box.checked = comparable[i] && (wanted.beside === undefined || wanted.beside.includes(String(i)));
    why.id = `why-${i}`;
    label.append(box, ` ${other.model}, ${other.level}`, why);
    line.append(label);
    return [line];
  }));
  byId("save-scene").disabled = model().no_scene !== "";
  byId("save-scene").title = model().no_scene;
}

/// Numbers of the address; what is no number is not wanted.
function wantedState() {
  const text = new URLSearchParams(location.hash.slice(1));
  const wanted = {};
  for (const name of ["model", "frequency", "drive", "head", "low", "high", "tolerance"]) {
    if (text.get(name) && Number.isFinite(Number(text.get(name)))) wanted[name] = Number(text.get(name));
  }
  if (text.has("beside")) wanted.beside = text.get("beside").split(".");
  if (quantities.some(([place]) => place === text.get("quantity"))) wanted.quantity = text.get("quantity");
  return wanted;
}

async function save(button) {
  const say = (text) => (byId("saved").textContent = text);
  if (shown === null) return say("There is no curve to save.");
  const now = state();
  const name = `${model().model.replace(/\.[^.]*$/, "")}_${now.frequency}Hz_${now.drive}${model().ranges.drive.unit}`;
  try {
    if (button === "save-csv") downloadText(`${name}.csv`, csvOf(shown, driveKey()), "text/csv");
    if (button === "save-png") {
      const title = `${model().model}, ${now.frequency} Hz, ${driveName()} ${now.drive} ${model().ranges.drive.unit}`;
      download(`${name}.png`, (await canvasOf(byId("chart"), title)).toDataURL("image/png"));
    }
    if (button === "save-scene") {
      const question = new URLSearchParams({ model: now.model, frequency: now.frequency, drive: now.drive, head: now.head });
      const response = await fetch(`/scene?${question}`), text = await response.text();
      if (!response.ok) throw new Error(JSON.parse(text).error);
      downloadText(`${name}_${now.head}mmHg.toml`, text, "application/toml");
    }
    if (button === "copy-link") await navigator.clipboard.writeText(location.href);
    say(button === "copy-link" ? "The link restores this state, as long as the explorer is served at this address." : `Saved: ${name}`);
  } catch (error) {
    say(`Not saved: ${error.message}`);
  }
}

async function start() {
  try {
    all = await ask("/models", {});
  } catch (error) {
    byId("error").textContent = `The model cannot be read: ${error.message}`;
    return;
  }
  for (const range of all.models.flatMap(({ ranges }) => Object.values(ranges))) {
    // What the conversion of units leaves in the last digits.
    range.low = Number(range.low.toPrecision(12));
    range.high = Number(range.high.toPrecision(12));
  }
  const wanted = wantedState();
  byId("model-number").replaceChildren(...all.models.map(({ model: name, level }, i) => {
    const option = element("option", `${name}, ${level}`);
    option.value = i;
    return option;
  }));
  byId("model-choice").hidden = all.models.length < 2;
  byId("model-number").value = wanted.model in all.models ? wanted.model : 0;
  byId("quantity").replaceChildren(...quantities.map(([place, words]) => {
    const option = element("option", words);
    option.value = place;
    return option;
  }));
  byId("quantity").value = wanted.quantity ?? (model().level === "emulator" ? "holder.stroke_mm" : "hydraulic_power_mW");
  byId("tolerance").value = wanted.tolerance ?? "";
  setControls(wanted);
  byId("controls").addEventListener("input", (event) => {
    if (event.target.id === "model-number") {
      hidePeriod("");
      setControls({});
    }
    update();
  });
  byId("controls").addEventListener("submit", (event) => event.preventDefault());
  byId("exports").addEventListener("click", (event) => event.target.id && event.target.id !== "exports" && save(event.target.id));
  byId("quantity").addEventListener("input", () => {
    history.replaceState(null, "", "#" + new URLSearchParams(state()));
    if (shown !== null) drawQuantity();
  });
  hidePeriod("");
  await update();
  if (period !== null && !matchMedia("(prefers-reduced-motion: reduce)").matches) play(true);
}

start();
