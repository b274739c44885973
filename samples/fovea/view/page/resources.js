// A grid of resources by passes: who reads and writes what, how long it lives, what shares its memory, and where barriers
// are.
import { bytesText, element } from "./dom.js";
import { mainPort, on, portOf, show, store, tell } from "./store.js";

const root = document.getElementById("plan");
const note = document.getElementById("plan-note");
const panel = document.getElementById("plan-panel");
const order = document.getElementById("plan-order");

let passes = []; // in the order of their execution, with the level of each
let rows = []; // { resource, row, cells }
let heads = []; // of the columns
let chosen = null; // { resource } or { pass }, of which the text below the grid tells

// ---- What the plan says ----

function passesOf({ passes: all, plan }) {
  return plan.levels.flatMap(({ passes: of, barriers }, level) => of.map(({ name }, i) => (
    { ...all.find((p) => p.name === name), level, barriers: i === 0 ? barriers : {} })));
}

// What a pass does with a resource: its ports, and R, W or P in the order of the frame.
function useOf(pass, resource) {
  const ports = pass.ports.filter((p) => p.resource === resource.name);
  const letters = [["P", ports.some((p) => p.previous)], ["R", ports.some((p) => p.reads && !p.previous)],
    ["W", ports.some((p) => p.writes)]].filter(([, is]) => is).map(([letter]) => letter).join("");
  return { ports, letters };
}

const words = { P: "reads that of the previous frame", R: "reads", W: "writes" };
const said = (letters) => [...letters].map((l) => words[l]).join(" and ");

const isKept = (r) => r.heap === undefined;
const isAlive = (r, level) => isKept(r) || !r.levels || (level >= r.levels[0] && level <= r.levels[1]);

function sharing(resource, all) {
  if (isKept(resource)) return [];
  return all.filter((r) => r !== resource && r.heap === resource.heap && r.offset < resource.offset + resource.bytes
      && resource.offset < r.offset + r.bytes);
}

function memoryText(r) {
  return isKept(r) ? "memory of its own" : `heap ${r.heap} at ${bytesText(r.offset)}`;
}

const layoutsOf = (barriers, resource) => (barriers.images ?? []).filter((b) => b.resource === resource.name);
const layoutText = (b) => `${b.previous ? "of the previous frame, " : ""}${b.old_layout} → ${b.new_layout}`;

function barrierText({ memory, images }) {
  const parts = memory ? [`memory: ${memory.from} → ${memory.to}${memory.flush ? ", writes made visible" : ""}`] : [];
  return [...parts, ...(images ?? []).map((b) => `layout of ${b.resource}: ${layoutText(b)}`)];
}

const kOrders = {
  use: (a, b) => (isKept(a) ? 0 : a.levels?.[0] ?? 0) - (isKept(b) ? 0 : b.levels?.[0] ?? 0)
      || Number(isKept(b)) - Number(isKept(a)),
  memory: (a, b) => (a.heap ?? 1e9) - (b.heap ?? 1e9) || (a.offset ?? 0) - (b.offset ?? 0),
  bytes: (a, b) => b.bytes - a.bytes,
  name: (a, b) => a.name.localeCompare(b.name),
};

// ---- What is chosen ----

function line(name, ...values) {
  const texts = values.filter((v) => v !== "" && v !== null && v !== undefined);
  return texts.length ? [element("dt", {}, name), element("dd", {}, texts.join("; "))] : [];
}

function tellResource(resource) {
  const { plan } = store.state.graph;
  const uses = passes.map((pass) => [pass, useOf(pass, resource).letters]);
  const of = (letter) => uses.filter(([, letters]) => letters.includes(letter)).map(([pass]) => pass.name).join(", ");
  const barriers = passes.flatMap((pass) => layoutsOf(pass.barriers, resource)
    .map((b) => `before ${pass.name}: ${layoutText(b)}`));
  return [element("h3", {}, resource.name), element("dl", {},
    ...line("is", `${resource.is}, ${bytesText(resource.bytes)}, ${resource.lifetime}`),
    ...line("memory", memoryText(resource)),
    ...line("shares it with", sharing(resource, plan.resources).map((r) => r.name).join(", ")),
    ...line("written by", of("W")), ...line("read by", of("R")), ...line("read a frame later by", of("P")),
    ...line("layout changes", ...barriers))];
}

