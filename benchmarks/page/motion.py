"""How fast a thing that moves along keys crosses the picture, from its scene file."""
import json
import math
import pathlib

TOP = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDERS = (TOP / "samples/scenes", TOP / "scenes")  # of the sources, and of an installation


def between(keys, time, name):
    """The value of `name` at a time, linear between the keys."""
    before = [k for k in keys if k["t"] <= time] or keys[:1]
    after = [k for k in keys if k["t"] > time] or keys[-1:]
    low, high = before[-1], after[0]
    span = high["t"] - low["t"]
    share = (time - low["t"]) / span if span > 0 else 0
    return [a + share * (b - a) for a, b in zip(low[name], high[name])]


def subtract(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def projected(scene, time, width):
    """Where the scene's first mover is in a square picture, in pixels from its middle."""
    camera = scene["camera"]
    place = between(scene["movers"][0]["keys"], time, "translation")
    eye, target = (between(camera["path"], time, name) for name in ("eye", "target"))
    forward = unit(subtract(target, eye))
    right = unit(cross(forward, [0, 1, 0]))
    up = cross(right, forward)
    to = subtract(place, eye)
    scale = width / 2 / math.tan(math.radians(camera.get("fov_deg", 60)) / 2) / dot(to, forward)
    return scale * dot(to, right), scale * dot(to, up)


def pixels_per_frame(name, frame_rate, first, frames, width):
    """The mean over a sequence, or None if the scene has no file or nothing in it moves along keys."""
    file = next((f / f"{name}.json" for f in FOLDERS if (f / f"{name}.json").exists()), None)
    scene = json.loads(file.read_text()) if file else {}
    if not scene.get("movers") or "path" not in scene.get("camera", {}) or frames < 2:
        return None
    if any("translation" not in key for key in scene["movers"][0]["keys"]):
        return None
    places = [projected(scene, (first + i) / frame_rate, width) for i in range(frames)]
    return sum(math.dist(a, b) for a, b in zip(places, places[1:])) / (frames - 1)
