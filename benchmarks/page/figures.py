"""Figures 1 and 3 to 9 of the paper: pictures, and errors over parameters."""
import pathlib

from . import reasons
from .panels import first_seed, grid, read, with_reference
from .plots import curves
from .sweeps import (COSINE_SEQUENCES, COSINE_STILLS, COUNTS, MAPS, PARAMETERS, RADII, SEQUENCES, STILLS,
                     UNCLAMPED)
from .table_entries import METHODS, outcomes
from .text import short, spread, table
from .verdict import MISSING, Entry, all_of, claim, is_less

AXES = ((MAPS, "map_size", "texels of a map's side"), (COUNTS, "vpl_count", "VPLs"),
        (RADII, "view.fovea_radius", "radius of the fovea, image widths"))
MSE, FLIP, EXCESS = "error.fovea.mse", "error.fovea.flip", "temporal.fovea.excess"
TEASER = ("sponza_plane", "atrium")  # the paper's first figure shows Sponza


def stem(scene):
    return pathlib.Path(scene).stem


def show(entry, file, caption):
    entry.add(f"![{caption}]({file.name})")
    entry.add(f"*{caption}*")


def stills(results, entry, folder, name, scenes, found_of, errors=True):
    """A grid of pictures a scene: the reference and the results of found_of(scene), label -> result."""
    shown = False
    for scene in scenes:
        panels = with_reference(results, found_of(scene), errors)
        if panels is None:
            continue
        file = folder / f"{name}-{stem(scene)}.png"
        grid(file, *panels)
        last = "; last: error, with the noise of the reference" if errors else ""
        show(entry, file, f"{scene}; circle: the fovea; below: the square, enlarged{last}")
        shown = True
    if not shown:
        entry.missing("Pictures")


# ---- Pictures


def figure1(results, folder):
    entry = Entry("Figure 1: the fovea of Sponza")
    there = results.scenes(STILLS)
    scene = next((s for t in TEASER for s in there if stem(s) == t), there[0] if there else None)
    found = lambda s: {g: first_seed(results, STILLS, s, g) for g in ("ir_1000", "ours")}
    stills(results, entry, folder, "figure1", [scene] if scene else [], found, errors=False)
    mine, other = (results.seeds(STILLS, scene, g, MSE) for g in ("ours", "ir_1000"))
    known = {scene: is_less(mine, other)} if set(mine) & set(other) else {}
    detail = f"MSE {spread(mine, 1e3)} and {spread(other, 1e3)}, times 1000" if known else ""
    entry.claims.append(claim("In the fovea of this picture, Ours is nearer to the reference than IR_1000", known,
                              detail, reasons.of_error(results)))
    return entry


def figure3(results, folder):
    entry = Entry("Figure 3: pictures of all methods")
    found = lambda s: {g: first_seed(results, STILLS, s, g) for g in METHODS}
    stills(results, entry, folder, "figure3", results.scenes(STILLS), found)
    entry.add(methods_of(results, FLIP, "FLIP, the visible difference from the reference in the fovea (0 to 1)"))
    entry.claims.append(claim("In the fovea, Ours differs visibly less (FLIP) from the reference than IR_1000 and IR_v",
                              outcomes(results, STILLS, FLIP, ("ir_1000", "ir_v"))))
    return entry


def methods_of(results, measure, heading):
    rows = [[f"`{s}`", *(spread(results.seeds(STILLS, s, g, measure)) for g in METHODS)]
            for s in results.scenes(STILLS)]
    return f"{heading}\n\n" + table(["scene", *(f"`{g}`" for g in METHODS)], rows) if rows else ""


def figure4(results, folder):
    entry = Entry("Figure 4: where pictures change otherwise than the reference")
    scenes = results.scenes(SEQUENCES)
    rows = []
    for scene in scenes:
        found = [first_seed(results, SEQUENCES, scene, g) for g in METHODS]
        pictures = [read(results, r, "-temporal") if r else None for r in found]
        if any(p is not None for p in pictures):
            rows.append((stem(scene), [(p,) for p in pictures]))
    if rows:
        file = folder / "figure4.png"
        grid(file, METHODS, rows)
        show(entry, file, "Change between the last two frames that is not that of the reference, its noise included; "
                          "circle: the fovea")
    else:
        entry.missing("Pictures")
    entry.claims.append(claim(
        "In the fovea, Ours flickers less (excess) than IR_1000 and IR_v",
        outcomes(results, SEQUENCES, EXCESS, ("ir_1000", "ir_v")), reason=lambda s: reasons.of_flicker(results, s)))
    return entry