function tellPass(pass) {
  const of = (test) => [...new Set(pass.ports.filter(test).map((p) => p.resource))].join(", ");
  return [element("h3", {}, pass.name), element("dl", {}, ...line("is", `${pass.type}: ${pass.doc}`),
    ...line("level", `${pass.level}, number ${passes.indexOf(pass) + 1} of ${passes.length}`),
    ...line("reads", of((p) => p.reads && !p.previous)), ...line("reads of the last frame", of((p) => p.previous)),
    ...line("writes", of((p) => p.writes)), ...line("barriers before it", ...barrierText(pass.barriers)))];
}

function tellChosen() {
  const { memory } = store.state.graph.plan;
  const resource = chosen?.resource && rows.find((r) => r.resource.name === chosen.resource)?.resource;
  const pass = chosen?.pass && passes.find((p) => p.name === chosen.pass);
  const others = resource ? sharing(resource, store.state.graph.plan.resources) : [];
  for (const { row, resource: r } of rows) {
    row.classList.toggle("chosen", r === resource);
    row.classList.toggle("sharing", others.includes(r));
  }
  heads.forEach((head, i) => head.classList.toggle("chosen", passes[i] === pass));
  note.replaceChildren(
    element("div", { id: "chosen", "aria-live": "polite" },
        ...(resource ? tellResource(resource) : pass ? tellPass(pass) : [])),
    element("p", { class: "note" }, "R reads, W writes, P reads that of the previous frame; the bar is the lifetime. A " +
      "line at the left of a cell is a change of layout, ⇄ counts the resources that use the same memory at other times."),
    element("p", { class: "note" }, `${bytesText(memory.transient)} for one frame, ` +
      `${bytesText(memory.transient_without_aliasing)} if nothing shared memory; ${bytesText(memory.kept)} kept.`));
}

function choose(what, source) {
  chosen = what;
  tellChosen();
  if (source) show(source);
}

// What is seen of a resource: as its last writer leaves it.
const sourceOf = (resource) => passes.flatMap((pass) => useOf(pass, resource).ports)
  .filter((p) => p.made && p.writes).at(-1)?.source;

// ---- The grid ----

function headOf(pass) {
  const port = mainPort(pass);
  const head = element("th", { scope: "col", tabindex: -1, title: `${pass.name} (${pass.type}): ${pass.doc}`,
    "data-pass": pass.name, onclick: () => choose({ pass: pass.name }, port?.source) }, element("span", {}, pass.name));
  return head;
}

function barrierOf(pass) {
  const texts = barrierText(pass.barriers);
  const { memory, images = [] } = pass.barriers;
  return element("td", { class: "barriers", tabindex: -1, onclick: () => choose({ pass: pass.name }),
    title: texts.join("\n"), "aria-label": texts.length ? `before ${pass.name}: ${texts.join("; ")}` : null },
  [memory ? "M" : "", images.length || ""].join(""));
}

function cellOf(pass, resource) {
  const { ports, letters } = useOf(pass, resource);
  const layouts = layoutsOf(pass.barriers, resource).map((b) => `layout ${layoutText(b)}`);
  const last = letters ? "" : isAlive(resource, pass.level) ? "alive" : "";
  const kinds = [last, letters.includes("W") ? "writes" : letters ? "reads" : "", isKept(resource) ? "kept" : "",
    layouts.length ? "layout" : ""].filter(Boolean).join(" ");
  const texts = [letters ? `${pass.name} ${said(letters)} ${resource.name}` : "", ...layouts].filter(Boolean);
  const source = ports.find((p) => p.made)?.source;
  return element("td", { class: kinds, tabindex: -1, title: texts.join("\n"), "aria-label": texts.join(", ") || null,
    onclick: () => choose(letters ? { resource: resource.name } : null, letters ? source : null) }, letters);
}

