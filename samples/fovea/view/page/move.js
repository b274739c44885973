// Camera, time and gaze: with the mouse on the picture, and with keys alone.
import { control, newest } from "./api.js";
import { svg } from "./dom.js";
import { fitPicture, pan, pictureAt, place, zoom } from "./picture.js";
import { on, show, store, tell } from "./store.js";

const stage = document.getElementById("stage");
const marks = document.getElementById("gaze-marks");
const kPanels = "#messages, #table, #element"; // on the stage, where the mouse is not for the picture
const button = (id) => document.getElementById(id);

let orbiting = false;
let gazing = false;
let pose = null; // { position, yaw, pitch }, while it is steered from here
let steeredAt = -Infinity;
let pivotDistance = 3;
const pressed = new Set();

function problem(error) {
  document.dispatchEvent(new CustomEvent("problem", { detail: error.message }));
}
const ask = (command) => control(command).catch(problem);

function forwardOf({ yaw, pitch }) {
  return [-Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), -Math.cos(yaw) * Math.cos(pitch)];
}
function rightOf({ yaw }) {
  return [Math.cos(yaw), 0, -Math.sin(yaw)];
}
const added = (a, b, s = 1) => a.map((v, i) => v + s * b[i]);

function sceneSize() {
  const [low, high] = store.state.bounds;
  const size = Math.hypot(...added(high, low, -1));
  return Number.isFinite(size) && size > 0 ? Math.min(size, 1e4) : 10;
}

function current() {
  if (performance.now() - steeredAt > 700 || !pose) {
    const { position, yaw, pitch } = store.tick.camera;
    pose = { position: [...position], yaw, pitch };
  }
  steeredAt = performance.now();
  return pose;
}

function send() {
  pose.pitch = Math.min(1.55, Math.max(-1.55, pose.pitch));
  newest.send({ camera: pose });
}

function turn(dx, dy) {
  if (!store.tick?.camera) return;
  const p = current();
  if (orbiting) {
    const pivot = added(p.position, forwardOf(p), pivotDistance);
    p.yaw -= dx;
    p.pitch = Math.min(1.55, Math.max(-1.55, p.pitch - dy));
    p.position = added(pivot, forwardOf(p), -pivotDistance);
  } else {
    p.yaw += dx;
    p.pitch += dy;
  }
  send();
}

function move(right, up, forward) {
  if (!store.tick?.camera) return;
  const p = current();
  p.position = added(p.position, rightOf(p), right);
  p.position = added(p.position, forwardOf(p), forward);
  p.position[1] += up;
  send();
}

// ---- Gaze ----

function sendGaze(x, y) {
  newest.send({ gaze: [Math.min(1, Math.max(0, x)), Math.min(1, Math.max(0, y))] });
}

// The gaze jumps to the other side of the picture, as an eye does.
function saccade() {
  const [x, y] = store.tick.gaze;
  const far = Math.hypot(x - 0.5, y - 0.5) > 0.15;
  sendGaze(...(far ? [1 - x, 1 - y] : [0.2, 0.3]));
}

function setGazing(value) {
  gazing = value;
  button("gaze").setAttribute("aria-pressed", String(value));
  stage.classList.toggle("looking", value);
  if (!value) ask({ gaze: null });
}

// The foveal circle and a cross where the eye looks.
function drawGaze() {
  const radius = store.state?.fovea_radius ?? 0;
  const gaze = store.tick?.gaze;
  const picture = store.picture;
  if (!gaze || !picture || !radius || picture.width !== store.state.size[0]) {
    marks.replaceChildren();
    return;
  }
  const x = place.x + gaze[0] * picture.width * place.scale;
  const y = place.y + gaze[1] * picture.height * place.scale;
  const r = radius * picture.width * place.scale;
  const cross = `M${x - 6} ${y}H${x + 6}M${x} ${y - 6}V${y + 6}`;
  marks.replaceChildren(
    svg("circle", { class: "shade", cx: x, cy: y, r }), svg("circle", { id: "fovea", cx: x, cy: y, r }),
    svg("path", { class: "shade", d: cross }), svg("path", { d: cross }));
}

