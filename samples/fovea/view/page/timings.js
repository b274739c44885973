// Times of the passes as a table with their history, and counters.
import { bytesText, element, svg } from "./dom.js";
import { mainPort, on, portOf, show, store, tell } from "./store.js";

const kHistory = 90;
const root = document.getElementById("timings");
const countersRoot = document.getElementById("counters");

let rows = new Map(); // pass index -> cells
let histories = new Map();
let open = new Set(); // passes whose steps are shown
let pinned = null; // pass index -> ms
let total = null;

function timeOf(pass, timing) {
  return store.state.graph.passes[pass].host ? timing.cpu : timing.gpu;
}

function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted.length ? sorted[sorted.length >> 1] : 0;
}

export const medianTime = (pass) => median(histories.get(pass) ?? []);

function sparkline(values, most) {
  const step = 100 / (kHistory - 1);
  const first = kHistory - values.length;
  let d = `M${(first * step).toFixed(1)} 20`;
  values.forEach((v, i) => {
    d += `L${((first + i) * step).toFixed(1)} ${(20 - 19 * Math.min(1, v / most)).toFixed(1)}`;
  });
  return `${d}L100 20Z`;
}

// Three digits, or all of the whole number.
const milliseconds = (ms) => ms.toFixed(ms < 10 ? 2 : ms < 100 ? 1 : 0);

// The height of a row of the history: what nearly all values stay below, so that the first frame does not flatten it.
function usual(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return Math.max(1e-4, 1.35 * sorted[Math.floor(0.9 * (sorted.length - 1))]);
}

function passRow(index) {
  const pass = store.state.graph.passes[index];
  const port = mainPort(pass);
  const path = svg("path");
  const time = element("td", { class: "number" });
  const delta = element("td", { class: "number delta" });
  const name = element("td", {}, pass.name);
  const bar = element("td", { class: "bar" });
  bar.append(svg("svg", { viewBox: "0 0 100 20", preserveAspectRatio: "none", "aria-hidden": "true" }, path));
  const row = element("tr", { "data-pass": pass.name, tabindex: 0, "aria-label": `${pass.name}: show its picture` },
      name, bar, time, delta);
  const preview = () => port && tell("preview", { source: port.source, title: `${pass.name} · ${port.name}` });
  const lock = () => port && show(port.source);
  row.addEventListener("pointerenter", preview);
  row.addEventListener("focus", preview);
  row.addEventListener("pointerleave", () => tell("preview", null));
  row.addEventListener("blur", () => tell("preview", null));
  row.addEventListener("click", () => {
    lock();
    toggleSteps(index);
  });
  row.addEventListener("keydown", (event) => {
    if (event.key !== "Enter") return;
    lock();
    toggleSteps(index);
  });
  return { row, name, path, time, delta, steps: new Map() };
}

// What the pass is, and what it recorded in the last frame: "dispatches 4, barriers 3".
function explain(cells, timing) {
  const pass = store.state.graph.passes[timing.pass];
  const commands = Object.entries(timing.commands).filter(([, count]) => count > 0).map((entry) => entry.join(" "));
  cells.name.title = [`${pass.type}: ${pass.doc}`, commands.join(", ")].join("\n").trim();
}

function toggleSteps(index) {
  if (open.has(index)) open.delete(index);
  else open = new Set([index]);
}

function showSteps(cells, index, timing) {
  const wanted = open.has(index) && timing.steps.length > 1;
  if (!wanted) {
    for (const step of cells.steps.values()) step.row.remove();
    cells.steps.clear();
    return;
  }
  let after = cells.row;
  for (const [name, ms] of timing.steps) {
    if (!cells.steps.has(name)) {
      const time = element("td", { class: "number" });
      const row = element("tr", { class: "step" }, element("td", { title: name }, name), element("td"), time,
          element("td"));
      cells.steps.set(name, { row, time });
      after.after(row);
    }
    const step = cells.steps.get(name);
    step.time.textContent = ms.toFixed(3);
    after = step.row;
  }
}

