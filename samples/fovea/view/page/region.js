// A part of the picture whose numbers are told: dragged with Ctrl, or typed.
import { queryOf } from "./api.js";
import { element, row, svg } from "./dom.js";
import { pictureAt, place } from "./picture.js";
import { on, setRegion, store } from "./store.js";

const stage = document.getElementById("stage");
const mark = document.getElementById("region-mark");
const names = ["x", "y", "width", "height"];
const labels = ["Left edge", "Upper edge", "Width", "Height"];

const inputs = names.map((name, i) => element("input", { type: "number", id: `region-${name}`, min: i < 2 ? 0 : 1,
  step: 1, placeholder: name[0], title: labels[i], "aria-label": `${labels[i]} of the region` }));
const clear = element("button", { type: "button", id: "region-clear", title: "The numbers of the whole picture",
  onclick: () => setRegion(null) }, "Whole picture");
const raw = element("a", { id: "region-raw", class: "button", download: "" }, "Raw floats");

// The pixels between two points of the picture, so far as they lie in it; null if none do.
function between(a, b) {
  const { width, height } = store.picture;
  const limit = (v, most) => Math.min(most, Math.max(0, v));
  const [left, right] = [Math.min(a.x, b.x), Math.max(a.x, b.x)].map((v) => limit(v, width));
  const [top, bottom] = [Math.min(a.y, b.y), Math.max(a.y, b.y)].map((v) => limit(v, height));
  const region = { x: Math.floor(left), y: Math.floor(top) };
  region.width = Math.ceil(right) - region.x;
  region.height = Math.ceil(bottom) - region.y;
  return region.width > 0 && region.height > 0 ? region : null;
}

function read() {
  const values = inputs.map((input) => (input.value === "" ? null : Math.floor(Number(input.value))));
  if (values.every((v) => v === null)) return setRegion(null);
  if (values.some((v) => v === null) || !store.picture) return undefined;
  const [x, y, width, height] = values;
  return setRegion(between({ x, y }, { x: x + width, y: y + height }));
}

function draw() {
  const { region, picture } = store;
  const fits = region && picture && region.x + region.width <= picture.width
      && region.y + region.height <= picture.height;
  mark.replaceChildren(...(fits ? ["shade", ""].map((name) => svg("rect", { class: name,
    x: place.x + region.x * place.scale, y: place.y + region.y * place.scale,
    width: region.width * place.scale, height: region.height * place.scale })) : []));
}

function showRegion() {
  const { region, source } = store;
  names.forEach((name, i) => (inputs[i].value = region ? region[name] : ""));
  clear.hidden = raw.hidden = !region;
  if (region) {
    const file = `${source.replaceAll(/[^\w.]/g, "_")}_${names.map((n) => region[n]).join("_")}`;
    raw.href = `pixels?${queryOf({ source, ...region })}`;
    raw.download = `${file}.raw`;
    raw.title = `${region.width} × ${region.height} pixels, row after row, each channel in 32 bits`;
  }
  draw();
}

export function start() {
  const box = document.getElementById("region");
  box.append(
    row("Region", "region-x", ...inputs), row("", null, clear, raw));
  for (const input of inputs) input.addEventListener("change", read);
  let from = null; // where the drag began, in the picture
  stage.addEventListener("pointerdown", (event) => {
    if (!event.ctrlKey || !store.picture || event.target.closest("#messages, #table, #element")) return;
    event.preventDefault();
    from = pictureAt(event.clientX, event.clientY);
    stage.setPointerCapture(event.pointerId);
  });
  stage.addEventListener("pointermove", (event) => {
    if (from) setRegion(between(from, pictureAt(event.clientX, event.clientY)));
  });
  for (const end of ["pointerup", "pointercancel"]) stage.addEventListener(end, () => (from = null));
  on("region", showRegion);
  on("place", draw);
  // Pictures of other sources may have another size.
  on("source", showRegion);
  on("picture", () => {
    const { region, picture } = store;
    if (region && (region.x >= picture.width || region.y >= picture.height)) setRegion(null);
    draw();
  });
  showRegion();
}
