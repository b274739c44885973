"""Graphs as objects: load, change, check, save, draw."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from . import _core
from .drawing import drawing
from .errors import warn
from .settings import Settings, texts


class Plan:
    """What a graph is compiled to: the order of its passes, barriers and memory."""

    def __init__(self, text: str, dot: str, data: dict[str, Any]) -> None:
        self.text = text
        self.dot = dot
        """The plan as a drawing for Graphviz."""
        self.data = data
        """The same facts as `text`, in the form of `fovea check --plan json`."""

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return drawing(self.dot, self.data["graph"])


class Graph:
    """A graph before it is compiled. Graphs do not change; `patch` and `merge` return others."""

    def __init__(self, document: _core.Document) -> None:
        self.document = document

    @classmethod
    def load(cls, name_or_file: str | os.PathLike[str]) -> Graph:
        """A graph file, or the bare name of a stock graph ("ours"). Raises Error if there is none."""
        return cls(_core.Document.load(os.fspath(name_or_file)))

    @classmethod
    def parse(cls, content: str | Mapping[str, Any], file: str | os.PathLike[str] = "graph.json") -> Graph:
        """Makes a graph from JSON text, or from dictionaries and lists of the same structure.

        `file` gives the graph its name, is the file in messages, and need not exist; what the graph extends is looked
        up in its folder, and then among the stock graphs.
        """
        text = content if isinstance(content, str) else json.dumps(content, indent=2)
        return cls(_core.Document.parse(text, os.fspath(file)))

    @property
    def name(self) -> str:
        return Path(self.document.file).stem

    @property
    def text(self) -> str:
        """The graph as JSON."""
        return self.document.text()

    @property
    def data(self) -> dict[str, Any]:
        """The graph as dictionaries and lists; a copy."""
        data: dict[str, Any] = json.loads(self.text)
        return data

    def merge(self) -> Graph:
        """This graph with everything that it extends merged in. Raises Error with every mistake."""
        return Graph(self.document.merged())

    def patch(self, changes: str | Mapping[str, Any], source: str = "patch") -> Graph:
        """The merged graph with changes as a file that extends it would make them; None (null) removes.

        `source` is the name of the changes in messages. Raises Error with every mistake.
        """
        text = changes if isinstance(changes, str) else json.dumps(changes, indent=2)
        return Graph(self.document.patched(text, source))

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the graph to a file. Raises Error if it cannot be written."""
        self.document.save(os.fspath(file))

    def check(self, size: tuple[int, int] = (1024, 1024), set: Settings | None = None) -> Plan:
        """The plan of this graph for pictures of `size` (width, height); needs no device and no scene.

        Raises Error with every mistake of the graph; what may not be meant is a warning.
        """
        text, messages = _core.check(self.document, _core.PlanForm.TEXT, size, texts(set))
        warn(messages)
        dot, _ = _core.check(self.document, _core.PlanForm.DOT, size, texts(set))
        data, _ = _core.check(self.document, _core.PlanForm.JSON, size, texts(set))
        return Plan(text, dot, json.loads(data))

    def __repr__(self) -> str:
        return f"<graph {self.name}>"

    def _repr_html_(self) -> str:
        return self.check()._repr_html_()
