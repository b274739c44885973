"""Ground truth: path tracing on the CPU."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy

from . import _core
from .pictures import Array
from .renderer import Progress, Renderer
from .settings import Settings

if TYPE_CHECKING:
    from distributed import Client

Scene = str | os.PathLike[str] | _core.Scene


def trace(part: int, parts: int, scene: Scene, how: dict[str, Any], index: int,
          frame: dict[str, Any]) -> dict[str, Array]:
    """Every `parts`-th row of all layers, from row `part` on. Runs on a worker."""
    how = {**how, "set": {**how["set"], "path-trace.parts": parts, "path-trace.part": part}}
    layers = Renderer("reference", scene, **how).frame(index, **frame)
    return {name: layer[part::parts].copy() for name, layer in layers.items()}


def reference(scene: Scene, *, size: tuple[int, int] = (512, 512), spp: int = 2000, depth: int = 4, seed: int = 1,
              index: int = 0, time: float | None = None, camera: _core.Camera | None = None,
              gaze: tuple[float, float] | None = None, progress: Progress | None = None, client: Client | None = None,
              parts: int | None = None) -> Mapping[str, Array]:
    """The picture that methods approximate, path traced: "radiance", "direct", "indirect", "variance" of the mean, and
    "half_a" and "half_b" of half of the samples each, by which `compare` knows the noise.

    size: width and height in pixels. spp: samples per pixel. depth: edges of the longest path. index, time, camera and
    gaze are those of `Renderer.frame`. `progress` is called with the name of the pass and the share that is done; if it
    returns False, or after Ctrl-C, tracing ends early, the former with fewer samples.

    client: of a Dask cluster, whose workers trace the rows of the picture in `parts` parts (by default one for each of
    their threads); `scene` is then a name or a file that they know. The result is that of one process to the bit.
    Raises Error as Renderer does.
    """
    settings: Settings = {"spp": spp, "depth": depth}
    how: dict[str, Any] = {"size": size, "seed": seed, "set": settings}
    frame: dict[str, Any] = {"time": time, "camera": camera, "gaze": gaze}
    if client is None:
        return Renderer("reference", scene, progress=progress, **how).frame(index, **frame)
    if isinstance(scene, _core.Scene):
        raise TypeError("workers load the scene themselves: give its name or its file")
    import distributed

    as_completed: Any = distributed.as_completed
    cluster: Any = client
    parts = parts or max(1, sum(cluster.nthreads().values()))
    futures = client.map(trace, range(parts), parts=parts, scene=os.fspath(scene), how=how, index=index, frame=frame,
                         pure=False, retries=1)
    layers: dict[str, Array] = {}
    part_of = {future.key: part for part, future in enumerate(futures)}
    for done, future in enumerate(as_completed(futures), 1):
        for name, rows in future.result().items():
            whole = layers.setdefault(name, numpy.empty((size[1], *rows.shape[1:]), rows.dtype))
            whole[part_of[future.key]::parts] = rows
        if progress is not None:
            progress("path-trace", done / parts)
    return layers