def figure6(results, folder):
    entry = Entry("Figure 6: pictures over the number of VPLs and the size of the fovea")
    sweep = PARAMETERS
    counts, radii = (results.values(sweep, axis) for axis in ("vpl_count", "view.fovea_radius"))
    known = {}
    for scene in results.scenes(sweep):
        found = lambda c, r: first_seed(results, sweep, scene, "ours", **{"vpl_count": c, "view.fovea_radius": r})
        cells = {(c, r): found(c, r) for c in counts for r in radii}
        if not any(x and read(results, x) is not None for x in cells.values()):
            continue
        pictures = [(f"radius {r}", [panel_of(results, cells[c, r], kind) for c in counts for kind in ("", "-error")])
                    for r in radii]
        file = folder / f"figure6-{stem(scene)}.png"
        grid(file, [h for c in counts for h in (f"{c} VPLs", "error")], pictures)
        show(entry, file, f"{scene}; circle: the fovea; errors include the noise of the reference")
        mean = lambda c, r: results.mean(sweep, scene, "ours", MSE, **{"vpl_count": c, "view.fovea_radius": r})
        rows = [[r, *(short(1e3 * mean(c, r)) if mean(c, r) is not None else "-" for c in counts)] for r in radii]
        entry.add(f"MSE in the fovea of `{scene}`, times 1000\n\n" +
                  table(["radius", *(f"{c} VPLs" for c in counts)], rows))
        ends = [(mean(counts[-1], r), mean(counts[0], r)) for r in radii]
        if len(counts) > 1 and all(a is not None and b is not None for a, b in ends):
            known[scene] = all(a < b for a, b in ends)
    if not entry.blocks:
        entry.missing("Pictures")
    entry.claims.append(claim("With more VPLs, the error in the fovea is less, whatever its radius", known))
    return entry


def panel_of(results, result, kind):
    pixels = read(results, result, kind) if result else None
    return (pixels,) if pixels is None or kind else (pixels, result["error"]["disc"])


def figure7(results, folder):
    entry = Entry("Figure 7: the linear and the cosine rule of reuse")
    pairs = (("error.fovea.mse", STILLS, COSINE_STILLS), (EXCESS, SEQUENCES, COSINE_SEQUENCES))
    found = lambda s: {"ours (linear)": first_seed(results, STILLS, s, "ours"),
                       "ours_cosine": first_seed(results, COSINE_STILLS, s, "ours_cosine")}
    stills(results, entry, folder, "figure7", results.scenes(COSINE_STILLS), found)
    rows = [[f"`{s}`", *(spread(results.seeds(sweep, s, g, m), 1e3) for m, linear, cosine in pairs
                         for sweep, g in ((linear, "ours"), (cosine, "ours_cosine")))]
            for s in results.scenes(COSINE_STILLS, COSINE_SEQUENCES)]
    entry.add(table(["scene", "MSE in the fovea, linear", "cosine", "excess in the fovea, linear", "cosine"], rows))
    for (measure, linear, cosine), what in zip(pairs, ("has less error", "flickers less (excess)")):
        known = compared(results, measure, (linear, "ours"), (cosine, "ours_cosine"))
        entry.claims.append(claim(f"In the fovea, the linear rule {what} than the cosine rule", known))
    return entry


def compared(results, measure, mine, other):
    """scene -> whether (sweep, graph) has less than another one."""
    found = {}
    for scene in results.scenes(other[0]):
        a, b = (results.seeds(sweep, scene, graph, measure) for sweep, graph in (mine, other))
        if set(a) & set(b):
            found[scene] = is_less(a, b)
    return found


def figure8(results, folder):
    entry = Entry("Figure 8: with and without the clamp of short distances")
    sweep = UNCLAMPED
    graphs = (("ours", STILLS), ("ours_unclamped", sweep), ("ir_1000", STILLS), ("ir_1000_unclamped", sweep))
    found = lambda s: {g: first_seed(results, where, s, g) for g, where in graphs}
    stills(results, entry, folder, "figure8", results.scenes(sweep), found)
    rows = [[f"`{s}`", *(spread(results.seeds(where, s, g, MSE), 1e3) for g, where in graphs)]
            for s in results.scenes(sweep)]
    entry.add("MSE in the fovea, times 1000. Without the clamp, VPLs light near surfaces as discs and not as points.")
    entry.add(table(["scene", *(f"`{g}`" for g, _ in graphs)], rows))
    for graph, name in (("ours", "Ours"), ("ir_1000", "IR_1000")):
        known = compared(results, MSE, (STILLS, graph), (sweep, f"{graph}_unclamped"))
        entry.claims.append(claim(f"In the fovea, the clamp makes the error of {name} less", known))
    return entry


# ---- Errors over parameters


def trend(results, sweep, axis, measure, falls=True, graph="ours"):
    """scene -> whether a measure is less at the last value of a parameter than at the first (or the reverse)."""
    values, found = results.values(sweep, axis), {}
    for scene in results.scenes(sweep) if len(values) > 1 else []:
        first, last = (results.seeds(sweep, scene, graph, measure, **{axis: v}) for v in (values[0], values[-1]))
        if set(first) & set(last):
            found[scene] = is_less(last, first) if falls else is_less(first, last)
    return found


