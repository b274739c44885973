#!/usr/bin/env python3
"""Compares the reference graph with Mitsuba 3, a renderer with which it shares no code.

Exports each scene, renders it with Mitsuba's path integrator (`pip install mitsuba`) and with graphs/reference.json, both
with a box filter and independent samples, and compares: the mean radiance (within 0.5%, or 1% with --materials full), and
pixel by pixel (z-test with Sidak's correction at a level of 1%; at most 0.25% of the pixels may be rejected). Exit code 1
when a scene disagrees.

  samples/compare_with_mitsuba.py --fovea build/release/bin/fovea cornellbox sponza tests/data/mitsuba/every_light.json

--save FOLDER keeps Mitsuba's pictures as NAME.exr, 16-bit: R, G, B and the standard deviation of the mean of each; the
tests compare with those in tests/data/mitsuba, for which no Mitsuba is needed.
"""

import argparse
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

import numpy as np

try:
    import mitsuba as mi
except ImportError:
    sys.exit("Mitsuba 3 is not installed: pip install mitsuba")

SIGNIFICANCE = 0.01      # that any pixel of a picture that agrees is rejected
MEAN_TOLERANCE = {"diffuse": 0.005, "full": 0.01}  # full ones are only alike (framework/scene/export/mitsuba.h)
REJECTED_PIXELS = 0.0025
# Of a value: what both compute in other orders and precisions (8-bit and 16-bit images, float sums).
ARITHMETIC = 1e-3
# Of the mean of the picture: by how much pixels may differ where materials are only alike. It is what light that is
# scattered more than once among microfacets adds, which Mitsuba lacks.
ALIKE = {"diffuse": 0, "full": 0.02}


def run(program, *arguments):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{program} {' '.join(map(str, arguments))} failed:\n{done.stderr}")
    return done.stdout


def environment(program, scene):
    """The colour behind the scene; black if there is a map, which is exported with the scene."""
    sky = re.search(r"^sky +([-\d.e]+) ([-\d.e]+) ([-\d.e]+)", run(program, "scene", "info", scene), re.MULTILINE)
    return np.array([float(v) for v in sky.groups()]) if sky else np.zeros(3)


def render_mitsuba(xml, sky, options):
    """Mean and variance of the mean, from independent batches. Where nothing is hit the scene's environment is seen."""
    scene = mi.load_file(str(xml), spp=options.spp, depth=options.depth)
    total, squares = 0.0, 0.0
    for seed in range(options.batches):
        rgba = np.array(mi.render(scene, seed=options.seed + seed), dtype=np.float64)
        batch = rgba[..., :3] + (1 - rgba[..., 3:4]) * sky
        total, squares = total + batch, squares + batch * batch
        if sys.stderr.isatty():
            end = "\r\033[K" if seed + 1 == options.batches else ""
            print(f"\r  Mitsuba {seed + 1}/{options.batches}{end}", end="", file=sys.stderr, flush=True)
    n = options.batches
    mean = total / n
    return mean, np.maximum(squares / n - mean * mean, 0) / (n - 1)


def read_layers(file):
    bitmap = mi.Bitmap(str(file))
    data = np.array(bitmap, dtype=np.float64)
    names = [field.name for field in bitmap.struct_()]
    return {layer: data[..., [names.index(f"{layer}.{c}") for c in "RGB"]] for layer in ("radiance", "variance")}


def z_values(mean, variance, degrees, other, other_variance, alike):
    """Welch's t of two means, brought to the normal distribution (Wallace 1959). `degrees` are those of `variance`;
    `alike` is the difference that counts as none."""
    floor = (ARITHMETIC * np.maximum(np.abs(mean), np.abs(other))) ** 2 + 1e-12
    total = variance + other_variance + floor
    t2 = np.maximum(np.abs(mean - other) - alike, 0) ** 2 / total
    freedom = degrees * total**2 / np.maximum(variance, 1e-30) ** 2
    return np.sqrt(freedom * np.log1p(t2 / freedom)) * (8 * freedom + 1) / (8 * freedom + 3)


