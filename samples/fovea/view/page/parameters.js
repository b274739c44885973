// Controls for the parameters of the graph and of its passes, made of their declarations.
import { control, newest } from "./api.js";
import { element } from "./dom.js";
import { on, store } from "./store.js";

const list = element("div");
let open = new Set();
let filter = "";

function send(name, value) {
  newest.send({ set: { [name]: value } });
}

function numberText(value) {
  return typeof value === "number" ? String(Number(value.toPrecision(7))) : String(value);
}

// A slider only where the range is one that a hand can choose from; long ranges are walked by factors.
function slider(parameter, number, whole) {
  const { min, max } = parameter;
  if (min === undefined || max === undefined || max - min > 1e7) return null;
  const steps = 200;
  const far = max > 1000 * Math.max(1, Math.abs(min)) && min >= 0;
  const toValue = (t) => {
    const v = far ? min + ((1 + max - min) ** (t / steps) - 1) : min + ((max - min) * t) / steps;
    return whole ? Math.round(v) : Number(v.toPrecision(4));
  };
  const toStep = (v) =>
    steps * (far ? Math.log1p(v - min) / Math.log1p(max - min) : (v - min) / (max - min || 1));
  const fine = far || !whole || max - min > steps;
  const range = element("input", { type: "range", min: 0, max: steps, step: fine ? 0.5 : "any",
    "aria-label": parameter.name, "aria-valuetext": number.value });
  range.value = toStep(Number(number.value));
  range.addEventListener("input", () => {
    number.value = toValue(Number(range.value));
    range.setAttribute("aria-valuetext", number.value);
    number.dispatchEvent(new Event("change"));
  });
  return range;
}

function input(parameter, name, id) {
  const { type, value } = parameter;
  if (type === "bool" && !parameter.choices) {
    const box = element("input", { type: "checkbox", id });
    box.checked = String(value) === "true";
    box.addEventListener("change", () => send(name, box.checked));
    return [box];
  }
  if (parameter.choices) {
    const options = parameter.choices.map((c) => element("option", { value: c, selected: c === String(value) }, c));
    const select = element("select", { id }, ...options);
    select.addEventListener("change", () => send(name, type === "choice" ? select.value : JSON.parse(select.value)));
    return [select];
  }
  if (type === "text") {
    const text = element("input", { type: "text", id, value });
    text.addEventListener("change", () => send(name, text.value));
    return [text];
  }
  const number = element("input", { type: "number", id, min: parameter.min, max: parameter.max,
    step: type === "int" ? 1 : "any", value: numberText(Number(value)) });
  number.addEventListener("change", () => number.value !== "" && send(name, Number(number.value)));
  return [slider(parameter, number, type === "int"), number];
}

function rangeText({ min, max, type, default: standard }) {
  const parts = [];
  if (type === "int" || type === "real") {
    if (min !== undefined && max !== undefined) parts.push(`${numberText(min)} to ${numberText(max)}`);
    else if (min !== undefined) parts.push(`at least ${numberText(min)}`);
  }
  parts.push(`default ${numberText(standard)}`);
  return parts.join(", ");
}

function parameterRow(parameter, name) {
  const id = `parameter-${name}`;
  const reset = parameter.changed
    ? element("button", { type: "button", class: "link", title: "As in the graph file",
        onclick: () => send(name, null) }, "reset")
    : null;
  const label = element("div", { class: "name" }, element("label", { for: id }, parameter.name),
    parameter.unit ? element("span", { class: "unit" }, parameter.unit) : null, reset);
  const about = [parameter.doc, rangeText(parameter)].filter(Boolean).join(" · ");
  return element("div", { class: `parameter${parameter.changed ? " changed" : ""}`, "data-name": name }, label,
    element("div", { class: "pair" }, ...input(parameter, name, id)), element("span", { class: "doc" }, about));
}

function matches(text) {
  return !filter || text.toLowerCase().includes(filter);
}

