// Controls for how a source is shown, and its histogram.
import { getStatistics, newest, queryOf } from "./api.js";
import { element, floatText, row, svg } from "./dom.js";
import { on, portOf, setDisplay, show, store } from "./store.js";

const root = document.getElementById("look");

function option(value, text, selected) {
  return element("option", { value, selected }, text);
}

const source = element("select", { id: "source", onchange: () => show(source.value) });
const part = element("div", { class: "pair" });
const layer = element("input", { type: "number", id: "layer", min: 0, value: 0, "aria-label": "Layer" });
const mip = element("input", { type: "number", id: "mip", min: 0, value: 0, "aria-label": "Mip" });
const channel = element("select", { id: "channel", onchange: () => setDisplay({ channel: channel.value }) });
const curve = element("select", { id: "curve", onchange: () => setDisplay({ curve: curve.value }) },
  option("", "automatic"), option("srgb", "sRGB"), option("linear", "linear"));
const exposure = element("input", { type: "range", id: "exposure", min: -10, max: 10, step: 0.25, value: 0 });
const exposureText = element("output", { for: "exposure" }, "0");
const low = element("input", { type: "number", id: "low", step: "any", value: 0, "aria-label": "Shown black" });
const high = element("input", { type: "number", id: "high", step: "any", value: 1, "aria-label": "Shown white" });
const map = element("select", { id: "map", onchange: () => setMap(map.value),
  title: "Automatic: blue, white and red for single numbers of which any lies below 0" },
option("", "automatic"), option("plain", "plain"), option("helix", "false colour"),
option("signed", "signed: blue, white, red"));
const legend = element("div", { id: "legend", hidden: true });
const histogram = svg("svg", { class: "histogram", viewBox: "0 0 64 40", preserveAspectRatio: "none", role: "img",
  "aria-label": "Histogram" });
const numbers = element("div", { id: "numbers", class: "note" });

function sendRange() {
  setDisplay({ low: Number(low.value), high: Number(high.value), fit: "" });
}

function sendExposure() {
  exposureText.value = exposure.value > 0 ? `+${exposure.value}` : exposure.value;
  setDisplay({ exposure: Number(exposure.value) });
}

function sendPart() {
  const plain = store.source.split("@")[0];
  const chosen = Number(layer.value) || Number(mip.value) ? `@${Number(mip.value)}.${Number(layer.value)}` : "";
  show(plain + chosen);
}

const png = element("a", { id: "png", class: "button", download: "", title: "The picture as it is shown" }, "PNG");
const exr = element("a", { id: "exr", class: "button", download: "",
    title: "Its floats, as fovea render writes them" }, "EXR");

const tev = element("button", { type: "button", id: "tev", hidden: true, onclick: () =>
  newest.send({ tev: store.tick.tev.source === store.source ? "" : store.source }) }, "tev");

function showTev() {
  const state = store.tick?.tev;
  tev.hidden = !state;
  if (!state) return;
  tev.setAttribute("aria-pressed", String(state.source === store.source));
  const where = state.connected ? "tev shows" : "tev, which does not answer yet, is to show";
  tev.title = state.source ? `${where} ${state.source}; click to change that` : "Send this source to tev";
}

function setFiles() {
  png.href = `picture.png?${queryOf({ source: store.source, ...store.display })}`;
  exr.href = `picture.exr?${queryOf({ source: store.source })}`;
}

let statistics = null;

function automaticRange() {
  if (!statistics) return;
  const shown = statistics.channels.slice(0, 3).filter((c) => c.max >= c.min);
  if (!shown.length) return;
  const least = Math.min(...shown.map((c) => c.min));
  const most = Math.max(...shown.map((c) => c.max));
  low.value = floatText(Math.fround(least));
  high.value = floatText(Math.fround(most > least ? most : least + 1));
  sendRange();
}

function resetRange() {
  low.value = 0;
  high.value = 1;
  exposure.value = 0;
  exposureText.value = "0";
  setDisplay({ low: 0, high: 1, exposure: 0, fit: 1 });
}

function drawHistogram() {
  const paths = [];
  if (statistics) {
    const channels = statistics.channels.slice(0, 4);
    const highest = Math.max(1, ...channels.slice(0, 3).flatMap((c) => c.histogram.slice(1)));
    channels.forEach((c, index) => {
      let d = "M0 40";
      c.histogram.forEach((count, i) => {
        const height = 40 * Math.min(1, Math.log1p(count) / Math.log1p(highest));
        d += `V${(40 - height).toFixed(1)}H${i + 1}`;
      });
      paths.push(svg("path", { d: `${d}V40Z`, class: channels.length > 1 ? `c${index}` : "" }));
    });
    const names = channels.length === 1 ? [""] : ["red ", "green ", "blue ", "alpha "];
    const total = (key) => statistics.channels.reduce((sum, c) => sum + c[key], 0);
    const lines = channels.map((c, i) => {
      const [least, most] = [c.min, c.max].map((v) => floatText(Math.fround(v)));
      return `${names[i]}${least} to ${most}, mean ${c.mean.toPrecision(4)}`;
    });
    const wrong = total("nan") + total("infinite");
    if (wrong) lines.push(`${total("nan")} NaN (magenta), ${total("infinite")} infinite (cyan, −Inf orange)`);
    numbers.replaceChildren(...lines.map((line) => element("div", {}, line)));
    numbers.dataset.nan = total("nan");
  }
  histogram.replaceChildren(...paths);
}

