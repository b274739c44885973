// A second graph beside the first: split, flip, difference, and how far the two are apart.
import { control, getPicture, paint, queryOf } from "./api.js";
import { element, row } from "./dom.js";
import { place, wantsExact } from "./picture.js";
import { on, store } from "./store.js";

const root = document.getElementById("compare");
const stage = document.getElementById("stage");
const canvas = document.getElementById("second");
const divider = document.getElementById("divider");
const context = canvas.getContext("2d", { alpha: false });

let mode = "split";
let share = 0.5; // of the picture that shows the first graph
let running = false;
let abort = null;

const graph = element("select", { id: "second-graph" });
const modes = element("select", { id: "compare-mode" }, ...[["split", "split"], ["second", "second graph alone"],
  ["difference", "difference"]].map(([value, text]) => element("option", { value }, text)));
const slider = element("input", { type: "range", id: "split", min: 0, max: 1, step: 0.005, value: 0.5 });
const gain = element("select", { id: "gain" }, ...[0, 2, 4, 6].map((stops) =>
  element("option", { value: stops }, `× ${2 ** stops}`)));
const accumulate = element("input", { type: "checkbox", id: "accumulate" });
const measures = element("div", { id: "measures" });
const options = element("div");

export const active = () => Boolean(store.state?.second);

// What is compared is an output that both graphs have; null for anything else.
function sourceOfSecond() {
  const { graph: first, second_graph: second } = store.state;
  const output = first.outputs.find((o) => o.name === store.source || o.source === store.source);
  return output && second.some((o) => o.name === output.name) ? `second!${output.name}` : null;
}

// ---- The picture ----

function arrange() {
  canvas.style.transform = `translate(${place.x}px, ${place.y}px) scale(${place.scale})`;
  canvas.style.imageRendering = place.scale >= 1 ? "pixelated" : "auto";
  const split = mode === "split";
  canvas.style.clipPath = split ? `inset(0 0 0 ${100 * share}%)` : "none";
  divider.hidden = !active() || !split || canvas.hidden;
  divider.style.transform = `translate(${place.x + share * canvas.width * place.scale - 6}px, ${place.y}px)`;
  divider.style.height = `${canvas.height * place.scale}px`;
}

function request() {
  const { source } = store;
  const display = { ...store.display, exact: wantsExact() ? 1 : "" };
  if (mode !== "difference") return { source: sourceOfSecond(), ...display };
  return { source, minus: sourceOfSecond(), ...display, low: 0, high: 1, fit: "", exposure: Number(gain.value) };
}

async function run() {
  if (running) return;
  running = true;
  let number = 0;
  let asked = "";
  while (active()) {
    if (!sourceOfSecond()) {
      canvas.hidden = true;
      arrange();
      measures.replaceChildren(element("p", { class: "note" }, "Choose an output that both graphs have."));
      await new Promise((resume) => setTimeout(resume, 300));
      continue;
    }
    const values = request();
    const key = queryOf(values);
    if (key !== asked) number = 0;
    asked = key;
    abort = new AbortController();
    try {
      const picture = await getPicture({ ...values, after: number }, abort.signal);
      if (picture && picture.blob.size > 0) {
        number = picture.number;
        await paint(context, picture);
        canvas.hidden = false;
        canvas.dataset.frame = picture.frame;
        canvas.dataset.mode = mode;
        arrange();
      } else await new Promise((resume) => setTimeout(resume, 100));
    } catch (error) {
      if (error.name !== "AbortError") {
        canvas.hidden = true;
        measures.replaceChildren(element("p", { class: "note" }, error.message));
        await new Promise((resume) => setTimeout(resume, 700));
      }
    }
  }
  canvas.hidden = true;
  arrange();
  running = false;
}

// ---- Numbers ----

let timer = null;

function number(value, digits = 3) {
  return value === null || value === undefined ? "—" : Math.abs(value) < 0.001 && value !== 0
      ? value.toExponential(2) : value.toPrecision(digits);
}

