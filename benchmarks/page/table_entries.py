"""Tables 1 and 2 of the paper."""
from . import reasons
from .results import match_bound, mean_of
from .sweeps import COUNTS, SECOND_EYE, SEQUENCES, STILLS, TIMES
from .text import anchor, beside, short, spread, table
from .verdict import Entry, all_of, claim, is_at_least, is_less

METHODS = ("ir_1000", "ir_v", "ours_r", "ours")
ROUNDING = 0.5  # the paper gives speed-ups as whole numbers


def outcomes(results, sweep, measure, others, rows=None, graph="ours"):
    """scene -> whether `graph` has less of a measure than each of `others`.

    Only scenes for which the paper itself says so, where it has the numbers; rows: its name of the measure.
    """
    found = {}
    for scene in results.scenes(sweep):
        mine = results.seeds(sweep, scene, graph, measure)
        theirs = [results.seeds(sweep, scene, other, measure) for other in others]
        published = results.paper("table1", scene, graph, rows or measure)
        said = [results.paper("table1", scene, other, rows or measure) for other in others]
        claimed = published is None or all(s is None or published < s for s in said)
        if mine and all(set(t) & set(mine) for t in theirs) and claimed:
            found[scene] = all_of(is_less(mine, t) for t in theirs)
    return found


def ratios(results, sweep, measure, over="ir_1000", graph="ours"):
    """scene -> mean ratio of a measure to that of another graph, and of the paper's numbers."""
    found = {}
    for scene in results.scenes(sweep):
        mine, other = (results.mean(sweep, scene, g, measure) for g in (graph, over))
        if mine is not None and other:
            found[scene] = mine / other
    return found


def methods_table(results, sweep, measure, published=True, extra=None):
    """A row a scene, a column a method: times 1000, with the paper's numbers in brackets."""
    rows = []
    for scene in results.scenes(sweep):
        cells = [beside(spread(results.seeds(sweep, scene, g, measure), 1e3),
                        scaled(results.paper("table1", scene, g, measure)) if published else None) for g in METHODS]
        last = [spread(results.seeds(sweep, scene, "ours", extra[1]), extra[2])] if extra else []
        rows.append([f"`{scene}`", results.paper_scene(scene) if published else "", *cells, *last])
    head = ["scene", "paper's scene", *(f"`{g}`" for g in METHODS), *([extra[0]] if extra else [])]
    if not published:
        rows, head = [[r[0], *r[2:]] for r in rows], [head[0], *head[2:]]
    return table(head, rows)


def scaled(value, factor=1e3):
    return None if value is None else factor * value


def ratio_text(results, sweep, measure, name):
    low, high = published_ratios(results, name or measure)
    return ", ".join(f"`{s}` {short(r)}" for s, r in ratios(results, sweep, measure).items()) + \
        f"; the paper has {short(low)} to {short(high)}"


def published_ratios(results, measure):
    """Of Ours to IR_1000, least and largest over the paper's scenes."""
    scenes = results.published["tables"]["table1"].values()
    found = [s["ours"][measure] / s["ir_1000"][measure] for s in scenes]
    return min(found), max(found)


def table1(results):
    entry = Entry("Table 1: errors in the fovea and outside it, and their changes from frame to frame")
    add_stills(results, entry)
    add_sequences(results, entry)
    return entry