function rowOf(resource, all) {
  const others = sharing(resource, all);
  const title = `${resource.name}: ${resource.is}, ${resource.lifetime}, ${memoryText(resource)}`;
  const source = sourceOf(resource);
  const head = element("th", { scope: "row", tabindex: -1, title, onclick: () =>
    choose({ resource: resource.name }, source) }, element("span", {}, element("bdi", {}, resource.name)));
  const preview = () => source && tell("preview", { source, title: resource.name });
  head.addEventListener("pointerenter", preview);
  head.addEventListener("pointerleave", () => tell("preview", null));
  const shared = element("td", { class: "shared number", tabindex: -1,
    title: others.length ? `shares memory with ${others.map((r) => r.name).join(", ")}` : "",
    "aria-label": others.length ? `shares memory with ${others.map((r) => r.name).join(", ")}` : null,
    onclick: () => choose({ resource: resource.name }) }, others.length ? `⇄${others.length}` : "");
  const row = element("tr", { "data-resource": resource.name }, head,
    element("td", { class: "number", tabindex: -1 }, bytesText(resource.bytes)), shared,
    ...passes.map((pass) => cellOf(pass, resource)));
  return { resource, row };
}

function draw() {
  if (!panel.open || !store.state) return;
  const { graph } = store.state;
  passes = passesOf(graph);
  const all = graph.plan.resources;
  rows = [...all].sort(kOrders[order.value]).map((resource) => rowOf(resource, all));
  heads = passes.map(headOf);
  const table = element("table", { role: "grid", "aria-label": "Resources by passes in the order of a frame" },
    element("thead", {},
      element("tr", {}, element("th", { scope: "col", tabindex: 0 }, "resource"),
        element("th", { scope: "col", class: "number", tabindex: -1 }, "size"),
        element("th", { scope: "col", tabindex: -1, title: "Resources that use the same memory at other times",
          "aria-label": "shares memory" }, "⇄"), ...heads),
      element("tr", {}, element("th", { scope: "row", colspan: 3, tabindex: -1,
        title: "M: a memory barrier before the pass; the number counts changes of layout" }, "barriers before"),
      ...passes.map(barrierOf))),
    element("tbody", {}, ...rows.map((r) => r.row)));
  table.addEventListener("keydown", onKey);
  table.addEventListener("focusin", ({ target }) => {
    for (const cell of table.querySelectorAll("[tabindex='0']")) cell.tabIndex = -1;
    target.tabIndex = 0;
  });
  root.replaceChildren(table);
  showSource();
  tellChosen();
}

// The arrow keys walk from cell to cell, and Enter chooses.
function onKey(event) {
  const cell = event.target.closest("td, th");
  if (event.key === "Enter" || event.key === " ") {
    event.preventDefault();
    event.stopPropagation();
    cell.click();
    return;
  }
  const lines = [...event.currentTarget.rows];
  const y = lines.indexOf(cell.parentElement);
  const column = (of) => (of.colSpan > 1 ? 0 : of.cellIndex + (of.parentElement.cells[0].colSpan - 1));
  const x = column(cell);
  const end = lines[y].cells.length - 1;
  const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1], Home: [-x, 0],
    End: [end + lines[y].cells[0].colSpan - 1 - x, 0] }[event.key];
  if (!step) return;
  event.preventDefault();
  event.stopPropagation();
  const line = lines[Math.min(lines.length - 1, Math.max(0, y + step[1]))];
  const left = line.cells[0].colSpan - 1;
  const wanted = cell.colSpan > 1 && step[0] > 0 ? cell.colSpan : x + step[0];
  line.cells[Math.min(line.cells.length - 1, Math.max(0, wanted - left))].focus();
}

function showSource() {
  const port = portOf(store.source);
  for (const { resource, row } of rows) row.classList.toggle("shown", resource.name === port?.resource);
  heads.forEach((head, i) => head.classList.toggle("shown", passes[i].name === port?.pass));
}

export function start() {
  on("state", draw);
  on("source", showSource);
  panel.addEventListener("toggle", draw);
  order.addEventListener("change", draw);
}
