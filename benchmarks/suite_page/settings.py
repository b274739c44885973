"""How a sweep was measured: from all of its jobs, with what differs among graphs said of each."""


def by_label(jobs, value):
    """Of each value that jobs have, the graphs that have it, in their order: {value: [label]}."""
    found = {}
    for job in jobs:
        labels = found.setdefault(value(job), [])
        if job["label"] not in labels:
            labels.append(job["label"])
    return found


def told(jobs, value, words):
    """"16 frames to warm up", or "4 frames to warm up (ours) and 16 (ir_1000, foveal)"; "" if there is nothing to say."""
    found = {v: labels for v, labels in by_label(jobs, value).items() if v is not None}
    if not found:
        return ""
    if len(found) == 1 and len(next(iter(found.values()))) == len({job["label"] for job in jobs}):
        return words(next(iter(found)))
    return " and ".join(f"{words(v)} ({', '.join(labels)})" for v, labels in found.items())


def frames(job):
    last = job["first"] + job["frames"] - 1
    span = f"frames {job['first']} to {last}" if job["frames"] > 1 else f"frame {last}"
    return f"{span} of the scene's animation at {job['frame_rate']:g} frames per second"


def reference(job):
    made = job.get("reference")
    return made and f"reference: {made['spp']} samples per pixel, depth {made['depth']}"


def settings(jobs):
    """In a sentence or two. Whatever is not said to be of one graph holds for all."""
    parts = [told(jobs, lambda j: f"{j['size'][0]}×{j['size'][1]}", lambda v: f"{v} pixels")
             if not any("size" in j["varied"] for j in jobs) else "pictures of several sizes",
             told(jobs, frames, str),
             told(jobs, lambda j: j["warmup"], lambda n: f"{n} frame{'s' if n != 1 else ''} to warm up"),
             told(jobs, lambda j: len({k["seed"] for k in jobs if k["label"] == j["label"]}),
                  lambda n: f"{n} seed{'s' if n != 1 else ''}"),
             told(jobs, reference, str)]
    names = dict.fromkeys(k for j in jobs for k in j["set"] if not any(k in other["varied"] for other in jobs))
    parts += [told(jobs, lambda j, name=name: j["set"].get(name), lambda v, name=name: f"{name} = {v}") for name in names]
    text = "; ".join(part for part in parts if part)
    several = any("error" in j["measures"] and j["frames"] > 1 for j in jobs)
    return ("Errors are those of the last frame. " if several else "") + text[:1].upper() + text[1:] + "."