def add_stills(results, entry):
    if not results.select(STILLS):
        entry.missing("Errors of stills")
    else:
        for region, name in (("fovea", "in the fovea"), ("periphery", "outside it")):
            entry.add(f"MSE of whole pictures {name}, times 1000; in brackets the paper's number")
            measure = f"error.{region}.mse"
            floor = ("direct light alone", f"error.{region}.direct_floor", 1e3)
            entry.add(methods_table(results, STILLS, measure, extra=floor))
        entry.add("Whole pictures contain the direct light, which all methods share and no VPL can improve: the last "
                  "column is the error that `ours` would have with perfect indirect light. MSE of the indirect light "
                  "alone, in the fovea, times 1000; the paper has no such numbers")
        entry.add(methods_table(results, STILLS, "error.fovea.indirect_mse", published=False,
                                extra=("indirect light of `ours` / of the reference", "error.indirect_light", 1)))
    why = reasons.of_error(results)
    mse, indirect = "error.fovea.mse", "error.fovea.indirect_mse"
    instant = ("ir_1000", "ir_v")
    low, high = published_ratios(results, mse)
    entry.claims += [
        claim("In the fovea, Ours has less error than instant radiosity with as many VPLs, IR_1000 and IR_v",
              outcomes(results, STILLS, mse, instant), reason=why),
        claim("In the fovea, Ours has less error of the indirect light alone than IR_1000 and IR_v",
              outcomes(results, STILLS, indirect, instant, rows=mse), reason=why),
        claim(f"In the fovea, the error of Ours is at most {short(high)} of that of IR_1000",
              {s: is_less(results.seeds(STILLS, s, "ours", mse), results.seeds(STILLS, s, "ir_1000", mse), high)
               for s in ratios(results, STILLS, mse)}, ratio_text(results, STILLS, mse, mse), why),
        claim("In the fovea, reuse in proportion to importance has less error than at random (Ours_r)",
              outcomes(results, STILLS, mse, ["ours_r"])),
        claim("Outside the fovea, too, Ours has less error than IR_1000 (except in Yard)",
              outcomes(results, STILLS, "error.periphery.mse", ["ir_1000"]),
              ratio_text(results, STILLS, "error.periphery.mse", None)),
    ]


def add_sequences(results, entry):
    change = "temporal.fovea.mse_prime"
    if not results.select(SEQUENCES):
        entry.missing("Sequences")
    else:
        entry.add("MSE' in the fovea, the mean squared change from frame to frame, times 1000; in brackets the paper's "
                  "number. It contains the motion of the scene, which the last column has")
        entry.add(methods_table(results, SEQUENCES, change,
                                extra=("reference", "temporal.fovea.reference_mse_prime", 1e3)))
        entry.add("MSE' outside the fovea, times 1000")
        entry.add(methods_table(results, SEQUENCES, "temporal.periphery.mse_prime",
                                extra=("reference", "temporal.periphery.reference_mse_prime", 1e3)))
        entry.add("Excess in the fovea: mean squared difference between the change of the picture and that of the "
                  "reference, times 1000, of whole pictures and of the indirect light alone")
        for measure in ("temporal.fovea.excess", "temporal.fovea.indirect_excess"):
            entry.add(methods_table(results, SEQUENCES, measure, published=False))
    entry.claims += [
        claim("In the fovea, Ours changes less from frame to frame (MSE') than IR_1000, IR_v and Ours_r",
              outcomes(results, SEQUENCES, change, METHODS[:3]), reason=lambda s: reasons.of_change(results, s)),
        claim("In the fovea, reuse in proportion to importance flickers less (excess) than at random (Ours_r)",
              outcomes(results, SEQUENCES, "temporal.fovea.excess", ["ours_r"], rows=change),
              reason=lambda s: reasons.of_flicker(results, s)),
    ]


# ---- Table 2


def speed_ups(results, scene, over):
    """seed -> frame time of another graph over that of Ours."""
    mine, other = (results.seeds(TIMES, scene, g, "time.wall_ms") for g in ("ours", over))
    return {s: other[s] / mine[s] for s in sorted(set(mine) & set(other))}


def bound_of(results, scene):
    """`>` or `<` if seeds agree that N of IR_eq lies beyond the range of the search, `~` if they do not."""
    bounds = {match_bound(r) for r in results.select(TIMES, scene, "ir_eq")}
    return bounds.pop() if len(bounds) == 1 else "~" if bounds else ""


def solved_count(results, scene):
    """N of IR_eq by the fit of the error of instant radiosity."""
    fit = reasons.fit_of(results, scene, "ir_1000", "error.fovea.mse")
    target = results.mean(COUNTS, scene, "ours", "error.fovea.mse", vpl_count=1000)
    if not fit or target is None:
        return "not measured yet"
    count = fit.count_for(target)
    return short(count) if count else "undefined, as the bias alone exceeds the error of `ours`"


