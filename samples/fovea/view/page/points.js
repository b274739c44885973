// Elements of buffers that have a position in the scene, such as VPLs: they can be marked in the picture, and the one
// that is clicked tells its numbers.
import { getElements } from "./buffers.js";
import { element, row, svg } from "./dom.js";
import { place, pictureAt } from "./picture.js";
import { on, portOf, store } from "./store.js";

const stage = document.getElementById("stage");
const marks = document.getElementById("point-marks");
const card = document.getElementById("element");

const kReach = 24; // CSS pixels between a click and the point that it means
const kStill = 4; // CSS pixels that a click may move
const kDigits = 4; // of floats in the card; their titles are exact
const kMostMarks = 10000;
const kMostSiblings = 5; // other buffers that are read for one element
const kEvery = 400; // milliseconds between two readings

let choice = null; // source of the buffer
let chosen = null; // number of an element
let points = null; // Elements
let busy = false;
let last = -kEvery;

const select = element("select", { id: "points" });
const show = element("input", { type: "checkbox", id: "show-points" });
const number = element("input", { type: "number", id: "point-number", min: 0, step: 1, "aria-label": "Element" });
const note = element("p", { class: "note", role: "status" });
const root = document.getElementById("points-panel");

// The button to close stays while the numbers change, so that no click on it is lost.
const cardTitle = element("strong");
const cardPlace = element("span");
const cardNumbers = element("dl");
card.append(element("div", { class: "head" }, cardTitle, cardPlace,
  element("button", { type: "button", class: "link", onclick: () => pick(null) }, "close")), cardNumbers);

function vectorField(port, name) {
  return port?.fields?.find((f) => f.name === name && f.type === "float" && f.components === 3);
}
const positionOf = (port) => vectorField(port, "position");

// Buffers that passes make, in the order in which the passes run.
function buffers() {
  const passes = store.state.graph.passes.filter((p) => p.level !== null).sort((a, b) => a.level - b.level);
  return passes.flatMap((pass) => pass.ports
    .filter((p) => p.buffer && p.made && (p.direction === "out" || p.direction === "inout"))
    .map((p) => ({ ...p, pass: pass.name })));
}

const choicePort = () => buffers().find((p) => p.source === choice);

// Where the picture shows a point of the world, in pixels of the picture; null if it is behind the eye.
function project(matrix, [x, y, z]) {
  const clip = (i) => matrix[i] * x + matrix[4 + i] * y + matrix[8 + i] * z + matrix[12 + i];
  const w = clip(3);
  if (w <= 0) return null;
  const { width, height } = store.picture;
  return { x: (0.5 + 0.5 * clip(0) / w) * width, y: (0.5 + 0.5 * clip(1) / w) * height };
}

// The camera of the picture; undefined if it shows none, such as a shadow map.
function cameraOf() {
  const { picture, state, tick } = store;
  if (!picture || !tick?.views || picture.width !== state.size[0] || picture.height !== state.size[1]) return undefined;
  const pass = state.graph.passes.find((p) => p.name === portOf(store.source)?.pass);
  return tick.views[pass?.view];
}

function* projected() {
  const field = points && positionOf(choicePort());
  const camera = cameraOf();
  if (!field || !camera) return;
  for (let i = 0; i < points.count; ++i) {
    const at = points.isEmpty(i) ? null : project(camera, points.vector(i, field));
    if (at) yield { index: i, ...at };
  }
}

function drawMarks() {
  if ((!show.checked && chosen === null) || store.picture?.buffer) {
    marks.replaceChildren();
    return;
  }
  let all = "";
  let one = "";
  let drawn = 0;
  for (const { index, x, y } of projected()) {
    const at = `M${(place.x + x * place.scale).toFixed(1)} ${(place.y + y * place.scale).toFixed(1)}h0`;
    if (index === chosen) one = at;
    if (show.checked && ++drawn <= kMostMarks) all += at;
  }
  marks.replaceChildren(...[["points shade", all], ["points", all], ["point shade", one], ["point", one]]
    .map(([name, d]) => svg("path", { class: name, d })));
}

// ---- One element ----

// From an element to the eye, in metres, and whether it faces the eye, so far as it says.
function towardsEye(index) {
  const port = choicePort();
  const { position } = store.tick.camera;
  const way = [...points.vector(index, positionOf(port))].map((v, i) => position[i] - v);
  const normal = vectorField(port, "normal");
  const faces = !normal || points.vector(index, normal).reduce((sum, v, i) => sum + v * way[i], 0) > 0;
  return { distance: Math.hypot(...way), faces };
}

