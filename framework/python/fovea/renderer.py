"""Runs a graph over a scene, frame after frame."""

from __future__ import annotations

import atexit
import json
import os
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy

from . import _core
from .errors import warn
from .graph import Graph, Plan
from .pictures import Array, write_image
from .places import add_passes, load_plugin, load_scene
from .settings import Settings, Value, texts
from .tables import table

Progress = Callable[[str, float], object]
Record = numpy.dtype[Any] | None
"""The type of a buffer's elements, or None if shaders know them only as texels."""


@atexit.register
def close_devices() -> None:
    """The device of this name, which stays open until Python ends."""
    _core.Device.close_all()


def source_name(name: str, outputs: Iterable[str]) -> str:
    """An output of the graph as it is, and the port of a pass, "deferred.irradiance", as "deferred:irradiance"."""
    return name if ":" in name or name in outputs else name.replace(".", ":", 1)


class Frame(Mapping[str, Array]):
    """What a frame has read back, by name; arrays are read-only.

    Images of floats and of normalised numbers are height x width x channels in float32: those whose texels are 32-bit
    floats, as all light is, are views of the memory into which the frame was read, and others are converted once.
    Images of integers keep their type. Images with layers and volumes have one more axis in front. Of several mips, the
    finest is there. Buffers are structured arrays with the names of the fields of their records.
    """

    def __init__(self, result: _core.FrameResult, names: Mapping[str, str], records: Mapping[str, Record]) -> None:
        self._result = result
        self._names = dict(names)
        self._records = records
        self._arrays: dict[str, Array] = {}

    def __getitem__(self, name: str) -> Array:
        if name not in self._names:
            raise KeyError(f"{name}: this frame has {', '.join(self._names) or 'read nothing'}")
        if name not in self._arrays:
            self._arrays[name] = self._array(self._names[name])
        return self._arrays[name]

    def _array(self, name: str) -> Array:
        array: Array = self._result.array(name)
        element = self._result.element(name)
        if not element:
            return array
        record = self._records[element]
        return array.reshape(-1, self._result.stride(name)) if record is None else array.view(record)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def _repr_png_(self) -> bytes | None:
        """What a notebook shows: the output `image`, if there is one."""
        if "image" not in self:
            return None
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "image.png"
            write_image(file, self["image"])
            return file.read_bytes()

    def beyond_range(self, name: str) -> int:
        """Texels whose light is no number, or too bright for the format in which passes store it."""
        return self._result.beyond_range(self._names[name])

    @property
    def index(self) -> int:
        return self._result.index

    @property
    def gpu_ms(self) -> float:
        """From the first timestamp on the device to the last, in milliseconds."""
        return self._result.gpu_ms

    @property
    def wall_ms(self) -> float:
        """Since the frame before was finished, in milliseconds."""
        return self._result.wall_ms

    @property
    def timings(self) -> Any:
        """The time of each pass in milliseconds: columns frame, pass, gpu_ms and cpu_ms (a pandas.DataFrame, or
        without pandas a list of rows)."""
        return table([{"frame": self.index, "pass": p.name, "gpu_ms": p.gpu_ms, "cpu_ms": p.cpu_ms}
                      for p in self._result.passes])

    @property
    def steps(self) -> Any:
        """The time of each step of each pass on the device: columns frame, pass, step and gpu_ms."""
        return table([{"frame": self.index, "pass": p.name, "step": step, "gpu_ms": ms}
                      for p in self._result.passes for step, ms in p.steps])

    @property
    def counters(self) -> Any:
        """What passes have counted: columns frame, counter and value."""
        return table([{"frame": self.index, "counter": name, "value": value} for name, value in self._result.counters])


