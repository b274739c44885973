// The picture: fetches the newest one, draws it, zooms and pans, and tells the pixel under the cursor.
import { getPicture, getPixels, paint } from "./api.js";
import { drawTable } from "./buffers.js";
import { floatText } from "./dom.js";
import { on, portOf, store, tell } from "./store.js";

const stage = document.getElementById("stage");
const canvas = document.getElementById("canvas");
const overlay = document.getElementById("overlay");
const table = document.getElementById("table");
const pixel = document.getElementById("pixel");
const waiting = document.getElementById("waiting");
const context = canvas.getContext("2d", { alpha: false });

// Where the picture is on the stage, in CSS pixels.
export const place = { scale: 1, x: 0, y: 0, fitted: true };

let abort = null; // of the request under way
let fresh = true; // draw at once, whatever the number of the picture
let asking = false; // for a picture with its pixels as they are
let rested = false; // nothing newer has come for a moment
let restTimer = null;

// Whether the page gets pixels as they are: always, unless the picture is large and moves. Compression shows where one
// looks closely.
const kSmall = 2 ** 16; // pixels
const kRest = 250; // milliseconds
export function wantsExact() {
  const { picture, tick } = store;
  return rested || !tick?.moving || tick.frozen || place.scale > 1
      || (picture !== null && picture.width * picture.height <= kSmall);
}

let wasExact = true;

const isWorse = () => store.picture !== null && !store.picture.exact && !store.picture.buffer;

// Asks for the picture again, without loss, if it is shown compressed although its exact pixels are wanted.
function checkExact() {
  const exact = wantsExact();
  if (exact !== wasExact) tell("exact", exact);
  wasExact = exact;
  if (exact && !asking && isWorse()) again();
}

export function fitPicture() {
  if (!store.picture) return;
  const box = stage.getBoundingClientRect();
  const margin = 16;
  const scale = Math.min((box.width - margin) / canvas.width, (box.height - margin) / canvas.height);
  place.scale = scale >= 1 ? Math.floor(scale) : scale;  // all pixels as squares of one size
  place.x = (box.width - canvas.width * place.scale) / 2;
  place.y = (box.height - canvas.height * place.scale) / 2;
  place.fitted = true;
  arrange();
}

function arrange() {
  canvas.style.transform = `translate(${place.x}px, ${place.y}px) scale(${place.scale})`;
  canvas.style.imageRendering = place.scale >= 1 ? "pixelated" : "auto";
  document.getElementById("zoom").textContent = `${Math.round(place.scale * 100)}%`;
  tell("place", place);
}

export function zoom(factor, x, y) {
  const box = stage.getBoundingClientRect();
  const px = x ?? box.width / 2;
  const py = y ?? box.height / 2;
  const scale = Math.min(64, Math.max(0.05, place.scale * factor));
  place.x = px - ((px - place.x) * scale) / place.scale;
  place.y = py - ((py - place.y) * scale) / place.scale;
  place.scale = scale;
  place.fitted = false;
  arrange();
}

export function pan(dx, dy) {
  place.x += dx;
  place.y += dy;
  place.fitted = false;
  arrange();
}

// A point of the stage in pixels of the picture.
export function pictureAt(clientX, clientY) {
  const box = stage.getBoundingClientRect();
  return {
    x: (clientX - box.left - place.x) / place.scale,
    y: (clientY - box.top - place.y) / place.scale,
  };
}

let cursor = null;
let reading = false;
let readAgain = false;

async function readPixel() {
  if (!cursor || !store.picture) return;
  if (reading) {
    readAgain = true;
    return;
  }
  const { x, y } = cursor;
  const source = store.source;
  if (x < 0 || y < 0 || x >= canvas.width || y >= canvas.height) {
    pixel.value = "";
    return;
  }
  reading = true;
  try {
    const read = await getPixels(source, x, y);
    if (read && read.values.length > 0) {
      const texts = [...read.values].map((v) => (read.type === "float32" ? floatText(v) : String(v)));
      pixel.value = `${x}, ${y}   ${texts.join("   ")}`;
      pixel.dataset.frame = read.frame;
    }
  } finally {
    reading = false;
    if (readAgain) {
      readAgain = false;
      readPixel();
    }
  }
}

async function draw(picture) {
  const buffer = picture.blob.size === 0;
  table.hidden = !buffer;
  canvas.hidden = overlay.hidden = buffer;
  waiting.hidden = true;
  const resized = !store.picture || store.picture.width !== picture.width || store.picture.height !== picture.height;
  store.picture = { ...picture, blob: null, pixels: null, buffer };
  if (buffer) {
    await drawTable();
  } else {
    await paint(context, picture);
    if (resized && place.fitted) fitPicture();
  }
  canvas.dataset.frame = picture.frame;
  canvas.dataset.source = store.source;
  canvas.dataset.exact = picture.exact;
  tell("picture", store.picture);
  readPixel();
  if (!picture.exact) waitForRest();
}

function waitForRest() {
  clearTimeout(restTimer);
  restTimer = setTimeout(() => {
    rested = true;
    checkExact();
  }, kRest);
}

// One request at a time: the next one is sent when the last picture has been drawn.
export async function runPictures() {
  for (;;) {
    const source = store.source;
    asking = wantsExact();
    const wanted = fresh || (asking && isWorse()) ? 0 : store.picture?.number ?? 0;
    fresh = false;
    abort = new AbortController();
    try {
      const exact = asking ? 1 : "";
      const picture = await getPicture({ source, after: wanted, ...store.display, exact }, abort.signal);
      rested &&= picture !== null && picture.number === store.picture?.number;
      if (picture && source === store.source) await draw(picture);
      else if (!picture) await new Promise((resume) => setTimeout(resume, 100));
    } catch (error) {
      if (error.name === "AbortError") continue;
      // The program has gone, or the source is not made by this graph.
      waiting.hidden = false;
      waiting.textContent = error instanceof TypeError ? "The program does not answer." : error.message;
      await new Promise((resume) => setTimeout(resume, 700));
    }
  }
}

function again() {
  fresh = true;
  abort?.abort();
}

export function start() {
  on("source", () => {
    document.getElementById("source-name").textContent = nameOf(store.source);
    again();
  });
  on("display", again);
  on("place", checkExact);
  on("tick", checkExact);
  on("state", () => {
    document.getElementById("source-name").textContent = nameOf(store.source);
  });
  new ResizeObserver(() => place.fitted && fitPicture()).observe(stage);
  stage.addEventListener("wheel", (event) => {
    if (event.target.closest("#table, #messages, #element")) return;
    event.preventDefault();
    const box = stage.getBoundingClientRect();
    zoom(Math.exp(-event.deltaY * 0.0015), event.clientX - box.left, event.clientY - box.top);
  }, { passive: false });
  stage.addEventListener("pointermove", (event) => {
    const at = pictureAt(event.clientX, event.clientY);
    cursor = { x: Math.floor(at.x), y: Math.floor(at.y) };
    readPixel();
  });
  stage.addEventListener("pointerleave", () => {
    cursor = null;
    pixel.value = "";
  });
  runPictures();
}

export function nameOf(source) {
  const port = portOf(source);
  return port ? `${source.replace(":", " · ")} — ${port.is}` : source;
}

