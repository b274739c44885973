// What the parts of the page share: the state of the run, the source that is shown and how it is shown.

export const store = {
  state: null, // of the graph that runs (GET state)
  tick: null, // of the newest frame
  source: "image", // that is locked in the picture
  display: { exposure: 0, channel: "color", curve: "", map: "", low: 0, high: 1, fit: 1 },
  region: null, // of the picture, of which numbers are told: x, y, width, height in pixels
  picture: null, // facts about the picture that is drawn: number, frame, width, height, channels, buffer
};

const listeners = new Map();

export function on(what, listener) {
  if (!listeners.has(what)) listeners.set(what, []);
  listeners.get(what).push(listener);
}

export function tell(what, detail) {
  for (const listener of listeners.get(what) ?? []) listener(detail);
}

export function show(source) {
  if (source === store.source) return;
  store.source = source;
  tell("source", source);
}

export function setDisplay(changes) {
  Object.assign(store.display, changes);
  tell("display", store.display);
}

export function setRegion(region) {
  store.region = region;
  tell("region", region);
}

// The port that a source names; undefined if there is none.
export function portOf(source) {
  const graph = store.state?.graph;
  if (!graph) return undefined;
  const plain = source.split("@")[0];
  const output = graph.outputs.find((o) => o.name === plain);
  const name = output ? output.source : plain;
  for (const pass of graph.passes) {
    const port = pass.ports.find((p) => p.source === name);
    if (port) return { ...port, pass: pass.name };
  }
  return undefined;
}

// The port of a pass that says most about it: an output of the graph, else a picture that another pass reads, else any
// picture.
export function mainPort(pass) {
  const { outputs, edges } = store.state.graph;
  const made = pass.ports.filter((p) => p.made && p.direction !== "in");
  const any = made.length ? made : pass.ports.filter((p) => p.made);
  const pictures = any.filter((p) => !p.buffer);
  return pictures.find((p) => outputs.some((o) => o.source === p.source)) ??
    pictures.find((p) => edges.some((e) => e.source === p.source)) ?? pictures[0] ?? any[0];
}
