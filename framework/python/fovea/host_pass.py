"""Passes on the CPU that are written in Python."""

from __future__ import annotations

import inspect
import json
from typing import Any, Protocol, TypeVar

from . import _core


class HostPass(Protocol):
    """The interface that a class needs to become a pass."""

    type: str
    declaration: dict[str, Any]

    def execute(self, frame: _core.PassFrame, /) -> None: ...


Pass = TypeVar("Pass", bound=HostPass)
classes: dict[str, type[HostPass]] = {}
"""By the names of their types; the framework makes objects of these."""


def host_pass(cls: type[Pass]) -> type[Pass]:
    """Makes a class a pass type that graphs can name.

    `type` is the name of the pass type. `declaration` is what a file NAME.pass.json holds, without steps: `inputs`,
    `outputs`, `params`, `counters`; its `doc` is the class's docstring unless given. The framework makes an object of
    the class for each pass of a running graph and calls its `execute(frame)` in every frame, which reads
    `frame.input(port)`, fills `frame.output(port)` and may keep things in the object. A class with the same `type`
    replaces the one before for renderers that are made, or whose parameters are set, from then on.

        @fovea.host_pass
        class Negative:
            "what is bright becomes dark"
            type = "negative"
            declaration = {"inputs": {"image": {"doc": "the image", "format": "rgba8"}},
                           "outputs": {"image": {"doc": "its negative", "format": "rgba8"}}}
            def execute(self, frame):
                frame.output("image")[:] = 255 - frame.input("image")

    Raises Error with every mistake in the declaration.
    """
    declaration = {"doc": inspect.getdoc(cls) or "", **cls.declaration}
    _core.add_host_pass(cls.type, json.dumps(declaration, indent=2), f"declaration of {cls.__qualname__}")
    classes[cls.type] = cls
    return cls
