"""Figure 10 of the paper, and what it says in prose of times and movement."""
import pathlib

from .motion import pixels_per_frame
from .plots import stacked
from .reasons import of_generation
from .steps import SCENE, STEPS, mean_steps, steps_of
from .sweeps import SPEED, TIMES
from .text import short, spread, table
from .verdict import Entry, claim, is_at_least, is_less

PAPER_WIDTH, PAPER_RATE, PAPER_SPEED, PAPER_LIMIT = 1024, 42, (100, 150), 0.06e-3
PAPER_SAVING, PAPER_SLOWER = 0.8, (2, 3)


def seeds_of(results, scene, graph, amount):
    """seed -> a number made of the steps of a frame."""
    return {r["job"]["seed"]: amount(steps_of(r)) for r in results.select(TIMES, scene, graph)}


def figure10(results, folder):
    entry = Entry("Figure 10: the time of every step")
    bars, rows = {}, []
    for scene in results.scenes(TIMES):
        for graph in ("ir_1000", "ours", "ours_all_maps"):
            mean = mean_steps(results, TIMES, scene, graph)
            if mean:
                bars[f"{pathlib.Path(scene).stem} {graph}"] = mean
                rows.append([f"`{scene}`", f"`{graph}`", *map(short, [*mean.values(), sum(mean.values())])])
    if bars:
        file = folder / "figure10.png"
        stacked(file, bars, [*STEPS, SCENE], "milliseconds a frame, by step")
        entry.add(f"![Milliseconds of the steps of a frame]({file.name})")
        entry.add("Times are in milliseconds: medians over frames and means over seeds. `ours_all_maps` draws every "
                  "map in every frame.")
        entry.add(table(["scene", "graph", *STEPS, SCENE, "sum"], rows))
    else:
        entry.missing("Times of steps")
    entry.claims += [generation(results), saving(results)]
    return entry


def generation(results):
    make = lambda steps: sum(ms for step, ms in steps.items() if step in list(STEPS)[:3])
    known, detail = {}, []
    for scene in results.scenes(TIMES):
        mine, other = (seeds_of(results, scene, g, make) for g in ("ours", "ir_1000"))
        slower = {s: mine[s] / other[s] for s in mine if other.get(s)}
        if slower:
            at_most, at_least = (is_less(slower, {s: limit for s in slower}) for limit in (3.5, 1.5))
            known[scene] = None if None in (at_most, at_least) else at_most and not at_least
            detail.append(f"`{scene}` {spread(slower)}")
    return claim("Generating VPLs, with voxels and management, takes 2 to 3 times as long as for IR_1000", known,
                 ", ".join(detail), lambda s: of_generation(results, s))


def saving(results):
    maps = lambda steps: steps["shadow maps of VPLs"]
    known, detail = {}, []
    for scene in results.scenes(TIMES):
        mine, whole = (seeds_of(results, scene, g, maps) for g in ("ours", "ours_all_maps"))
        saved = saved_part(mine, whole)
        if not saved:
            continue
        known[scene] = is_at_least(saved, PAPER_SAVING - 0.005)
        drawn = saved_part(*(results.seeds(TIMES, scene, g, "counter.shadow-atlas.texels")
                             for g in ("ours", "ours_all_maps")))
        detail.append(f"`{scene}` {spread(saved, 100)}%" + (f", {spread(drawn, 100)}% of the texels" if drawn else ""))
    return claim("Keeping maps from frame to frame saves 80% of the time for shadow maps", known, "; ".join(detail))


def saved_part(mine, whole):
    """seed -> the part of `whole` that `mine` does not need."""
    return {s: 1 - mine[s] / whole[s] for s in mine if whole.get(s)}


# ---- The plane in Sponza


def speed_of(result):
    """Pixels a second at the paper's 42 frames a second and 1024 pixels, or None.

    At half the frame rate, everything moves twice as far from frame to frame, as if it were twice as fast at 42.
    """
    job = result["job"]
    distance = pixels_per_frame(pathlib.Path(job["scene"]).stem, job["frame_rate"], job["first"], job["frames"],
                                PAPER_WIDTH)
    return None if distance is None else distance * PAPER_RATE


def moving_plane(results):
    entry = Entry("Prose: a moving plane in Sponza")
    rows, known, inside = [], {}, []
    for scene in results.scenes(SPEED):
        for rate in reversed(results.values(SPEED, "frame_rate")):
            numbers = lambda graph, name: results.seeds(SPEED, scene, graph, f"temporal.fovea.{name}", frame_rate=rate)
            found = results.select(SPEED, scene, "ours", frame_rate=rate)
            if not found:
                continue
            speed = speed_of(found[0])
            mine = numbers("ours", "mse_prime")
            rows.append([f"`{scene}`", rate, short(speed), spread(mine, 1e3),
                         spread(numbers("ir_1000", "mse_prime"), 1e3),
                         spread(numbers("ours", "reference_mse_prime"), 1e3),
                         spread(numbers("ours", "excess"), 1e3), spread(numbers("ir_1000", "excess"), 1e3)])
            if speed and PAPER_SPEED[0] <= speed <= PAPER_SPEED[1] and mine:
                below = is_less(mine, {s: PAPER_LIMIT for s in mine})
                known[scene] = below if known.get(scene, True) is True else known[scene]
                floor = results.mean(SPEED, scene, "ours", "temporal.fovea.reference_mse_prime", frame_rate=rate)
                inside.append(f"at {short(speed)} pixels a second MSE' is {spread(mine, 1e3)}, times 1000"
                              + (f", and that of the reference {short(1e3 * floor)}" if floor is not None else ""))
    if rows:
        entry.add("Changes in the fovea from frame to frame, times 1000, over the speed of the plane on the screen. "
                  "The sequence is rendered with several frame rates: the lower the rate, the further everything moves "
                  "from one frame to the next. The speed is that at the paper's 42 frames a second and 1024 pixels; "
                  "- where no scene file tells it.")
        entry.add(table(["scene", "frames a second", "speed", "MSE' of `ours`", "of `ir_1000`", "of the reference",
                         "excess of `ours`", "of `ir_1000`"], rows))
    else:
        entry.missing("Sequences over speed")
    entry.claims.append(claim("In the fovea, MSE' stays below 0.06 / 1000 for a plane that crosses Sponza at 100 to "
                              "150 pixels a second", known, "; ".join(inside), lambda s: of_reference(results, s)))
    return entry


def of_reference(results, scene):
    """Why MSE' cannot be as low: the reference itself changes more."""
    like_the_paper = [r for r in results.select(SPEED, scene, "ours")
                      if PAPER_SPEED[0] <= (speed_of(r) or 0) <= PAPER_SPEED[1]]
    floors = [r["temporal"]["fovea"].get("reference_mse_prime") for r in like_the_paper]
    if floors and all(f is not None and f > PAPER_LIMIT for f in floors):
        return f"In `{scene}` the reference itself changes more than that, so no method can hold it."
    return ""
