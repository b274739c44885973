"""Scenes and passes by name, and where things are."""

from __future__ import annotations

import os
from pathlib import Path

from . import _core
from .errors import warn


def scenes() -> list[str]:
    """The names of the scenes that come along."""
    return _core.scene_names()


def load_scene(name_or_file: str | os.PathLike[str], environment: str | os.PathLike[str] = "") -> _core.Scene:
    """A scene by bare name ("atrium"), or from a .json, .gltf or .glb file.

    A model gets what a picture of it needs and it lacks, with a warning. `environment` names an equirectangular image
    of linear radiance that replaces the light from all around. Raises Error with file, place and remedy.
    """
    scene, messages = _core.load_scene(os.fspath(name_or_file), os.fspath(environment))
    warn(messages)
    return scene


def add_passes(folder: str | os.PathLike[str]) -> None:
    """Adds the passes that the files NAME.pass.json in a folder declare.

    Those that have changed are read again, and so are the shaders of all passes, for renderers that are made, and
    parameters that are set, from then on. Raises Error with every mistake in the files.
    """
    _core.add_passes(os.fspath(folder))


def load_plugin(file: str | os.PathLike[str]) -> None:
    """Adds the passes of a shared library. Raises Error if it is no plug-in for this version of fovea."""
    _core.load_plugin(os.fspath(file))


def cmake_dir() -> Path:
    """The folder of the CMake package, for passes in C++: cmake -D fovea_DIR=$(python -c "..fovea.cmake_dir()").

    Raises FileNotFoundError if this is not an installed package.
    """
    folder = Path(__file__).parent / "lib/cmake/fovea"
    if not folder.is_dir():
        raise FileNotFoundError(f"{folder} is not there: this `fovea` is no installed package; see `pip install`")
    return folder