const kEvery = 1000; // milliseconds between two questions for numbers
let timer = null;
let last = -kEvery;

// Soon after a picture, also after the last one of a run that stands still.
function update() {
  if (!timer) timer = setTimeout(ask, Math.max(0, last + kEvery - performance.now()));
}

async function ask() {
  last = performance.now();
  const { source, region } = store;
  try {
    if (!portOf(source)?.buffer && root.closest("details").open) {
      const answer = await getStatistics(source, region);
      if (source === store.source && region === store.region && answer) {
        statistics = answer;
        drawHistogram();
      }
    }
  } catch {
    // The next picture asks again.
  }
  timer = null;
}

function fillSources() {
  const { graph } = store.state;
  const outputs = element("optgroup", { label: "outputs of the graph" },
    ...graph.outputs.map((o) => option(o.name, `${o.name} — ${o.is}`)));
  const groups = [outputs];
  for (const pass of graph.passes) {
    const ports = pass.ports.filter((p) => p.made);
    if (!ports.length) continue;
    groups.push(element("optgroup", { label: pass.name },
      ...ports.map((p) => option(p.source, `${p.name} (${p.direction}) — ${p.is}`))));
  }
  source.replaceChildren(...groups);
  showSource();
}

function showSource() {
  setFiles();
  const plain = store.source.split("@")[0];
  source.value = plain;
  const port = portOf(store.source);
  const parts = port && !port.buffer && (port.layers > 1 || port.mips > 1);
  part.parentElement.hidden = !parts;
  if (parts) {
    layer.max = port.layers - 1;
    mip.max = port.mips - 1;
    layer.disabled = port.layers < 2;
    mip.disabled = port.mips < 2;
  }
  root.classList.toggle("buffer", port?.buffer ?? false);
  root.title = port?.doc ?? "";
}

// What the colours of single numbers stand for.
function showLegend() {
  const { picture } = store;
  const mapped = picture && !picture.buffer && (picture.map === "signed" || picture.map === "helix");
  legend.hidden = !mapped;
  if (!mapped) return;
  legend.dataset.map = picture.map;
  const [least, most] = picture.range;
  const texts = picture.map === "signed" ? [least, 0, most] : [least, most];
  legend.replaceChildren(element("div", { class: "bar" }), ...texts.map((v) =>
    element("span", {}, String(Number(v.toPrecision(4))))));
}

export function start() {
  for (const [value, text] of [["color", "colour"], ["red", "red"], ["green", "green"], ["blue", "blue"],
    ["alpha", "alpha"], ["luminance", "luminance"]]) channel.append(option(value, text));
  part.append(layer, element("span", {}, "mip"), mip);
  root.append(
    row("Source", "source", source),
    row("Layer", "layer", part),
    row("Channel", "channel", channel),
    row("Exposure", "exposure", exposure, exposureText, element("span", { class: "unit" }, "EV")),
    row("Range", "low", low, element("span", {}, "to"), high),
    row("", null, element("button", { type: "button", id: "auto-range", title: "From the least to the largest value",
      onclick: automaticRange }, "Fit"),
      element("button", { type: "button", id: "reset-range",
        title: "0 to 1 for colours, the range of their values for all else",
        onclick: resetRange }, "Reset")),
    row("Curve", "curve", curve),
    row("Colours", "map", map), legend,
    row("Keep", null, png, exr, tev),
    histogram, numbers, element("div", { id: "region" }));
  exposure.addEventListener("input", sendExposure);
  for (const input of [low, high]) input.addEventListener("change", sendRange);
  for (const input of [layer, mip]) input.addEventListener("change", sendPart);
  on("state", fillSources);
  on("source", () => {
    statistics = null;
    drawHistogram();
    numbers.replaceChildren();
    showSource();
    update();
  });
  on("display", setFiles);
  on("region", () => {
    last = -kEvery;
    update();
  });
  on("picture", () => {
    update();
    showLegend();
  });
  on("tick", showTev);
}

function setMap(value) {
  map.value = value;
  setDisplay({ map: value });
}

export function toggleFalseColor() {
  setMap(map.value === "helix" ? "" : "helix");
}
