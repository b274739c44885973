// The graph as a drawing: passes from left to right by level, edges between their ports. It can be zoomed and moved, and
// passes can be found by name.
import { svg } from "./dom.js";
import { mainPort, on, portOf, show, store, tell } from "./store.js";
import { medianTime } from "./timings.js";

const root = document.getElementById("graph-view");
const find = document.getElementById("find-pass");
const found = document.getElementById("found");
const kWidth = 118;
const kHeight = 34;
const kGapX = 34;
const kGapY = 12;
const kReadable = 0.7; // scale below which names are hard to read

let nodes = [];
let edges = [];

function columnsOf(passes) {
  const columns = [];
  passes.forEach((pass, index) => {
    const level = pass.level ?? 0;
    (columns[level] ??= []).push(index);
  });
  return columns.filter(Boolean);
}

// Passes stand where the middle of those that feed them is, so that edges cross little.
function arrange(graph) {
  const columns = columnsOf(graph.passes);
  const place = new Map();
  const inputs = new Map();
  for (const edge of graph.edges) {
    if (edge.previous) continue;
    if (!inputs.has(edge.to)) inputs.set(edge.to, []);
    inputs.get(edge.to).push(edge.from);
  }
  columns.forEach((column, c) => {
    const wanted = (index) => {
      const rows = (inputs.get(index) ?? []).map((from) => place.get(from)?.row).filter((r) => r !== undefined);
      return rows.length ? rows.reduce((a, b) => a + b) / rows.length : 0;
    };
    column.sort((a, b) => wanted(a) - wanted(b) || a - b);
    column.forEach((index, row) => place.set(index, { column: c, row }));
  });
  return { place, columns };
}

const cut = (text, most) => (text.length > most ? `${text.slice(0, most - 1)}…` : text);

function drawNode(graph, index, x, y) {
  const pass = graph.passes[index];
  const port = mainPort(pass);
  const time = svg("text", { class: "time", x: 8, y: 28 });
  const node = svg("g", { class: `node${pass.level === null ? " culled" : ""}`, transform: `translate(${x} ${y})`,
    tabindex: 0, role: "button", "aria-label": `${pass.name}, ${pass.type}: show its picture`, "data-pass": pass.name },
    svg("rect", { width: kWidth, height: kHeight, rx: 4 }), svg("text", { x: 8, y: 14 }, cut(pass.name, 17)), time);
  node.append(svg("title", {}, `${pass.name} (${pass.type}): ${pass.doc}`));
  const preview = () => port && tell("preview", { source: port.source, title: `${pass.name} · ${port.name}` });
  node.addEventListener("pointerenter", preview);
  node.addEventListener("focus", () => {
    if (!isVisible(index) && node.matches(":focus-visible")) centre(index);
    preview();
  });
  node.addEventListener("pointerleave", () => tell("preview", null));
  node.addEventListener("blur", () => tell("preview", null));
  node.addEventListener("click", () => port && show(port.source));
  node.addEventListener("keydown", (event) => event.key === "Enter" && port && show(port.source));
  return { node, time, index, pass };
}

function drawEdge(graph, edge, from, to) {
  const bend = Math.max(14, Math.abs(to.x - from.x - kWidth) / 2);
  const x1 = from.x + kWidth;
  const y1 = from.y + kHeight / 2;
  const y2 = to.y + kHeight / 2;
  const d = edge.previous
    ? `M${x1} ${y1}C${x1 + 24} ${y1 + 30} ${to.x - 24} ${y2 + 30} ${to.x} ${y2}`
    : `M${x1} ${y1}C${x1 + bend} ${y1} ${to.x - bend} ${y2} ${to.x} ${y2}`;
  const line = svg("path", { class: `edge${edge.previous ? " previous" : ""}`, d });
  const hit = svg("path", { class: "hit", d });
  const [pass, port] = edge.source.split(":");
  const title = `${pass} · ${port}${edge.previous ? " of the last frame" : ""} → ${graph.passes[edge.to].name}`;
  hit.append(svg("title", {}, title));
  hit.addEventListener("pointerenter", () => tell("preview", { source: edge.source, title }));
  hit.addEventListener("pointerleave", () => tell("preview", null));
  hit.addEventListener("click", () => show(edge.source));
  return { hit, line, source: edge.source };
}

// ---- Zoom and position ----

const camera = svg("g");
const drawing = svg("svg", { width: "100%", height: "100%" }, camera);
const size = { width: 1, height: 1 }; // of the whole graph
const view = { scale: 1, x: 0, y: 0, fitted: false, untouched: true }; // untouched: as firstView() left it
let boxes = []; // upper left corners of the passes, by number
let drawnNames = ""; // of the passes; the view stays while they do

