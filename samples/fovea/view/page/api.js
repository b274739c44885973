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

function sizeOf(answer, header) {
  return (answer.headers.get(header) ?? "0x0").split("x").map(Number);
}

function headersOf(answer) {
  const [width, height] = sizeOf(answer, "X-Fovea-Size");
  return {
    number: Number(answer.headers.get("X-Fovea-Number")),
    frame: Number(answer.headers.get("X-Fovea-Frame")),
    width,
    height,
    channels: Number(answer.headers.get("X-Fovea-Channels")),
    type: answer.headers.get("X-Fovea-Type"),
    map: answer.headers.get("X-Fovea-Map"),
    range: (answer.headers.get("X-Fovea-Range") ?? "0 1").split(" ").map(Number),
    encoded: answer.headers.get("X-Fovea-Encoded") === "1",
  };
}

// The bytes of RGB as the pixels of a canvas.
function imageData(bytes, width, height) {
  const data = new ImageData(width, height);
  const words = new Uint32Array(data.data.buffer);
  for (let i = 0, at = 0; i < words.length; ++i, at += 3)
    words[i] = bytes[at] | (bytes[at + 1] << 8) | (bytes[at + 2] << 16) | 0xff000000;
  return data;
}

// A picture as a Blob, or as `pixels` if values.exact is 1, with what is known of it; null if there is none yet. Throws
// an Error for a source that there is not.
export async function getPicture(values, signal) {
  const answer = await fetch(`picture?${queryOf(values)}`, { signal });
  if (answer.status === 204 || answer.status === 503) return null;
  if (!answer.ok) throw new Error((await answer.text()).trim());
  const info = headersOf(answer);
  const blob = await answer.blob();
  if (!values.exact || blob.size === 0) return { ...info, blob, exact: false };
  const pixels = imageData(new Uint8Array(await blob.arrayBuffer()), ...sizeOf(answer, "X-Fovea-Drawn"));
  return { ...info, blob, pixels, exact: true };
}

// Draws a picture into a canvas, whose size becomes that of the picture.
export async function paint(context, picture) {
  const { canvas } = context;
  const bitmap = picture.pixels ?? await createImageBitmap(picture.blob);
  if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
    canvas.width = bitmap.width;
    canvas.height = bitmap.height;
  }
  if (picture.pixels) {
    context.putImageData(bitmap, 0, 0);
  } else {
    context.drawImage(bitmap, 0, 0);
    bitmap.close();
  }
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