def time_row(results, scene):
    paper = lambda graph, measure: results.paper("table2", scene, graph, measure)
    bound = bound_of(results, scene)
    prefix = f"{bound} ".replace("<", "&lt;").replace(">", "&gt;") if bound else ""
    of_eye = {m: results.seeds(SECOND_EYE, scene, "stereo", f"second_eye.{m}") for m in ("of_first", "new_pixels")}
    eye = lambda m: beside(spread(of_eye[m]), paper("stereo", f"second_eye.{m}"))
    return [f"`{scene}`", results.paper_scene(scene),
            beside(spread(results.seeds(TIMES, scene, "ours", "time.wall_ms")), paper("ours", "time.wall_ms")),
            beside(spread(speed_ups(results, scene, "ir_1000")), paper("ours", "speed_up.ir_1000")),
            beside(prefix + spread(results.seeds(TIMES, scene, "ir_eq", "match.value")), paper("ir_eq", "match.value")),
            solved_count(results, scene),
            beside(prefix + spread(speed_ups(results, scene, "ir_eq")), paper("ours", "speed_up.ir_eq")),
            eye("of_first"), eye("new_pixels")]


def table2(results):
    entry = Entry("Table 2: frame times, speed-ups and the second eye")
    scenes = list(dict.fromkeys([*results.scenes(TIMES), *results.scenes(SECOND_EYE)]))
    if not scenes:
        entry.missing("Times")
    else:
        where = "Vulkan in software on a processor; only ratios say something, and they are not those of a graphics " \
                "card" if results.on_processor() else ", ".join(results.devices())
        entry.add(f"In brackets the paper's numbers, on an RTX 2080 Ti. Here: {where}. IR_eq is instant radiosity with "
                  "as many VPLs (N) as make its foveal error that of `ours`, by bisection from 250 to 8000; beside it "
                  f"N by the [fit]({anchor(reasons.FIT_TITLE)}) to the errors of Figure 5")
        entry.add(table(["scene", "paper's scene", "`ours`, ms", "over IR_1000", "N of IR_eq", "N by the fit",
                         "over IR_eq", "second eye / first", "new pixels"], [time_row(results, s) for s in scenes]))
    instant = {s: speed_ups(results, s, "ir_1000") for s in results.scenes(TIMES)}
    equal = {s: speed_ups(results, s, "ir_eq") for s in results.scenes(TIMES)}
    least = lambda graph, measure: results.published_range("table2", graph, measure)[0]
    most = lambda graph, measure: results.published_range("table2", graph, measure)[1]
    entry.claims += [
        claim("Ours is at least 3 times as fast as IR_1000",
              {s: is_at_least(v, least("ours", "speed_up.ir_1000") - ROUNDING) for s, v in instant.items() if v},
              means(instant), lambda s: reasons.of_time(results, s)),
        claim("Ours is at least 10 times as fast as instant radiosity of the same foveal error",
              {s: speed_over_equal(results, s, v, least("ours", "speed_up.ir_eq") - ROUNDING)
               for s, v in equal.items() if v}, means(equal)),
        claim("Instant radiosity needs at least 2400 VPLs for the foveal error of Ours with 1000",
              {s: counts_outcome(results, s, least("ir_eq", "match.value")) for s in results.scenes(TIMES)
               if results.seeds(TIMES, s, "ir_eq", "match.value")}),
        claim("At most 9% of the second eye's pixels are new", second_eye(results, "new_pixels", most, 0.005)),
        claim("The second eye takes at most 0.62 of the first one's time",
              second_eye(results, "of_first", most, 0.005)),
    ]
    return entry


def means(found):
    return ", ".join(f"`{s}` {short(mean_of(v.values())[0])}" for s, v in found.items() if v)


def speed_over_equal(results, scene, values, limit):
    """A search that ended at its least number of VPLs says nothing of more; at its most, it says `at least`."""
    outcome = is_at_least(values, limit)
    bound = bound_of(results, scene)
    return None if (bound, outcome) in ((">", False), ("<", True)) or bound == "~" else outcome


def counts_outcome(results, scene, least):
    outcome = is_at_least(results.seeds(TIMES, scene, "ir_eq", "match.value"), least)
    return None if bound_of(results, scene) == "~" else outcome


def second_eye(results, measure, most, rounding):
    name = f"second_eye.{measure}"
    limit = most("stereo", name) + rounding
    found = {s: results.seeds(SECOND_EYE, s, "stereo", name) for s in results.scenes(SECOND_EYE)}
    return {s: is_less(v, {seed: limit for seed in v}) for s, v in found.items() if v}