// Lengths above are those for text of its usual size; a larger one makes the whole drawing larger.
const textScale = () => parseFloat(getComputedStyle(document.documentElement).fontSize) / 13;

function place() {
  camera.setAttribute("transform", `translate(${view.x} ${view.y}) scale(${view.scale})`);
  root.dataset.scale = view.scale;
}

function fit() {
  const { width, height } = root.getBoundingClientRect();
  if (width < 1 || height < 1) return;
  view.scale = Math.min(width / size.width, height / size.height, textScale());
  view.x = (width - size.width * view.scale) / 2;
  view.y = (height - size.height * view.scale) / 2;
  view.fitted = true;
  view.untouched = false;
  place();
}

// x, y: what stays in its place, from the corner of the view; its middle by default.
function zoom(factor, x = root.clientWidth / 2, y = root.clientHeight / 2) {
  const scale = Math.min(8, Math.max(0.05, view.scale * factor));
  view.x = x - ((x - view.x) * scale) / view.scale;
  view.y = y - ((y - view.y) * scale) / view.scale;
  view.scale = scale;
  view.fitted = view.untouched = false;
  place();
}

function pan(dx, dy) {
  view.x += dx;
  view.y += dy;
  view.fitted = view.untouched = false;
  place();
}

// Moves a pass into the middle, or as near to it as leaves no empty space beside the graph, and enlarges it if it could
// not be read.
function centre(index) {
  view.scale = Math.max(view.scale, textScale());
  const offset = (room, all, middle) => all * view.scale < room
    ? (room - all * view.scale) / 2
    : Math.min(0, Math.max(room - all * view.scale, room / 2 - middle * view.scale));
  pan(offset(root.clientWidth, size.width, boxes[index].x + kWidth / 2) - view.x,
      offset(root.clientHeight, size.height, boxes[index].y + kHeight / 2) - view.y);
}

function isVisible(index) {
  const left = view.x + boxes[index].x * view.scale;
  const top = view.y + boxes[index].y * view.scale;
  return left >= 0 && top >= 0 && left + kWidth * view.scale <= root.clientWidth
      && top + kHeight * view.scale <= root.clientHeight;
}

// A large graph begins at a pass that can be read, instead of as a whole that cannot.
function firstView() {
  fit();
  const shown = store.state.graph.passes.findIndex((p) => p.name === portOf(store.source)?.pass);
  if (root.clientWidth && view.scale < kReadable * textScale()) centre(Math.max(0, shown));
  view.untouched = true;
}

function draw() {
  const { graph } = store.state;
  const { place: cells, columns } = arrange(graph);
  const highest = Math.max(...columns.map((c) => c.length));
  boxes = graph.passes.map((_, index) => {
    const { column, row } = cells.get(index);
    const offset = ((highest - columns[column].length) * (kHeight + kGapY)) / 2;
    return { x: 12 + column * (kWidth + kGapX), y: 6 + offset + row * (kHeight + kGapY) };
  });
  size.width = columns.length * (kWidth + kGapX) + 24 - kGapX;
  size.height = highest * (kHeight + kGapY) + 26;
  edges = graph.edges.map((edge) => drawEdge(graph, edge, boxes[edge.from], boxes[edge.to]));
  nodes = graph.passes.map((_, index) => drawNode(graph, index, boxes[index].x, boxes[index].y));
  camera.replaceChildren(...edges.flatMap((e) => [e.hit, e.line]), ...nodes.map((n) => n.node));
  const names = graph.passes.map((p) => p.name).join(" ");
  if (names !== drawnNames) firstView();
  drawnNames = names;
  showSource();
  showFound();
}

// ---- With the mouse, two fingers and keys ----

const fingers = new Map(); // pointers that are down, by number
let dragged = false; // so far that letting go is no click

const spread = ([a, b]) => Math.hypot(a.x - b.x, a.y - b.y);
const middle = (points) => ({ x: points.reduce((sum, p) => sum + p.x, 0) / points.length,
  y: points.reduce((sum, p) => sum + p.y, 0) / points.length });

