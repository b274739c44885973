# %% [markdown]
# # A gaze that wanders
#
# Foveated rendering follows the eye. Here the gaze runs along a path over a moving scene; a circle shows the fovea. The
# frames become an animated WebP, which browsers and notebooks play.

# %% Parameters
SIZE = (256, 256)
FRAMES = 84  # two seconds at 42 frames a second
DETAIL: dict[str, int] = {}  # sizes of shadow maps and voxels, where they are not those of the graph
VIDEO = "gaze.webp"

# %% The path: a figure of eight around the middle.
import math

import numpy
from PIL import Image, ImageDraw

import fovea

RATE = 42


def gaze_at(time: float) -> tuple[float, float]:
    angle = math.pi * time
    return 0.5 + 0.3 * math.sin(angle), 0.5 + 0.15 * math.sin(2 * angle)


# %% Frame after frame; VPLs and their shadow maps are kept where the eye still looks.
renderer = fovea.Renderer("foveal_view", scene="cornellbox_moving", size=SIZE, frame_rate=RATE, set=DETAIL)
pictures = []
for index in range(FRAMES):
    gaze = gaze_at(index / RATE)
    image = renderer.frame(gaze=gaze)["image"]
    picture = Image.fromarray(numpy.round(255 * image[..., :3]).astype(numpy.uint8))
    x, y = gaze[0] * SIZE[0], gaze[1] * SIZE[1]
    radius = 0.25 * SIZE[0]
    ImageDraw.Draw(picture).ellipse((x - radius, y - radius, x + radius, y + radius), outline=(255, 220, 60))
    pictures.append(picture)

# %% The video.
pictures[0].save(VIDEO, save_all=True, append_images=pictures[1:], duration=round(1000 / RATE), loop=0, quality=80)
print(f"{VIDEO}: {len(pictures)} frames, {pictures[0].width} pixels wide")
