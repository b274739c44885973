"""Pictures in files, and how far they are from their references."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy
from numpy.typing import NDArray

from . import _core

Array = NDArray[Any]
Layers = Mapping[str, Array]
Source = Array | Layers | str | os.PathLike[str]


def _layers(picture: Array | Layers) -> dict[str, NDArray[numpy.float32]]:
    layers = picture if isinstance(picture, Mapping) else {"radiance": picture}
    return {name: numpy.ascontiguousarray(array, numpy.float32) for name, array in layers.items()
            if array.ndim == 3 and array.dtype.kind == "f"}


def read_image(file: str | os.PathLike[str]) -> dict[str, NDArray[numpy.float32]]:
    """The layers of an .exr, .pfm, .hdr, .png or .jpg by name: height x width x channels, float32, read-only.

    The only layer of a plain file is called "". Raises Error if the file cannot be read.
    """
    return dict(_core.Pictures.read(os.fspath(file)).layers)


def write_image(file: str | os.PathLike[str], picture: Array | Layers) -> None:
    """Writes an array of height x width x channels, or several as layers of an .exr.

    EXR and PFM hold radiance as 32-bit floats; PNG shows values from 0 to 1 as they are. Of a frame, an .exr holds
    every image of floats. Raises Error if the file cannot be written.
    """
    layers = _layers(picture) if isinstance(picture, Mapping) else {"": _layers(picture)["radiance"]}
    _core.Pictures(layers, {}, True).write(os.fspath(file))


def compare(image: Source, reference: Source, *, layer: str = "", gaze: tuple[float, float] | None = None,
            radius: float | None = None, exposure: float | None = None,
            pixels_per_degree: float = 67) -> dict[str, dict[str, float]]:
    """How far a picture is from its reference, in the regions "fovea", "periphery" and "whole".

    Pictures are arrays of radiance (height x width x channels), mappings of them such as frames, or files. The measures
    are those of `fovea compare`: "mse", "psnr" (dB) and "flip" of what is displayed, sRGB(exposure * radiance), and
    "relmse" of the radiance; "noise_floor" is what the noise of the reference adds, known if it has the layers
    "half_a" and "half_b". What is not known is NaN. `layer` is by default "radiance". `gaze` (normalised, by default
    the middle) and `radius` (image widths, by default 0.25) give the fovea.

    Raises Error if sizes or layers differ, or if a picture holds NaN or infinity.
    """
    def pictures(source: Source) -> _core.Pictures:
        if isinstance(source, (str, os.PathLike)):
            return _core.Pictures.read(os.fspath(source))
        return _core.Pictures(_layers(source), {}, True)

    return _core.compare(pictures(image), pictures(reference), layer, gaze, radius, exposure, pixels_per_degree)
