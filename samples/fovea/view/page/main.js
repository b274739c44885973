// Starts the page: brings the parts together and follows the run.
import { control, getPicture, getState, listen } from "./api.js";
import * as compare from "./compare.js";
import { element } from "./dom.js";
import * as graph from "./graph.js";
import * as look from "./look.js";
import * as move from "./move.js";
import * as parameters from "./parameters.js";
import * as picture from "./picture.js";
import * as points from "./points.js";
import * as region from "./region.js";
import * as resources from "./resources.js";
import { on, show, store, tell } from "./store.js";
import * as timings from "./timings.js";

const byId = (id) => document.getElementById(id);

// ---- Messages ----

let localProblem = null;
let dismissed = -1;

function drawMessages() {
  const list = [...(store.state && dismissed !== store.state.build ? store.state.messages : [])];
  if (localProblem) list.unshift({ severity: "error", message: localProblem });
  byId("messages").replaceChildren(...list.map((m) => {
    const place = [m.file, m.line || null, m.line ? m.column || null : null].filter(Boolean).join(":");
    const close = element("button", { type: "button", class: "link", "aria-label": "Close the messages" }, "close");
    close.addEventListener("click", () => {
      localProblem = null;
      dismissed = store.state?.build ?? -1;
      drawMessages();
    });
    return element("div", { class: `message ${m.severity}` }, close,
      element("div", {}, place ? element("span", { class: "place" }, `${place}: `) : null, m.message,
        m.path ? element("span", { class: "place" }, ` (at ${m.path})`) : null),
      m.text ? element("pre", {}, m.text) : null,
      m.remedy ? element("p", { class: "remedy" }, `→ ${m.remedy}`) : null);
  }));
}

document.addEventListener("problem", (event) => {
  localProblem = event.detail;
  drawMessages();
});

// ---- What runs ----

const kSizes = ["128x128", "256x256", "512x512", "768x768", "1024x1024", "640x360", "1280x720", "1920x1080"];

function fill(select, names, chosen) {
  const all = names.includes(chosen) ? names : [chosen, ...names];
  select.replaceChildren(...all.map((name) => element("option", { value: name, selected: name === chosen }, name)));
}

function drawChoices() {
  const { state } = store;
  fill(byId("graph"), state.graphs, state.graph_name);
  fill(byId("scene"), state.scenes, state.scene);
  fill(byId("size"), kSizes, `${state.size[0]}x${state.size[1]}`);
  byId("device").textContent = state.device;
  byId("device").title = `${state.device}; fovea ${state.version}`;
  byId("graph").title = state.graph.description;
  document.title = `${state.graph_name} over ${state.scene} — fovea`;
}

function choose(id, command) {
  byId(id).addEventListener("change", () => {
    localProblem = null;
    document.body.setAttribute("aria-busy", "true");
    control(command(byId(id).value)).catch((error) => {
      localProblem = error.message;
      drawMessages();
    });
  });
}

// ---- Following the run ----

let loading = false;

async function loadState() {
  if (loading) return;
  loading = true;
  try {
    store.state = await getState();
    lastNumbers = -kReadable;
    localProblem = null;
    const known = store.state.graph.outputs.map((o) => o.name);
    const plain = store.source.split("@")[0];
    const there = known.includes(plain)
        || store.state.graph.passes.some((p) => p.ports.some((q) => q.source === plain));
    tell("state", store.state);
    if (!there && known.length) show(known.includes("image") ? "image" : known[0]);
    document.body.removeAttribute("aria-busy");
    document.body.dataset.build = store.state.build;
    drawMessages();
  } finally {
    loading = false;
  }
}

async function onTick(tick) {
  if (!store.state || tick.build !== store.state.build) await loadState();
  if (tick.frame === undefined) return;
  store.tick = tick;
  tell("times", tick);
  soon ??= setTimeout(tellTick, kPatience);
}

// What a frame changes is drawn together with its picture, so that the page is laid out once a frame; the program runs
// on the same machine. Without a picture it is drawn after a moment. Numbers change only so often that one can read
// them.
const kPatience = 150; // milliseconds
const kReadable = 1000; // milliseconds
let soon = null;
let later = null;
let lastNumbers = -kReadable;

