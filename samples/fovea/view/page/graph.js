// The graph as a drawing: passes from left to right by level, edges between their ports.
import { svg } from "./dom.js";
import { mainPort, on, portOf, show, store, tell } from "./store.js";
import { medianTime } from "./timings.js";

const root = document.getElementById("graph-view");
const kWidth = 118;
const kHeight = 34;
const kGapX = 34;
const kGapY = 12;

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
  node.addEventListener("focus", preview);
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

function draw() {
  const { graph } = store.state;
  const { place, columns } = arrange(graph);
  const highest = Math.max(...columns.map((c) => c.length));
  const at = (index) => {
    const { column, row } = place.get(index);
    const offset = ((highest - columns[column].length) * (kHeight + kGapY)) / 2;
    return { x: 4 + column * (kWidth + kGapX), y: 6 + offset + row * (kHeight + kGapY) };
  };
  const width = columns.length * (kWidth + kGapX) + 8;
  const height = highest * (kHeight + kGapY) + 26;
  edges = graph.edges.map((edge) => drawEdge(graph, edge, at(edge.from), at(edge.to)));
  nodes = graph.passes.map((_, index) => {
    const { x, y } = at(index);
    return drawNode(graph, index, x, y);
  });
  root.replaceChildren(svg("svg", { width, height }, ...edges.flatMap((e) => [e.hit, e.line]),
      ...nodes.map((n) => n.node)));
  showSource();
}

function showSource() {
  const port = portOf(store.source);
  for (const { node, pass } of nodes) node.classList.toggle("shown", pass.name === port?.pass);
  for (const { line, source } of edges) line.classList.toggle("shown", source === port?.source);
}

export function start() {
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
