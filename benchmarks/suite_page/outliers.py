"""Times that do not fit the others of their kind, which a mean would hide."""
from .measures import digits

# Frames and seeds that take more than this many times as long as expected are reported.
SLOW_FRAME, SLOW_SEED = 2, 2


def outliers(results):
    """Sentences on the jobs of a sweep: slow frames within a job, and seeds that are slower than the others."""
    found, seeds = [], {}
    for result in results:
        job, wall = result["job"], result["time"]["frame"]["wall_ms"]
        where = ", ".join([job["scene"], job["label"], *(f"{k} = {v}" for k, v in job["varied"].items())])
        seeds.setdefault(where, {})[job["seed"]] = wall["median"]
        if job["frames"] > 1 and wall["p95"] > SLOW_FRAME * wall["median"]:
            found.append(f"{where}, seed {job['seed']}: the slowest frames take {digits(wall['p95'])} ms, "
                         f"{digits(wall['p95'] / wall['median'], 2)} times the median of {digits(wall['median'])} ms; tables and "
                         "plots show medians over frames, which such frames do not move.")
    for where, times in seeds.items():
        least = min(times.values())
        for seed, ms in times.items():
            if ms > SLOW_SEED * least > 0:
                found.append(f"{where}, seed {seed}: a frame takes {digits(ms)} ms, {digits(ms / least, 2)} times that of the fastest "
                             f"seed ({digits(least)} ms). It is part of the mean, whose interval is wide for that reason: "
                             "measure it again before you quote it.")
    return found
