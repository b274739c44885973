// Talks to the program. All addresses are relative, so that the token of this page's own address goes along.

export async function control(command) {
  const answer = await fetch("control", { method: "POST", body: JSON.stringify(command) });
  if (answer.status === 400) {
    const { messages } = await answer.json();
    throw new Error(messages.map((m) => `${m.path ? `${m.path}: ` : ""}${m.message}`).join("; "));
  }
  if (!answer.ok && answer.status !== 204) throw new Error(await answer.text());
}

export async function getState() {
  const answer = await fetch("state");
  if (!answer.ok) throw new Error(await answer.text());
  return answer.json();
}

export function queryOf(values) {
  const query = new URLSearchParams();
  for (const [name, value] of Object.entries(values))
    if (value !== undefined && value !== null && value !== "") query.set(name, value);
  return query.toString();
}

function headersOf(answer) {
  const [width, height] = (answer.headers.get("X-Fovea-Size") ?? "0x0").split("x").map(Number);
  return {
    number: Number(answer.headers.get("X-Fovea-Number")),
    frame: Number(answer.headers.get("X-Fovea-Frame")),
    width,
    height,
    channels: Number(answer.headers.get("X-Fovea-Channels")),
    type: answer.headers.get("X-Fovea-Type"),
    encoded: answer.headers.get("X-Fovea-Encoded") === "1",
  };
}

// A picture as a Blob with what is known of it; null if there is none yet. Throws an Error for a source that there is
// not.
export async function getPicture(values, signal) {
  const answer = await fetch(`picture?${queryOf(values)}`, { signal });
  if (answer.status === 204 || answer.status === 503) return null;
  if (!answer.ok) throw new Error((await answer.text()).trim());
  return { ...headersOf(answer), blob: await answer.blob() };
}

// The words of a region as a typed array, exactly as the device has them.
export async function getPixels(source, x, y, width = 1, height = 1) {
  const answer = await fetch(`pixels?${queryOf({ source, x, y, width, height })}`);
  if (!answer.ok || answer.status === 204) return null;
  const bytes = await answer.arrayBuffer();
  const info = headersOf(answer);
  const kinds = { float32: Float32Array, uint32: Uint32Array, int32: Int32Array };
  return { ...info, values: new kinds[info.type](bytes), bytes };
}

// Of a region of the picture, or of the whole of it.
export async function getStatistics(source, region) {
  const answer = await fetch(`statistics?${queryOf({ source, ...region })}`);
  return answer.ok && answer.status !== 204 ? answer.json() : null;
}

export function listen(onTick, onLost) {
  const events = new EventSource("events");
  events.onmessage = (event) => onTick(JSON.parse(event.data));
  events.onerror = () => onLost(events.readyState === EventSource.CLOSED);
  return events;
}

// Sends the newest of many values, one request at a time.
export class Newest {
  #busy = false;
  #next = null;

  send(command) {
    const set = this.#next?.set || command.set ? { set: { ...this.#next?.set, ...command.set } } : {};
    this.#next = { ...this.#next, ...command, ...set };
    if (!this.#busy) this.#run();
  }

  async #run() {
    this.#busy = true;
    while (this.#next) {
      const command = this.#next;
      this.#next = null;
      try {
        await control(command);
      } catch (error) {
        document.dispatchEvent(new CustomEvent("problem", { detail: error.message }));
      }
    }
    this.#busy = false;
  }
}

export const newest = new Newest();
