#!/usr/bin/env python3
"""Compares the reference graph with full materials with Cycles, Blender's path tracer, with which it shares no code.

Exports each scene as glTF, renders it with Cycles through its own glTF importer (`pip install bpy`) and with
graphs/reference.json, both with a box filter, and compares the mean radiance of the pixels that surfaces cover wholly.
Unlike Mitsuba (compare_with_mitsuba.py), Cycles has multiple scattering on rough surfaces, and a diffuse layer below a
rough surface. Exit code 1 when a scene disagrees.

  samples/compare_with_cycles.py --fovea build/release/bin/fovea model.glb scene.json

Directional lights, point lights and emissive surfaces are compared; Cycles has a different falloff of spot lights, and
environment maps and skies are left out on both sides.
"""

import argparse
import contextlib
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

try:
    import bpy
except ImportError:
    sys.exit("Cycles is not installed: pip install bpy")


def run(program, *arguments):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{program} {' '.join(map(str, arguments))} failed:\n{done.stderr}")


@contextlib.contextmanager
def silence():
    """Blender reports its progress on the standard output."""
    kept = os.dup(1)
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        os.dup2(nowhere.fileno(), 1)
        try:
            yield
        finally:
            os.dup2(kept, 1)
            os.close(kept)


def render_cycles(gltf, file, options):
    """Radiance and coverage, rows from the top."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(gltf), export_import_convert_lighting_mode="RAW")
    scene = bpy.context.scene
    scene.camera = next(o for o in bpy.data.objects if o.type == "CAMERA")
    for lamp in (o.data for o in bpy.data.objects if o.type == "LIGHT"):
        if lamp.type == "SUN":
            lamp.angle = 0
        else:
            lamp.energy *= 4 * math.pi  # from W/sr
            lamp.shadow_soft_size = 0
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.samples = options.spp
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = options.depth - 2
    cycles.transmission_bounces = options.depth - 2
    cycles.transparent_max_bounces = 64
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1
    scene.render.film_transparent = True
    scene.render.resolution_x, scene.render.resolution_y = map(int, options.size.split("x"))
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(file)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(file))
    image.colorspace_settings.name = "Non-Color"
    pixels = np.array(image.pixels[:], dtype=np.float64).reshape(image.size[1], image.size[0], 4)[::-1]
    return pixels[..., :3], pixels[..., 3]


def read_pfm(file):
    with open(file, "rb") as f:
        kind, width, height, scale = f.readline(), *map(int, f.readline().split()), float(f.readline())
        assert kind == b"PF\n"
        data = np.frombuffer(f.read(), dtype="<f4" if scale < 0 else ">f4")
    return data.reshape(height, width, 3)[::-1].astype(np.float64)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", metavar="SCENE", help="as for `fovea render --scene`")
    parser.add_argument("--fovea", default="fovea", help="the program; default: fovea on the search path")
    parser.add_argument("--size", default="96x96", help="default 96x96")
    parser.add_argument("--spp", type=int, default=256, help="samples per pixel of both; default 256")
    parser.add_argument("--depth", type=int, default=4, help="edges of the longest paths; default 4")
    parser.add_argument("--tolerance", type=float, default=0.01, help="of the mean; default 0.01")
    options = parser.parse_args()
    agree = True
    for scene in options.scenes:
        with tempfile.TemporaryDirectory(prefix="fovea-cycles-") as name:
            folder = pathlib.Path(name)
            run(options.fovea, "scene", "export", scene, "-o", folder, "--format", "gltf")
            exported = next(folder.glob("*.json"))
            description = {**json.loads(exported.read_text()), "environment": [0, 0, 0]}
            exported.write_text(json.dumps(description))
            with silence():
                theirs, covered = render_cycles(next(folder.glob("*.gl*")), folder / "cycles.exr", options)
            run(options.fovea, "render", "reference", "--scene", exported, "--size", options.size,
                "--set", "filter=box", "--set", f"depth={options.depth}", "--set", f"spp={options.spp}",
                "--materials", "full", "-o", f"radiance={folder / 'ours.pfm'}")
            ours = read_pfm(folder / "ours.pfm")
        where = covered > 0.999
        difference = ours[where].mean(0) / theirs[where].mean(0) - 1
        mean = float(ours[where].mean() / theirs[where].mean() - 1)
        good = abs(mean) <= options.tolerance
        agree = agree and good
        print(f"{pathlib.Path(scene).stem:16} covered {100 * where.mean():.0f}%  mean {theirs[where].mean():.5f}  ours "
              f"{100 * mean:+.2f}% (R, G, B " + ", ".join(f"{100 * c:+.2f}" for c in difference) + ")  "
              + ("agrees" if good else "DISAGREES"), flush=True)
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    main()
