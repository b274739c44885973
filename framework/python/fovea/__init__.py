"""fovea: render graphs with modular passes, from Python.

    import fovea
    renderer = fovea.Renderer("ours", scene="atrium", size=(512, 512), set={"vpl_count": 500})
    frame = renderer.frame(gaze=(0.4, 0.5))
    frame["radiance"]          # height x width x 4, float32, W/(sr m^2)
    renderer.set("deferred.kernel", "disc")

Images are height x width x channels, rows from top to bottom. Lengths are metres, angles radians, times of the scene
seconds, radiance is W/(sr m^2), and points of a picture run from (0, 0) at the top left to (1, 1). Mistakes are
`fovea.Error`, with file, line, column and remedy.
"""

from ._core import (
    Camera,
    Diagnostic,
    ExitCode,
    Key,
    Light,
    LightType,
    Material,
    Mesh,
    PassFrame,
    PassType,
    Repeat,
    Scene,
    Severity,
    passes,
    version as __version__,
)
from .bench import bench
from .errors import Error, Warning
from .graph import Graph, Plan
from .host_pass import host_pass
from .pictures import Array, compare, read_image, write_image
from .places import add_passes, cmake_dir, load_plugin, load_scene, scenes
from .reference import reference
from .renderer import Frame, Renderer
from .settings import Value

__all__ = [
    "Array",
    "Camera",
    "Diagnostic",
    "Error",
    "ExitCode",
    "Frame",
    "Graph",
    "Key",
    "Light",
    "LightType",
    "Material",
    "Mesh",
    "PassFrame",
    "PassType",
    "Plan",
    "Renderer",
    "Repeat",
    "Scene",
    "Severity",
    "Value",
    "Warning",
    "__version__",
    "add_passes",
    "bench",
    "cmake_dir",
    "compare",
    "host_pass",
    "load_plugin",
    "load_scene",
    "passes",
    "read_image",
    "reference",
    "scenes",
    "write_image",
]