function tellTick() {
  clearTimeout(soon);
  soon = null;
  if (!store.tick || store.tick.build !== store.state.build) return;
  tell("tick", store.tick);
  clearTimeout(later);
  const wait = lastNumbers + kReadable - performance.now();
  if (wait <= 0) tellNumbers();
  else later = setTimeout(tellNumbers, wait + kPatience); // in case that no other frame comes
}

function tellNumbers() {
  lastNumbers = performance.now();
  tell("numbers", store.tick);
}

function onLost() {
  localProblem = "The program does not answer; it may have ended.";
  drawMessages();
}

// ---- The preview of what is hovered ----

let previewed = null;
let previewTimer = null;

async function runPreview(request) {
  const image = byId("preview").querySelector("img");
  const caption = byId("preview").querySelector("figcaption");
  let number = 0;
  while (previewed === request) {
    try {
      const shot = await getPicture({ source: request.source, after: number, width: 240, quality: 85, fit: 1 });
      if (previewed !== request) return;
      if (shot) {
        number = shot.number;
        const before = image.src;
        if (shot.blob.size > 0) image.src = URL.createObjectURL(shot.blob);
        image.hidden = shot.blob.size === 0;
        if (before.startsWith("blob:")) URL.revokeObjectURL(before);
        caption.textContent = shot.blob.size > 0
            ? request.title : `${request.title}: a buffer; click to see its numbers`;
        byId("preview").hidden = false;
      }
    } catch (error) {
      caption.textContent = error.message;
      image.hidden = true;
      byId("preview").hidden = false;
      return;
    }
    await new Promise((resume) => setTimeout(resume, 150));
  }
}

on("preview", (request) => {
  clearTimeout(previewTimer);
  previewed = request && request.source !== store.source ? request : null;
  if (!previewed) {
    byId("preview").hidden = true;
    return;
  }
  previewTimer = setTimeout(() => runPreview(request), 120);
});
on("source", () => {
  previewed = null;
  byId("preview").hidden = true;
});

// ---- Panels and keys ----

function togglePanel(side) {
  const hidden = byId("main").classList.toggle(`no-${side}`);
  byId(`toggle-${side}`).setAttribute("aria-expanded", String(!hidden));
}

function toggleWide() {
  const wide = String(byId("main").classList.toggle("wide"));
  for (const button of document.querySelectorAll(".widen")) button.setAttribute("aria-pressed", wide);
}

function showKeys() {
  byId("keys").showModal();
}

function start() {
  for (const part of [picture, look, region, points, compare, move, timings, graph, resources, parameters]) part.start();
  on("state", drawChoices);
  on("picture", tellTick);
  on("toggle-false-color", look.toggleFalseColor);
  on("flip", compare.flip);
  choose("graph", (name) => ({ graph: name }));
  choose("scene", (name) => ({ scene: name }));
  choose("size", (name) => ({ size: name.split("x").map(Number) }));
  byId("toggle-left").addEventListener("click", () => togglePanel("left"));
  byId("toggle-right").addEventListener("click", () => togglePanel("right"));
  for (const button of document.querySelectorAll(".widen")) button.addEventListener("click", toggleWide);
  byId("help").addEventListener("click", showKeys);
  for (const [, label, what] of move.keys)
    if (label) byId("key-list").append(element("dt", {}, label), element("dd", {}, what));
  for (const [label, what] of [...move.held, ["[ ]", "hide and show the panels"], ["X", "more room for the graph"],
      ["/", "find a pass in the graph"],
      ["wheel, Shift-drag", "zoom and pan"],
    ["drag", "turn the camera"], ["Ctrl-drag", "numbers of a region"], ["click", "numbers of the nearest point"]])
    byId("key-list").append(element("dt", {}, label), element("dd", {}, what));
  addEventListener("keydown", (event) => {
    if (event.target.closest("input, select, dialog") || event.ctrlKey || event.metaKey) return;
    if (event.key === "[") togglePanel("left");
    if (event.key === "]") togglePanel("right");
    if (event.key === "x") toggleWide();
    if (event.key === "?") showKeys();
    if (event.key === "/") {
      event.preventDefault();
      graph.focusFind();
    }
  });
  listen(onTick, onLost);
}

start();