async function measure() {
  timer = null;
  if (!active() || !sourceOfSecond()) return;
  try {
    const answer = await fetch(`measures?${queryOf({ source: store.source, reference: sourceOfSecond() })}`);
    if (answer.ok && answer.status !== 204) {
      const m = await answer.json();
      const line = (name, r) => element("tr", {}, element("td", {}, name),
          element("td", { class: "number" }, number(r.mse)),
        element("td", { class: "number" }, r.psnr === null ? "∞" : number(r.psnr)),
            element("td", { class: "number" }, number(r.flip)));
      const rows = [line("whole", m.whole)];
      if (m.fovea.pixels) rows.unshift(line("fovea", m.fovea), line("periphery", m.periphery));
      measures.dataset.frames = m.frames;
      measures.dataset.mse = m.whole.mse;
      measures.replaceChildren(element("table", {}, element("thead", {}, element("tr", {}, element("th", {}, ""),
        ...["MSE", "PSNR", "FLIP"].map((t) => element("th", { class: "number" }, t)))), element("tbody", {}, ...rows)),
      element("p", { class: "note" }, m.frames > 1
          ? `against the mean of ${m.frames} frames of the second graph` : "of one frame"));
    } else if (answer.status === 404) {
      measures.replaceChildren(element("p", { class: "note" }, (await answer.text()).trim()));
    }
  } catch {
    // Tried again below.
  }
  timer ??= setTimeout(measure, 1500);
}

// ---- Controls ----

function draw() {
  const { state } = store;
  graph.replaceChildren(element("option", { value: "" }, "none"),
    ...state.graphs.map((name) => element("option", { value: name, selected: name === state.second }, name)));
  accumulate.checked = state.accumulate;
  options.hidden = !active();
  if (!active()) return;
  run();
  timer ??= setTimeout(measure, 300);
}

const splitRow = row("Split", "split", slider);
const gainRow = row("Gain", "gain", gain);

function showRows() {
  splitRow.hidden = mode !== "split";
  gainRow.hidden = mode !== "difference";
}

function setShare(value) {
  share = Math.min(1, Math.max(0, value));
  slider.value = share;
  arrange();
}

export function flip() {
  if (!active()) return;
  modes.value = mode = mode === "second" ? "split" : "second";
  showRows();
  if (mode === "split") setShare(1);
  abort?.abort();
  arrange();
}

export function start() {
  options.append(row("Show", "compare-mode", modes), splitRow, gainRow,
      row("Add up", "accumulate", element("div", { class: "pair" }, accumulate,
      element("span", { class: "doc" }, "its frames while nothing moves"))), measures);
  root.append(row("Second", "second-graph", graph), options);
  const ask = (command) => control(command).catch((error) =>
    document.dispatchEvent(new CustomEvent("problem", { detail: error.message })));
  graph.addEventListener("change", () => ask({ second: graph.value }));
  accumulate.addEventListener("change", () => ask({ accumulate: accumulate.checked }));
  slider.addEventListener("input", () => setShare(Number(slider.value)));
  showRows();
  modes.addEventListener("change", () => {
    mode = modes.value;
    showRows();
    abort?.abort();
    arrange();
  });
  gain.addEventListener("change", () => abort?.abort());
  divider.addEventListener("pointerdown", (event) => {
    event.stopPropagation();
    divider.setPointerCapture(event.pointerId);
  });
  divider.addEventListener("pointermove", (event) => {
    if (!divider.hasPointerCapture(event.pointerId)) return;
    event.stopPropagation();
    setShare((event.clientX - stage.getBoundingClientRect().left - place.x) / (canvas.width * place.scale));
  });
  on("state", draw);
  on("place", arrange);
  on("source", () => {
    abort?.abort();
    if (active()) timer ??= setTimeout(measure, 300);
  });
  on("display", () => abort?.abort());
  on("exact", () => abort?.abort());
}
