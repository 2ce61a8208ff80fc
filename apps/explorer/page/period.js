"use strict";
// One period: the membrane as it moves, flows and holder over time.

const secondsPerPeriod = 2.5; // on the screen
let period = null; // what is shown
let membranePlace = null, flowPlace = null; // where points lie in the charts
let playing = false, playedFrom = 0;

function showInstant() {
  const i = Number(byId("instant").value);
  const slower = secondsPerPeriod * period.frequency_Hz;
  byId("instant-value").textContent = `${readable(1e3 * period.time_s[i])} ms; played ${Math.round(slower)} times slower`;
  byId("instant").setAttribute("aria-valuetext", `${readable(1e3 * period.time_s[i])} ms`);
  const line = period.radius_mm.map((radius, k) => [radius, period.membrane_mm[k][i]]);
  membranePlace.line.setAttribute("points", membranePlace.at(line));
  const x = flowPlace.x(1e3 * period.time_s[i]);
  flowPlace.mark.setAttribute("x1", x);
  flowPlace.mark.setAttribute("x2", x);
}

function showPeriod(answer) {
  period = answer;
  const { time_s, radius_mm, membrane_mm } = period;
  byId("period").hidden = false;
  byId("no-period").hidden = true;

  // 1. The membrane between its lowest and highest place.
  const low = membrane_mm.map((row) => Math.min(...row)), high = membrane_mm.map((row) => Math.max(...row));
  membranePlace = drawChart(byId("membrane-chart"), {
    xLabel: "radius (mm)", yLabel: "membrane (mm)", xRange: room(radius_mm), yRange: room([...low, ...high]),
    bands: [{ kind: "band", points: [...radius_mm.map((r, k) => [r, low[k]]), ...radius_mm.map((r, k) => [r, high[k]]).reverse()] }],
  });
  membranePlace.line = svg("polyline", { class: "curve" });
  byId("membrane-chart").append(membranePlace.line);
  byId("membrane-summary").textContent =
    `The membrane reaches from ${readable(Math.min(...low))} to ${readable(Math.max(...high))} mm about its place at rest; ` +
    `the holder moves ${readable(Math.max(...period.holder_mm))} mm to either side.` +
    (period.periodic ? "" : " The state does not repeat: this is the last period of its march.");

  // 2. Flows over time.
  const ms = time_s.map((t) => 1e3 * t);
  flowPlace = drawChart(byId("flow-chart"), {
    xLabel: "time (ms)", yLabel: "flow (l/min)", xRange: [0, ms[ms.length - 1] + ms[1]],
    yRange: room([...period.outflow_l_per_min, ...period.inflow_l_per_min]),
    lines: [
      { kind: "curve", points: ms.map((t, i) => [t, period.outflow_l_per_min[i]]) },
      { kind: "curve beside-1", points: ms.map((t, i) => [t, period.inflow_l_per_min[i]]) },
    ],
  });
  flowPlace.mark = svg("line", { class: "mark", y1: flowPlace.top, y2: flowPlace.bottom });
  byId("flow-chart").append(flowPlace.mark);
  const least = Math.min(...period.outflow_l_per_min), most = Math.max(...period.outflow_l_per_min);
  byId("flow-summary").textContent =
    `Flow out of the outlet between ${readable(least)} and ${readable(most)} l/min; dashed: into the inlet.`;

  const slider = byId("instant");
  slider.max = time_s.length - 1;
  if (Number(slider.value) > time_s.length - 1) slider.value = 0;
  showInstant();
}

/// Says why there is none; nothing of another point stays.
function hidePeriod(reason) {
  period = null;
  play(false);
  byId("period").hidden = true;
  byId("no-period").hidden = false;
  byId("no-period").textContent = reason;
}

function play(wanted) {
  playing = wanted && period !== null;
  byId("play").setAttribute("aria-pressed", String(playing));
  byId("play").textContent = playing ? "Pause" : "Play";
  if (!playing) return;
  playedFrom = performance.now() - (1e3 * secondsPerPeriod * Number(byId("instant").value)) / period.time_s.length;
  requestAnimationFrame(step);
}

function step(now) {
  if (!playing || period === null) return;
  const part = ((now - playedFrom) / (1e3 * secondsPerPeriod)) % 1;
  byId("instant").value = Math.floor((part < 0 ? 0 : part) * period.time_s.length);
  showInstant();
  requestAnimationFrame(step);
}

byId("play").addEventListener("click", () => play(!playing));
byId("instant").addEventListener("input", () => {
  play(false);
  if (period !== null) showInstant();
});