// ---- Time ----

function showTime() {
  const { tick } = store;
  if (tick?.frame === undefined) return;
  button("play").setAttribute("aria-pressed", String(tick.playing && !tick.frozen));
  button("freeze").setAttribute("aria-pressed", String(tick.frozen));
  button("camera").setAttribute("aria-pressed", String(!tick.camera.own));
  button("record").setAttribute("aria-pressed", String(tick.recording));
  button("record").textContent = tick.recording ? `Stop (${tick.recorded})` : "Record";
  button("gaze-file").hidden = button("camera-file").hidden = !tick.recorded || tick.recording;
  const rate = tick.fps >= 10 ? tick.fps.toFixed(0) : tick.fps.toFixed(1);
  button("clock").textContent =
    `frame ${tick.frame} · ${tick.time.toFixed(2)} s · ${tick.frozen ? "frozen" : `${rate} frames/s`}`;
}

const actions = {
  play: () => ask(store.tick.frozen ? { frozen: false, playing: true } : { playing: !store.tick.playing }),
  freeze: () => ask({ frozen: !store.tick.frozen }),
  step: () => ask({ step: 1 }),
  restart: () => ask({ restart: true }),
  camera: () => {
    pose = null;
    ask({ camera: null });
  },
  gaze: () => setGazing(!gazing),
  orbit: () => {
    orbiting = !orbiting;
    pivotDistance = 0.35 * sceneSize();
    button("orbit").setAttribute("aria-pressed", String(orbiting));
  },
  record: () => {
    if (!store.tick.recording && !gazing) setGazing(true);
    ask({ recording: !store.tick.recording });
  },
};

function nextSource(step) {
  const list = [...document.getElementById("source").options].map((o) => o.value);
  const at = list.indexOf(store.source.split("@")[0]);
  show(list[(at + step + list.length) % list.length]);
}

// Keys that act once. Shown by the dialog of keys.
export const keys = [
  [" ", "Space", "time runs or stands still", actions.play],
  ["f", "F", "freeze: render nothing until something changes", actions.freeze],
  [".", ".", "one frame, then freeze", actions.step],
  ["r", "R", "start again at frame 0", actions.restart],
  ["c", "C", "the scene's own camera", actions.camera],
  ["o", "O", "drag turns around the middle", actions.orbit],
  ["g", "G", "the eye looks where the mouse is", actions.gaze],
  ["v", "V", "a saccade: the gaze jumps across the picture", saccade],
  ["n", "N, P", "next and previous source", () => nextSource(1)],
  ["p", null, null, () => nextSource(-1)],
  ["h", "H", "false colour", () => tell("toggle-false-color")],
  ["b", "B", "the first or the second graph of a comparison", () => tell("flip")],
  ["0", "0", "fit the picture into the window", fitPicture],
  ["+", "+, −", "make the picture larger or smaller", () => zoom(1.25)],
  ["-", null, null, () => zoom(0.8)],
];
export const held = [
  ["W A S D", "fly; Q down, E up; Shift faster"],
  ["Arrows", "turn the camera; with Shift, move the picture"],
  ["I J K L", "move the gaze"],
];

const kMoves = { w: [0, 0, 1], s: [0, 0, -1], a: [-1, 0, 0], d: [1, 0, 0], q: [0, -1, 0], e: [0, 1, 0] };
const kTurns = { arrowleft: [1, 0], arrowright: [-1, 0], arrowup: [0, 1], arrowdown: [0, -1] };
const kGaze = { j: [-1, 0], l: [1, 0], i: [0, -1], k: [0, 1] };

let last = 0;
let ownGaze = null;

