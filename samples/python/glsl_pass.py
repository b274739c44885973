# %% [markdown]
# # A pass in a cell
#
# A pass is a declaration and a shader. Both are written to a folder here, and the graph that uses the pass is a patch
# of a stock graph. Change a cell, run it again, and the picture changes.

# %% Parameters
SIZE = (320, 240)
PICTURE = "glsl_pass.png"

# %% Contours: lines of equal distance from the eye, in metres.
import json
import tempfile
from pathlib import Path

import fovea

folder = Path(tempfile.mkdtemp())
(folder / "contours.pass.json").write_text(json.dumps({
    "doc": "lines of equal distance from the eye",
    "inputs": {"picture": "the picture to draw on",
               "gbuffer": {"doc": "what the eye sees", "bundle": "gbuffer", "members": ["distance"]}},
    "outputs": {"image": {"doc": "the picture with lines", "format": "rgba8"}},
    "params": {"spacing": {"doc": "distance between lines", "default": 0.25, "min": 0.01, "max": 100, "unit": "m"}},
    "steps": [{"shader": "contours.frag", "colors": ["image"]}],
}))

# %% The shader: inputs and parameters are found by their names.
(folder / "contours.frag").write_text("""
uniform texture2D picture, gbufferDistance;
layout(push_constant) uniform Constants { float spacing; };
layout(location = 0) out vec4 image;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy), q = min(p + 1, textureSize(picture, 0) - 1);
  float here = texelFetch(gbufferDistance, p, 0).r, there = texelFetch(gbufferDistance, q, 0).r;
  bool line = floor(here / spacing) != floor(there / spacing);
  image = line ? vec4(1.0, 0.9, 0.2, 1.0) : texelFetch(picture, p, 0);
}
""")

# %% The graph: `image` is what the new pass makes of what was shown before.
graph = fovea.Graph.load("direct").patch({
    "passes": {"contours": {"type": "contours", "inputs": {"picture": "tonemap.image", "gbuffer": "gbuffer.gbuffer"}}},
    "outputs": {"image": "contours"},
})
renderer = fovea.Renderer(graph, scene="cornellbox", size=SIZE, passes=[folder])
image = renderer.frame()["image"]
fovea.write_image(PICTURE, image[..., :3])

# %% Another parameter takes effect in the next frame.
renderer.set("contours.spacing", 1.0)
coarser = renderer.frame()["image"]
YELLOW = (1.0, 230 / 255, 51 / 255)


def lines(picture: fovea.Array) -> int:
    """Pixels of lines."""
    return int((abs(picture[..., :3] - YELLOW).max(axis=2) < 0.01).sum())


print(f"{lines(image)} pixels of lines at 0.25 m, {lines(coarser)} at 1 m")

# %% In a notebook, the graph itself is a drawing.
drawing = graph._repr_html_()