def compare(name, mean, variance, ours, options):
    z = z_values(mean, variance, options.batches - 1, ours["radiance"], ours["variance"],
                 ALIKE[options.materials] * mean.mean())
    tests = z.size
    limit = statistics.NormalDist().inv_cdf(1 - (1 - (1 - SIGNIFICANCE) ** (1 / tests)) / 2)
    rejected = float(np.mean(np.any(z > limit, axis=-1)))
    channels = ours["radiance"].mean((0, 1)) / mean.mean((0, 1)) - 1
    difference = float(ours["radiance"].mean() / mean.mean() - 1)
    # Channels of one path rise and fall together: the mean of their deviations.
    error = float(np.sqrt((variance + ours["variance"]).mean((0, 1)) / z[..., 0].size).mean() / mean.mean())
    agrees = abs(difference) <= MEAN_TOLERANCE[options.materials] and rejected <= REJECTED_PIXELS
    print(f"{name:16} mean {mean.mean():.5f}  ours {100 * difference:+.3f}% (R, G, B "
          + ", ".join(f"{100 * c:+.3f}" for c in channels) + f"; standard error {100 * error:.3f}%)  "
          f"pixels rejected {100 * rejected:.3f}%, largest z {z.max():.1f} (limit {limit:.2f})  "
          + ("agrees" if agrees else "DISAGREES"))
    if options.verbose:
        for y, x in zip(*np.where(np.any(z > limit, axis=-1))):
            print(f"  pixel {x}, {y}: Mitsuba {mean[y, x].round(5)}, ours {ours['radiance'][y, x].round(5)}, "
                  f"z {z[y, x].max():.1f}")
    return agrees


def save(file, mean, variance, options):
    channels = ["R", "G", "B", "deviation.R", "deviation.G", "deviation.B"]
    data = np.concatenate([mean, np.sqrt(variance)], axis=-1).astype(np.float16)
    bitmap = mi.Bitmap(data, mi.Bitmap.PixelFormat.MultiChannel, channels)
    bitmap.metadata()["fovea.batches"] = str(options.batches)
    bitmap.metadata()["fovea.samples"] = str(options.batches * options.spp)
    bitmap.metadata()["fovea.depth"] = str(options.depth)
    bitmap.metadata()["fovea.renderer"] = "Mitsuba " + mi.__version__
    bitmap.write(str(file))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", metavar="SCENE", help="as for `fovea render --scene`")
    parser.add_argument("--fovea", default="fovea", help="the program; default: fovea on the search path")
    parser.add_argument("--size", default="64x64", help="default 64x64")
    parser.add_argument("--batches", type=int, default=64, help="independent pictures of Mitsuba; default 64")
    parser.add_argument("--spp", type=int, default=64, help="samples per pixel of each; default 64")
    parser.add_argument("--depth", type=int, default=4, help="1 emission, 2 direct light; default 4")
    parser.add_argument("--materials", default="diffuse", choices=["diffuse", "full"], help="default diffuse")
    parser.add_argument("--frame", type=int, default=0, help="of a scene that moves, 42 a second; default 0")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--variant", default="scalar_rgb", help="of Mitsuba; default scalar_rgb, llvm_ad_rgb is faster")
    parser.add_argument("--save", type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("--verbose", action="store_true", help="list the pixels that are rejected")
    options = parser.parse_args()
    mi.set_variant(options.variant)
    agree = True
    for scene in options.scenes:
        name = pathlib.Path(scene).stem
        with tempfile.TemporaryDirectory(prefix="fovea-mitsuba-") as folder:
            xml = run(options.fovea, "scene", "export", scene, "-o", folder, "--format", "mitsuba", "--size",
                      options.size, "--depth", options.depth, "--frame", options.frame, "--materials",
                      options.materials).strip()
            mean, variance = render_mitsuba(xml, environment(options.fovea, scene), options)
            if options.save:
                save(options.save / f"{name}.exr", mean, variance, options)
            picture = pathlib.Path(folder) / "ours.exr"
            run(options.fovea, "render", "reference", "--scene", scene, "--size", options.size, "--set", "filter=box",
                "--set", "sampling=independent", "--set", f"depth={options.depth}", "--set",
                f"spp={options.batches * options.spp}", "--materials", options.materials, "--first",
                options.frame, "-o", picture)
            ours = read_layers(picture)
        agree = compare(name, mean, variance, ours, options) and agree
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    main()
