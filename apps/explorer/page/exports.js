"use strict";
// What is saved: numbers as CSV, the curve as PNG, the scene as TOML.

function download(name, address) {
  const link = element("a");
  link.href = address;
  link.download = name;
  link.click();
}

function downloadText(name, text, type) {
  const address = URL.createObjectURL(new Blob([text], { type }));
  download(name, address);
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/// Numbers of a point by name, the parts of its objects as "object.name".
function flattened(point, prefix = "") {
  const found = {};
  for (const [name, value] of Object.entries(point)) {
    if (value !== null && typeof value === "object") Object.assign(found, flattened(value, `${prefix}${name}.`));
    else found[prefix + name] = value;
  }
  return found;
}

/// Every digit of every number; empty where it is not known.
function csvOf(curve, drive) {
  const rows = curve.points.map((point) => flattened(point));
  const names = [...new Set(rows.flatMap(Object.keys))].filter((name) => !/^seconds/.test(name));
  const field = (value) => {
    if (value === null || value === undefined) return "";
    const text = String(value);
    return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  const setting = [`# ${curve.model}, ${curve.level}`, `# frequency_Hz = ${curve.frequency_Hz}`, `# ${drive} = ${curve[drive]}`];
  return [...setting, names.map(field).join(","), ...rows.map((row) => names.map((name) => field(row[name])).join(","))].join("\n") + "\n";
}

/// The chart with its looks as attributes, since a picture knows no style sheet; as a canvas of twice its size.
async function canvasOf(chart, title) {
  const copy = chart.cloneNode(true);
  const shown = [...chart.querySelectorAll("*")], copied = [...copy.querySelectorAll("*")];
  shown.forEach((part, i) => {
    const look = getComputedStyle(part);
    const names = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-dasharray", "opacity", "font-size", "font-family"];
    for (const name of names) copied[i].setAttribute(name, look.getPropertyValue(name));
    copied[i].removeAttribute("class");
  });
  const { width, height } = chart.viewBox.baseVal, above = 30;
  copy.setAttribute("viewBox", `0 ${-above} ${width} ${height + above}`);
  copy.setAttribute("width", 2 * width);
  copy.setAttribute("height", 2 * (height + above));
  const body = getComputedStyle(document.body);
  copy.prepend(svg("rect", { x: 0, y: -above, width, height: height + above, fill: body.backgroundColor }));
  copy.append(svg("text", { x: width / 2, y: -8, "text-anchor": "middle", fill: body.color, "font-size": "15px", "font-family": body.fontFamily }, title));
  const picture = new Image();
  picture.src = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(new XMLSerializer().serializeToString(copy));
  await picture.decode();
  const canvas = element("canvas");
  canvas.width = 2 * width;
  canvas.height = 2 * (height + above);
  canvas.getContext("2d").drawImage(picture, 0, 0);
  return canvas;
}