function build(times) {
  rows = new Map();
  const body = element("tbody");
  for (const timing of times.passes) {
    const cells = passRow(timing.pass);
    rows.set(timing.pass, cells);
    body.append(cells.row);
  }
  total = { gpu: element("td", { class: "number", id: "total" }), delta: element("td", { class: "number delta" }),
      note: element("p", { class: "note" }) };
  body.append(element("tr", { class: "total" }, element("td", {}, "frame"), element("td"), total.gpu, total.delta));
  const pin = element("button", { type: "button", id: "pin", title: "Compare all times with what they are now" },
      "Pin as baseline");
  pin.addEventListener("click", () => {
    pinned = pinned ? null : new Map([...histories].map(([key, values]) => [key, median(values)]));
    pin.textContent = pinned ? "Drop baseline" : "Pin as baseline";
    pin.setAttribute("aria-pressed", String(Boolean(pinned)));
    if (!pinned) for (const cells of [...rows.values(), total]) cells.delta.textContent = "";
  });
  root.replaceChildren(
    element("table", {}, element("thead", {}, element("tr", {}, element("th", {}, "pass"), element("th", {}, "history"),
      element("th", { class: "number" }, "ms"), element("th", { class: "number" }, ""))), body),
    element("div", { class: "actions" }, pin), total.note);
  showSource();
}

function remember(key, value) {
  if (!histories.has(key)) histories.set(key, []);
  const values = histories.get(key);
  values.push(value);
  if (values.length > kHistory) values.shift();
}

function showDelta(cell, key, now) {
  const before = pinned?.get(key);
  if (!before) return;
  const change = (100 * (now - before)) / before;
  cell.textContent = Math.abs(change) < 2 ? "≈" : `${change > 0 ? "+" : "−"}${Math.abs(change).toFixed(0)}%`;
  cell.classList.toggle("slower", change > 5);
}

// The times of every frame are kept, though they are drawn less often.
function keep({ times, build }) {
  if (!times || build !== store.state?.build) return;
  for (const timing of times.passes) remember(timing.pass, timeOf(timing.pass, timing));
  remember("frame", times.gpu - times.observe);
  remember("wall", times.wall);
}

function update(tick) {
  const { times } = tick;
  if (!times || tick.build !== store.state?.build) return;
  const same = rows.size === times.passes.length && times.passes.every((t) => rows.has(t.pass));
  if (!same) build(times);
  for (const timing of times.passes) {
    const cells = rows.get(timing.pass);
    const values = histories.get(timing.pass) ?? [];
    const now = median(values.slice(-9));
    cells.path.setAttribute("d", sparkline(values, usual(values)));
    cells.time.textContent = milliseconds(now);
    cells.time.title = store.state.graph.passes[timing.pass].host ? "on the CPU" : "";
    explain(cells, timing);
    showDelta(cells.delta, timing.pass, median(values));
    showSteps(cells, timing.pass, timing);
  }
  const frame = histories.get("frame") ?? [];
  total.gpu.textContent = milliseconds(median(frame.slice(-9)));
  showDelta(total.delta, "frame", median(frame));
  const wall = median((histories.get("wall") ?? []).slice(-9));
  total.note.textContent = `${wall.toFixed(1)} ms a frame on the clock, of which ${times.observe.toFixed(2)} ms copy ` +
    `what this page shows (not counted above). ${bytesText(tick.bytes)} of device memory.`;
  countersRoot.replaceChildren(element("table", {}, ...times.counters.map(([name, value]) =>
    element("tr", {}, element("td", {}, name), element("td", { class: "number" }, value.toLocaleString("en"))))));
}

function showSource() {
  const pass = portOf(store.source)?.pass;
  for (const [index, cells] of rows)
    cells.row.classList.toggle("shown", store.state.graph.passes[index].name === pass);
}

export function start() {
  on("state", () => {
    rows = new Map();
    histories = new Map();
    root.replaceChildren();
  });
  on("times", keep);
  on("numbers", update);
  on("source", showSource);
}