class Renderer:
    """A graph over a scene on a device.

        renderer = fovea.Renderer("ours", scene="atrium", size=(512, 512), set={"vpl_count": 500})
        frame = renderer.frame()

    graph: a file, the bare name of a stock graph, or a Graph.
    scene: a file, a bare name, or a Scene.
    size: width and height in pixels.
    set: values of parameters of the graph ("vpl_count") and of passes ("deferred.kernel").
    passes: folders with passes in files (NAME.pass.json). plugins: shared libraries with passes in C++.
    seed: of all random numbers. frame_rate: frames in a second of the scene.
    read: what frames read back: outputs of the graph, and ports of passes ("deferred.irradiance"); by default all
        outputs. Of an image with several mips or layers, a port has one: "atlas.maps@MIP.LAYER".
    device: number or part of the name of a Vulkan device; by default the best one. Renderers share it.
    without: features of the device to do without, as `fovea render --without` does.
    progress: is called inside `frame` by passes that run long on the CPU, with the name of the pass and the share of
        its work that is done, 0 to 1. If it returns False, the pass ends soon with what it has.

    Frames 0, 1, 2.. are those of `fovea render` to the bit. Other threads of Python run while a frame is rendered;
    renderers on the same device wait for each other. Raises Error with every mistake of the graph, and warns of what
    may not be meant.
    """

    def __init__(self, graph: str | os.PathLike[str] | Graph, scene: str | os.PathLike[str] | _core.Scene, *,
                 size: tuple[int, int] = (512, 512), set: Settings | None = None,
                 passes: Iterable[str | os.PathLike[str]] = (), plugins: Iterable[str | os.PathLike[str]] = (),
                 seed: int = 1, frame_rate: float = 42, read: Iterable[str] | None = None, device: str = "",
                 without: Iterable[str] = (), progress: Progress | None = None) -> None:
        for plugin in plugins:
            load_plugin(plugin)
        for folder in passes:
            add_passes(folder)
        self.graph = graph if isinstance(graph, Graph) else Graph.load(graph)
        self.scene = scene if isinstance(scene, _core.Scene) else load_scene(scene)
        report = None if progress is None else lambda name, share: progress(name, share) is not False
        self._session = _core.Session(self.graph.document, self.scene, size, seed, frame_rate, texts(set), [],
                                      _core.Device.open(device, list(without)), report)
        self._next = 0
        self._last: Frame | None = None
        self._options: dict[str, Any] = {}
        self._read: dict[str, str] = {}
        self._records: dict[str, Record] = {}
        self._choose(self._session.outputs() if read is None else read)
        warn(self._session.warnings())

    def frame(self, index: int | None = None, *, time: float | None = None, camera: _core.Camera | None = None,
              gaze: tuple[float, float] | None = None, cut: bool = False, read: bool = True) -> Frame:
        """Renders a frame and waits for it.

        index: by default one more than that of the frame before; random numbers and jitter follow from it.
        time: of the scene in seconds, at least 0; by default index / frame_rate.
        camera: in world space; by default the scene's.
        gaze: where the eye looks, normalised; by default the scene's.
        cut: whether this frame has nothing to do with the one before, so that history begins anew.
        read: whether outputs are read back; a frame without is quicker.

        Motion is relative to the frame before. Raises Error if an input of the graph was never written, and whatever a
        pass or the progress function raises; Ctrl-C ends passes that run long on the CPU.
        """
        index = self._next if index is None else index
        self._options = {"index": index, "time": time, "camera": camera, "gaze": gaze, "cut": cut}
        result = self._session.render(**self._options, read=read)
        for name in result.names():
            if (element := result.element(name)) and element not in self._records:
                self._records[element] = self._record(element, result.stride(name))
        self._last = Frame(result, self._read if read else {}, self._records)
        self._next = index + 1
        return self._last

    def read(self, name: str) -> Array:
        """An output of the graph, or a port of a pass as it is right after its pass ("deferred.irradiance").

        It is that of the last frame if that frame has read it. Otherwise this frame, or the first one, is rendered once
        more with it, so that history goes one frame on, and all further frames read it, too. To have a port from the
        first frame on, name it in `read` of the constructor. Raises Error for what the graph does not have, for a port
        that is not wired, and for a pass that does not run.
        """
        if self._last is None or name not in self._last:
            self._choose([*self._read, name])
            self.frame(**self._options)
        assert self._last is not None
        return self._last[name]

    def _choose(self, names: Iterable[str]) -> None:
        outputs = self._session.outputs()
        chosen = {name: source_name(name, outputs) for name in names}
        self._session.read(list(chosen.values()))
        self._read = chosen

    def write(self, name: str, array: Array) -> None:
        """Fills an input of the graph itself, until it is written again.

        The array has the shape of the input: (layers x) height x width x channels, or for a buffer as many bytes.
        Numbers are converted to those of the input if none is lost in kind; light is given as float32
        in W/(sr m^2). Raises Error if there is no such input, ValueError for another shape and TypeError for numbers of
        another kind.
        """
        known = self._session.inputs()
        if name in known:
            kind, shape = known[name]
            if not kind:  # a buffer
                kind, array = "uint8", numpy.ascontiguousarray(array).reshape(-1).view(numpy.uint8)
            if list(array.shape) != list(shape):
                raise ValueError(f"input `{name}` has the shape {tuple(shape)}, the array {array.shape}")
            if not numpy.can_cast(array.dtype, kind, "same_kind"):
                raise TypeError(f"input `{name}` holds {kind}, the array {array.dtype}")
            array = array.astype(kind)
        self._session.write(name, numpy.ascontiguousarray(array))

    def set(self, name: str | Settings, value: Value | None = None) -> None:
        """Sets a parameter, or several as a mapping, from the next frame on.

        Kept resources and the history of the views stay where neither the passes that write them nor their sizes have
        changed. Raises Error if the graph has no such parameter or does not allow the value; nothing changes then.
        """
        values: Settings = name if isinstance(name, Mapping) else {name: "" if value is None else value}
        self._session.set(texts(values))
        warn(self._session.warnings())

    @property
    def inputs(self) -> dict[str, tuple[str, list[int]]]:
        """The inputs of the graph itself: type and shape of each; of a buffer "" and its bytes."""
        return {name: (kind, list(shape)) for name, (kind, shape) in self._session.inputs().items()}

    @property
    def outputs(self) -> list[str]:
        return list(self._session.outputs())

    @property
    def device(self) -> str:
        """Name and driver of the device."""
        return self._session.device

    @property
    def plan(self) -> Plan:
        """The plan of the graph on this device, with this scene."""
        session = self._session
        return Plan(session.plan(_core.PlanForm.TEXT), session.plan(_core.PlanForm.DOT),
                    json.loads(session.plan(_core.PlanForm.JSON)))

    @property
    def timings(self) -> Any:
        """`Frame.timings` of the last frame. Raises RuntimeError before the first one."""
        return self._finished().timings

    @property
    def counters(self) -> Any:
        """`Frame.counters` of the last frame. Raises RuntimeError before the first one."""
        return self._finished().counters

    def _finished(self) -> Frame:
        if self._last is None:
            raise RuntimeError("no frame was rendered yet: call frame() first")
        return self._last

    def _record(self, element: str, stride: int) -> Record:
        fields = self._session.fields(element)
        if not fields:
            return None
        formats: list[Any] = [(kind, (count,)) if count > 1 and kind else kind or f"V{count}"
                              for _, _, kind, count in fields]
        if [name for name, *_ in fields] == [""]:
            plain: numpy.dtype[Any] = numpy.dtype(formats[0])
            return plain
        record: numpy.dtype[Any] = numpy.dtype({"names": [name for name, *_ in fields], "formats": formats,
                            "offsets": [offset for _, offset, *_ in fields], "itemsize": stride})
        return record

    def __repr__(self) -> str:
        return f"<renderer of {self.graph.name} over {self.scene.name} on {self.device}>"
