// The elements of buffers: their fields, as the shaders of the graph declare them, and tables of their numbers.
import { getPixels } from "./api.js";
import { element, floatText } from "./dom.js";
import { portOf, store } from "./store.js";

const table = document.getElementById("table");
const kRows = 256;

// Fields that only fill the gaps between others are left out. A type that no shader declares has a field for each word.
export function fieldsOf(port, words) {
  if (!port?.fields)
    return Array.from({ length: words }, (_, i) => ({ name: `word ${i}`, offset: i, components: 1, type: "word" }));
  return port.fields.filter((f) => !/^unused\d*$/.test(f.name) && f.offset + f.components <= words)
    .map((f) => ({ ...f, name: f.name || "value" }));
}

// A word of unknown type is shown as a float where that is plausible, otherwise as a whole number.
function wordText(whole, float) {
  const plausible = float === 0 ? whole === 0 : Math.abs(float) > 1e-12 && Math.abs(float) < 1e12;
  return plausible ? floatText(float) : String(whole);
}

// The elements of a buffer as they were read, all words of an element after another.
export class Elements {
  constructor(port, read) {
    this.fields = fieldsOf(port, read.channels);
    this.count = read.values.length / read.channels;
    this.frame = read.frame;
    this.stride = read.channels;
    this.floats = new Float32Array(read.bytes);
    this.uints = new Uint32Array(read.bytes);
    this.ints = new Int32Array(read.bytes);
  }

  // `digits` shortens floats, which are exact without it.
  text(index, field, digits = null) {
    const texts = [];
    for (let c = 0; c < field.components; ++c) {
      const i = index * this.stride + field.offset + c;
      const float = this.floats[i];
      if (field.type === "float")
        texts.push(digits && Number.isFinite(float) ? String(Number(float.toPrecision(digits))) : floatText(float));
      else if (field.type === "int") texts.push(String(this.ints[i]));
      else if (field.type === "uint") texts.push(String(this.uints[i]));
      else texts.push(wordText(this.uints[i], float));
    }
    return texts.join(", ");
  }

  isEmpty(index) {
    const first = index * this.stride;
    for (let i = first; i < first + this.stride; ++i) if (this.uints[i] !== 0) return false;
    return true;
  }

  // The three floats of a field.
  vector(index, field) {
    const first = index * this.stride + field.offset;
    return this.floats.subarray(first, first + 3);
  }
}

// Elements `first` to `first` + `count` of a buffer; null if there is none for now.
export async function getElements(port, first, count) {
  const read = await getPixels(port.source, first, 0, count, 1);
  return read && read.values.length > 0 ? new Elements(port, read) : null;
}

export async function drawTable() {
  const port = portOf(store.source);
  const shown = port && await getElements(port, 0, kRows);
  if (!shown || store.source !== port.source) return;
  const head = element("tr", {}, element("th", { scope: "col" }, "element"),
    ...shown.fields.map((f) => element("th", { class: "number", scope: "col" }, f.name)));
  const body = Array.from({ length: shown.count }, (_, i) => element("tr", { class: shown.isEmpty(i) ? "empty" : "" },
    element("th", { scope: "row" }, String(i)),
    ...shown.fields.map((f) => element("td", { class: "number" }, shown.text(i, f)))));
  const about = port.fields ? "" : " No shader declares its type: a word is shown as a float where that is " +
    "plausible, otherwise as a whole number.";
  table.replaceChildren(
    element("p", { class: "note" }, `${port.doc ? `${port.doc}. ` : ""}${port.is}: the first ${shown.count} of ` +
      `${port.count} elements in frame ${shown.frame}.${about}`),
    element("table", {}, element("thead", {}, head), element("tbody", {}, ...body)));
}