function whileHeld(now) {
  if (pressed.size === 0) {
    last = 0;
    ownGaze = null;
    return;
  }
  const seconds = last ? Math.min(0.1, (now - last) / 1000) : 0.016;
  last = now;
  const fast = pressed.has("shift");
  const speed = 0.12 * sceneSize() * seconds * (fast ? 4 : 1);
  for (const key of pressed) {
    if (kMoves[key]) move(...kMoves[key].map((v) => v * speed));
    if (kTurns[key]) {
      const [x, y] = kTurns[key];
      if (fast) pan(400 * x * seconds, 400 * y * seconds);
      else turn(1.2 * x * seconds, 1.2 * y * seconds);
    }
    if (kGaze[key] && store.tick?.gaze) {
      ownGaze ??= [...store.tick.gaze];
      ownGaze = kGaze[key].map((v, i) => Math.min(1, Math.max(0, ownGaze[i] + 0.5 * v * seconds)));
      sendGaze(...ownGaze);
    }
  }
  requestAnimationFrame(whileHeld);
}

function isTyping(event) {
  return event.target.closest("input, select, textarea, dialog") || event.ctrlKey || event.metaKey || event.altKey;
}

function onKeyDown(event) {
  if (isTyping(event)) return;
  const key = event.key.toLowerCase();
  if (kMoves[key] || kTurns[key] || kGaze[key] || key === "shift") {
    const scrolls = kTurns[key] && event.target.closest("aside");
    if (scrolls) return;
    if (key !== "shift") event.preventDefault();
    const idle = pressed.size === 0;
    pressed.add(key);
    if (idle) requestAnimationFrame(whileHeld);
    return;
  }
  // A button that has the focus answers to the space bar itself.
  if (key === " " && event.target.closest("button, summary, a")) return;
  const action = keys.find(([name]) => name === key);
  if (!action || !store.tick) return;
  event.preventDefault();
  action[3]();
}

let drag = null;

export function start() {
  for (const [id, action] of Object.entries(actions))
    button(id).addEventListener("click", () => store.tick && action());
  button("speed").addEventListener("change", () => ask({ speed: Number(button("speed").value) }));
  addEventListener("keydown", onKeyDown);
  addEventListener("keyup", (event) => pressed.delete(event.key.toLowerCase()));
  addEventListener("blur", () => pressed.clear());

  stage.addEventListener("pointerdown", (event) => {
    if (event.ctrlKey || event.target.closest(kPanels)) return;
    stage.focus({ preventScroll: true });
    drag = { x: event.clientX, y: event.clientY, flat: event.button !== 0 || event.shiftKey };
    stage.setPointerCapture(event.pointerId);
    stage.classList.add("turning");
  });
  stage.addEventListener("contextmenu", (event) => !event.target.closest(kPanels)
      && event.preventDefault());
  stage.addEventListener("pointermove", (event) => {
    if (drag) {
      const dx = event.clientX - drag.x;
      const dy = event.clientY - drag.y;
      drag.x = event.clientX;
      drag.y = event.clientY;
      // The picture follows the hand: the point that is held stays under it.
      const angle = (store.tick?.camera?.fov ?? 0.8) / Math.max(1, (store.picture?.height ?? 512) * place.scale);
      if (drag.flat) pan(dx, dy);
      else turn(dx * angle, dy * angle);
    } else if (gazing && store.picture) {
      const at = pictureAt(event.clientX, event.clientY);
      sendGaze(at.x / store.picture.width, at.y / store.picture.height);
    }
  });
  for (const end of ["pointerup", "pointercancel"])
    stage.addEventListener(end, () => {
      drag = null;
      stage.classList.remove("turning");
    });
  stage.addEventListener("dblclick", (event) => !event.target.closest(kPanels) && fitPicture());

  on("tick", () => {
    showTime();
    drawGaze();
  });
  on("place", drawGaze);
  on("picture", drawGaze);
}