function onPointerMove(event) {
  if (!fingers.has(event.pointerId)) return;
  const before = [...fingers.values()];
  fingers.set(event.pointerId, { ...fingers.get(event.pointerId), x: event.clientX, y: event.clientY });
  const now = [...fingers.values()];
  const held = fingers.get(event.pointerId);
  if (!dragged && Math.hypot(held.x - held.fromX, held.y - held.fromY) < 5) {
    fingers.set(event.pointerId, { ...held, x: held.fromX, y: held.fromY });
    return;
  }
  if (!dragged) root.setPointerCapture(event.pointerId);
  dragged = true;
  const [a, b] = [middle(before), middle(now)];
  pan(b.x - a.x, b.y - a.y);
  if (now.length !== 2) return;
  const box = root.getBoundingClientRect();
  zoom(spread(now) / Math.max(1, spread(before)), b.x - box.left, b.y - box.top);
}

const kKeys = { "+": () => zoom(1.25), "=": () => zoom(1.25), "-": () => zoom(0.8), 0: fit,
  ArrowLeft: () => pan(60, 0), ArrowRight: () => pan(-60, 0), ArrowUp: () => pan(0, 60), ArrowDown: () => pan(0, -60) };

function steer() {
  root.addEventListener("wheel", (event) => {
    event.preventDefault();
    const box = root.getBoundingClientRect();
    // Two fingers on a pad that move apart come as a wheel with Ctrl, in small steps.
    const step = event.ctrlKey ? 0.01 : 0.0015;
    zoom(Math.exp(-event.deltaY * step), event.clientX - box.left, event.clientY - box.top);
  }, { passive: false });
  root.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    if (fingers.size === 0) dragged = false;
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY, fromX: event.clientX, fromY: event.clientY });
  });
  root.addEventListener("pointermove", onPointerMove);
  for (const end of ["pointerup", "pointercancel", "pointerleave"])
    root.addEventListener(end, (event) => fingers.delete(event.pointerId));
  root.addEventListener("click", (event) => {
    if (dragged) event.stopPropagation();
    dragged = false;
  }, true);
  root.addEventListener("keydown", (event) => {
    const action = !event.ctrlKey && !event.metaKey && !event.altKey && kKeys[event.key];
    if (!action) return;
    event.preventDefault();
    event.stopPropagation(); // the same keys zoom the picture
    action();
  });
  document.getElementById("graph-larger").addEventListener("click", () => zoom(1.25));
  document.getElementById("graph-smaller").addEventListener("click", () => zoom(0.8));
  document.getElementById("graph-fit").addEventListener("click", fit);
  new ResizeObserver(() => {
    if (!nodes.length) return;
    if (view.untouched) firstView();
    else if (view.fitted) fit();
  }).observe(root);
}

// ---- Finding a pass ----

let matches = []; // numbers of passes
let match = 0; // the one in the middle

function showFound() {
  const text = find.value.trim().toLowerCase();
  const { passes } = store.state.graph;
  const has = (name) => name.toLowerCase().includes(text);
  matches = text === "" ? [] : passes.map((_, index) => index).filter((index) => has(passes[index].name));
  if (text !== "" && !matches.length)
    matches = passes.map((_, index) => index).filter((index) => has(passes[index].type));
  match = Math.min(match, Math.max(0, matches.length - 1));
  for (const { node, index } of nodes) {
    node.classList.toggle("match", matches.includes(index));
    node.classList.toggle("found", matches[match] === index);
  }
  found.value = text === "" ? "" : matches.length
    ? `${match + 1} of ${matches.length}: ${passes[matches[match]].name}` : "no pass";
}

function goTo(step) {
  if (matches.length) match = (match + step + matches.length) % matches.length;
  showFound();
  if (matches.length) centre(matches[match]);
}

function startFind() {
  find.addEventListener("input", () => {
    match = 0;
    showFound();
    goTo(0);
  });
  find.addEventListener("keydown", (event) => {
    if (event.key === "Enter") goTo(event.shiftKey ? -1 : 1);
    if (event.key !== "Escape") return;
    find.value = "";
    showFound();
  });
}

export function focusFind() {
  document.getElementById("graph-panel").open = true;
  find.focus();
  find.select();
}

function showSource() {
  const port = portOf(store.source);
  for (const { node, pass } of nodes) node.classList.toggle("shown", pass.name === port?.pass);
  for (const { line, source } of edges) line.classList.toggle("shown", source === port?.source);
}

export function start() {
  root.replaceChildren(drawing);
  steer();
  startFind();
  on("state", draw);
  on("source", showSource);
  on("numbers", () => {
    for (const { time, index, pass } of nodes) {
      const ms = medianTime(index);
      time.textContent = pass.level === null
          ? "does not run" : `${ms.toFixed(ms < 10 ? 2 : 1)} ms${pass.host ? ", CPU" : ""}`;
    }
  });
}