// Of a pass or of an instance of a sub-graph.
function passGroup(pass) {
  const own = pass.parameters.filter((p) => !p.given_by && matches(`${pass.name}.${p.name} ${p.doc}`));
  if (!own.length) return null;
  const changed = own.some((p) => p.changed);
  const group = element("details", { class: "group", open: open.has(pass.name) || Boolean(filter) || changed,
      "data-pass": pass.name },
    element("summary", {}, `${pass.name} (${own.length})`),
    pass.name.includes("/") ? element("p", { class: "note" }, "Inside of a sub-graph: changes show and can be copied " +
      "as --set, but a saved graph cannot hold them.") : null,
    ...own.map((p) => parameterRow(p, `${pass.name}.${p.name}`)));
  group.addEventListener("toggle", () => (group.open ? open.add(pass.name) : open.delete(pass.name)));
  return group;
}

// Stays while the controls below it are made anew, so that a name is not lost half-written nor a click half-done.
function saveForm() {
  const name = element("input", { type: "text", id: "save-name", placeholder: "name",
      "aria-label": "Name of the new graph",
    pattern: "[A-Za-z0-9_\\-]+", size: 12 });
  const say = (text) => (note.textContent = text);
  const note = element("span", { class: "note", role: "status" });
  const save = element("button", { type: "button", id: "save" }, "Save graph");
  save.addEventListener("click", () => {
    if (!name.value) {
      say("give it a name");
      name.focus();
      return;
    }
    control({ save: name.value }).catch((error) => say(error.message));
  });
  const copy = element("button", { type: "button", id: "copy" }, "Copy as --set");
  copy.addEventListener("click", async () => {
    const { set } = store.state;
    const text = set.map((s) => `--set ${/^[\w.=\-/]+$/.test(s) ? s : `'${s}'`}`).join(" ");
    copy.dataset.text = text;
    try {
      await navigator.clipboard.writeText(text);
      say("copied");
    } catch {
      say(text);
    }
  });
  const reset = element("button", { type: "button", id: "reset-all", onclick: () => control({ reset: true }) },
      "Reset all");
  on("state", ({ set }) => {
    for (const b of [save, copy, reset]) b.disabled = set.length === 0;
    say("");
  });
  return element("div", { class: "actions" }, name, save, copy, reset, note);
}

function findField() {
  const find = element("input", { type: "text", id: "find-parameter", placeholder: "find a parameter",
    "aria-label": "Find a parameter" });
  find.addEventListener("input", () => {
    filter = find.value.trim().toLowerCase();
    draw();
  });
  return find;
}

// Makes the controls anew, but not under the hand that moves one.
function draw() {
  const { graph } = store.state;
  const focused = list.contains(document.activeElement) ? document.activeElement.id : null;
  if (list.querySelector("input[type=range]:active")) {
    later = true;
    return;
  }
  const group = (legend, parameters, prefix) => {
    const shown = parameters.filter((p) => matches(`${prefix}${p.name} ${p.doc}`));
    return shown.length ? [element("fieldset", {}, element("legend", {}, legend),
      ...shown.map((p) => parameterRow(p, prefix + p.name)))] : [];
  };
  list.replaceChildren(
    ...group("of the graph", graph.parameters, ""),
    ...group("of the frame", graph.view, "view."),
    ...[["of its sub-graphs", graph.sub_graphs], ["of its passes", graph.passes]].flatMap(([legend, passes]) => {
      const groups = passes.map(passGroup).filter(Boolean);
      return groups.length ? [element("fieldset", {}, element("legend", {}, legend), ...groups)] : [];
    }));
  if (focused) document.getElementById(focused)?.focus();
}
let later = false;

export function start() {
  document.getElementById("parameters").append(saveForm(), findField(), list);
  on("state", draw);
  addEventListener("pointerup", () => {
    if (!later) return;
    later = false;
    setTimeout(draw, 50);
  });
}