function placeText() {
  if (chosen >= points.count || points.isEmpty(chosen)) return "empty";
  const { distance, faces } = towardsEye(chosen);
  return `${distance.toPrecision(3)} m from the eye${faces ? "" : ", facing away"}`;
}

// The element of this number in its buffer, and in others that have as many elements: passes hand a list on by number.
async function drawElement() {
  const port = choicePort();
  if (chosen === null || !port || !points) {
    card.hidden = true;
    return;
  }
  const siblings = buffers().filter((p) => p.count === port.count && p.source !== port.source && p.count > 1);
  const ports = [port, ...siblings.slice(-kMostSiblings)];
  const index = chosen;
  const read = await Promise.all(ports.map((p) => getElements(p, index, 1).catch(() => null)));
  if (index !== chosen) return;
  const groups = ports.flatMap((p, i) => read[i] ? [
    element("dt", { class: "group", title: p.doc }, `${p.pass} · ${p.name}`), element("dd", {}),
    ...read[i].fields.flatMap((f) => [element("dt", {}, f.name),
      element("dd", { title: read[i].text(0, f) }, read[i].text(0, f, kDigits))])] : []);
  cardTitle.textContent = `Element ${index}`;
  cardPlace.textContent = placeText();
  cardNumbers.replaceChildren(...groups);
  card.dataset.index = index;
  card.hidden = false;
}

function pick(index) {
  chosen = index;
  number.value = index ?? "";
  drawMarks();
  drawElement();
}

async function pickAt(clientX, clientY) {
  if (!choicePort() || !cameraOf()) return;
  await read();
  const at = pictureAt(clientX, clientY);
  let best = null;
  for (const point of projected()) {
    const distance = Math.hypot(point.x - at.x, point.y - at.y) * place.scale;
    if (distance > kReach) continue;
    // One that faces away is meant only where no other is near.
    const rank = distance + (towardsEye(point.index).faces ? 0 : kReach);
    if (!best || rank < best.rank) best = { index: point.index, rank };
  }
  pick(best ? best.index : null);
}

// ---- Reading ----

async function read() {
  const port = choicePort();
  if (!port) return;
  try {
    const elements = await getElements(port, 0, port.count);
    if (elements && port.source === choice) points = elements;
  } catch {
    points = null; // The next picture tries again.
  }
}

async function update() {
  if (busy || performance.now() - last < kEvery || (!show.checked && chosen === null)) return;
  busy = true;
  last = performance.now();
  await read();
  await drawElement();
  busy = false;
  drawMarks();
}

function choose(source) {
  choice = source;
  points = null;
  pick(null);
  last = -kEvery;
  update();
}

// The list that is made last is the one with which the picture is shaded.
function fill() {
  const ports = buffers().filter(positionOf);
  select.replaceChildren(...ports.map((p) => element("option", { value: p.source }, `${p.pass} · ${p.name}`)));
  const known = ports.some((p) => p.source === choice);
  if (!known) choose(ports.at(-1)?.source ?? null);
  select.value = choice ?? "";
  number.max = (choicePort()?.count ?? 1) - 1;
  root.parentElement.hidden = ports.length === 0;
}

export function start() {
  root.append(row("Points", "points", select),
    row("Mark them", "show-points", show),
    row("Element", "point-number", number), note);
  note.textContent = "Click the picture near a point to see its numbers.";
  select.addEventListener("change", () => choose(select.value));
  show.addEventListener("change", () => {
    last = -kEvery;
    drawMarks();
    update();
  });
  number.addEventListener("change", async () => {
    if (!points) await read();
    pick(number.value === "" ? null : Number(number.value));
  });
  let down = null;
  stage.addEventListener("pointerdown", (event) => {
    const plain = event.button === 0 && !event.shiftKey && !event.ctrlKey && event.target.closest("#messages") === null;
    down = plain && !event.target.closest("#table, #element") ? { x: event.clientX, y: event.clientY } : null;
  });
  stage.addEventListener("pointerup", (event) => {
    if (down && Math.hypot(event.clientX - down.x, event.clientY - down.y) < kStill)
      pickAt(event.clientX, event.clientY);
    down = null;
  });
  on("state", fill);
  on("picture", update);
  on("tick", drawMarks);
  on("place", drawMarks);
}