def below_at_each(results, sweep, axis, measure):
    """scene -> whether `ours` has less than `ir_1000` at every value."""
    found = {}
    for scene in results.scenes(sweep):
        pairs = [[results.seeds(sweep, scene, g, measure, **{axis: v}) for g in ("ours", "ir_1000")]
                 for v in results.values(sweep, axis)]
        pairs = [(a, b) for a, b in pairs if set(a) & set(b)]
        if pairs:
            found[scene] = all_of(is_less(a, b) for a, b in pairs)
    return found


def above_at(results, scene, measure):
    """The numbers of VPLs with which `ours` does not have less than `ir_1000`."""
    mean = lambda graph, count: results.mean(COUNTS, scene, graph, measure, vpl_count=count)
    known = [(c, mean("ours", c), mean("ir_1000", c)) for c in results.values(COUNTS, "vpl_count")]
    parts = [f"with {c} VPLs {short(1e3 * a)} and {short(1e3 * b)}" for c, a, b in known
             if a is not None and b is not None and a >= b]
    return f"In `{scene}`, Ours and instant radiosity have, times 1000, {', '.join(parts)}." if parts else ""


def over_parameters(results, folder, name, entry, measures):
    scenes = results.scenes(MAPS, COUNTS, RADII)
    file = folder / f"{name}.png"
    if curves(results, file, AXES, measures, scenes):
        show(entry, file, "Each size of the fovea is measured in its own fovea; bars: 95% intervals over seeds")
    else:
        entry.missing("Curves")


def figure5(results, folder):
    entry = Entry(reasons.FIT_TITLE)
    over_parameters(results, folder, "figure5", entry, [(MSE, "MSE in the fovea × 1000", 1e3),
                                                        ("time.wall_ms", "milliseconds a frame", 1)])
    entry.add(fits(results))
    why = reasons.of_error(results)
    entry.claims += [
        claim("Larger maps lower the error of Ours in the fovea", trend(results, MAPS, "map_size", MSE)),
        claim("More VPLs lower the error of Ours in the fovea", trend(results, COUNTS, "vpl_count", MSE), reason=why),
        claim("A smaller fovea has less error", trend(results, RADII, "view.fovea_radius", MSE, falls=False)),
        claim("With as many VPLs, from the fewest to the most, Ours has less error in the fovea than instant radiosity",
              below_at_each(results, COUNTS, "vpl_count", MSE), reason=lambda s: above_at(results, s, MSE)),
    ]
    return entry


def fits(results):
    """How much of the error with 1000 VPLs is bias."""
    rows = []
    for scene in results.scenes(COUNTS):
        for graph in ("ir_1000", "ours"):
            cells = []
            for measure in (MSE, "error.fovea.indirect_mse"):
                fit = reasons.fit_of(results, scene, graph, measure)
                cells += [short(1e3 * fit.bias), short(fit.variance), f"{fit.share(1000):.0%}"] if fit else ["-"] * 3
            rows.append([f"`{scene}`", f"`{graph}`", *cells])
    if not rows:
        return f"**Fit of the bias: {MISSING}.**"
    return ("E(N) = b + v / N, fitted to the errors in the fovea with every number N of VPLs by least squares of "
            "relative deviations. The bias b is what more VPLs do not reduce; b is given times 1000.\n\n" +
            table(["scene", "graph", "b", "v", "bias of E(1000)", "b, indirect light", "v", "bias of E(1000)"], rows))


def figure9(results, folder):
    entry = Entry("Figure 9: flicker over the size of maps, the number of VPLs and the size of the fovea")
    over_parameters(results, folder, "figure9", entry, [
        ("temporal.fovea.mse_prime", "MSE' in the fovea × 1000", 1e3), (EXCESS, "excess in the fovea × 1000", 1e3)])
    rows = [[f"`{s}`", *(spread(results.seeds(COUNTS, s, "ours", EXCESS, vpl_count=c), 1e3)
                         for c in results.values(COUNTS, "vpl_count"))] for s in results.scenes(COUNTS)]
    if rows:
        entry.add("Excess of `ours` in the fovea over the number of VPLs, times 1000\n\n" +
                  table(["scene", *results.values(COUNTS, "vpl_count")], rows))
    entry.claims += [
        claim("More VPLs lower the flicker (excess) of Ours in the fovea", trend(results, COUNTS, "vpl_count", EXCESS)),
        claim("With as many VPLs, from the fewest to the most, Ours flickers less (excess) in the fovea than instant "
              "radiosity", below_at_each(results, COUNTS, "vpl_count", EXCESS),
              reason=lambda s: above_at(results, s, EXCESS)),
    ]
    return entry
