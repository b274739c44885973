"""Writes EXR files of every shape: several parts, windows, types, sampling. Uncompressed scan lines."""

import struct

CODES = {"uint": "I", "half": "e", "float": "f"}


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<I", len(value)) + value


class Part:
    """`channels`: name -> function of x and y, or (type, function) or (type, function, sampling). Windows: x, y, width,
    height."""

    def __init__(self, channels, data, display=None, name=None, deep=False):
        def full(channel):
            return (*channel, 1)[:3] if isinstance(channel, tuple) else ("float", channel, 1)
        self.channels = sorted((key, full(channel)) for key, channel in channels.items())
        self.data, self.display, self.name, self.deep = data, display or data, name, deep

    def header(self, several):
        def box(window):
            x, y, width, height = window
            return struct.pack("<4i", x, y, x + width - 1, y + height - 1)
        names = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", list(CODES).index(kind), 0, step, step)
                         for name, (kind, _, step) in self.channels) + b"\0"
        text = (attribute("channels", "chlist", names) + attribute("compression", "compression", b"\0")
                + attribute("dataWindow", "box2i", box(self.data))
                + attribute("displayWindow", "box2i", box(self.display))
                + attribute("lineOrder", "lineOrder", b"\0")
                + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
                + attribute("screenWindowCenter", "v2f", bytes(8))
                + attribute("screenWindowWidth", "float", struct.pack("<f", 1)))
        if self.name is not None:
            text += attribute("name", "string", self.name.encode())
        if several or self.deep:
            kind = b"deepscanline" if self.deep else b"scanlineimage"
            text += attribute("type", "string", kind)
            text += attribute("chunkCount", "int", struct.pack("<i", self.data[3]))
        if self.deep:
            text += attribute("version", "int", struct.pack("<i", 1))
        return text + b"\0"

    def chunks(self):
        x0, y0, width, height = self.data
        for y in range(y0, y0 + height):
            rows = []
            for _, (kind, value, sampling) in self.channels:
                if y % sampling == 0:
                    values = [value(x, y) for x in range(x0, x0 + width) if x % sampling == 0]
                    rows.append(struct.pack(f"<{len(values)}{CODES[kind]}", *values))
            if self.deep:  # one sample each
                counts, pixels = struct.pack(f"<{width}I", *range(1, width + 1)), b"".join(rows)
                yield struct.pack("<iQQQ", y, len(counts), len(pixels), len(pixels)) + counts + pixels
            else:
                yield struct.pack("<ii", y, len(b"".join(rows))) + b"".join(rows)


def write(path, *parts):
    several = len(parts) > 1
    flags = 2 | (0x1000 if several else 0) | (0x800 if any(p.deep for p in parts) else 0)
    head = struct.pack("<II", 20000630, flags) + b"".join(p.header(several) for p in parts)
    if several:
        head += b"\0"
    chunks = [[(struct.pack("<i", i) if several else b"") + c for c in p.chunks()] for i, p in enumerate(parts)]
    offset, table = len(head) + 8 * sum(len(c) for c in chunks), b""
    for part in chunks:
        for chunk in part:
            table += struct.pack("<Q", offset)
            offset += len(chunk)
    path.write_bytes(head + table + b"".join(c for part in chunks for c in part))
