#!/usr/bin/env python3
"""How visibly sequences differ from their reference: JOD by FovVideoVDP, which follows the gaze of every frame.

Usage: benchmarks/perceptual.py foveal_%04d.exr [ir_%04d.exr ...] reference_%04d.exr
The sequences are EXR files as `fovea render -o NAME_%04d.exr` writes them; the last name is that of the reference.
The metric is described in: Mantiuk et al. 2021, "FovVideoVDP: A visible difference predictor for wide field-of-view
video", SIGGRAPH 2021. Identical sequences have 10 JOD. Of two sequences that are 1 JOD apart, 75% of observers prefer
the one with the higher value. benchmarks/README.md says how to install the Python modules that this needs.

Exit code 2: the command line is wrong; 3: a file or a Python module cannot be used; 7: the heat map cannot be written.
"""
import argparse
import json
import math
import os
import re
import sys

from pictures import BAD_INPUT, CANNOT_WRITE, Parser, Picture, fail, load

CONTRAST = 1000  # of the display: its peak luminance over that of its black in a dark room
REFLECTIVITY = 0.005  # of the screen, which scatters ambient light evenly
LUMINANCE_OF_RGB = (0.2126, 0.7152, 0.0722)  # Rec. 709


# ---- Sequences

def find_frames(pattern):
    """The files of a pattern such as out_%04d.exr, by the frame numbers in their names and in their order."""
    folder, name = os.path.split(pattern)
    parts = re.fullmatch(r"([^%]*)%(?:0?\d+)?d([^%]*)", name)
    if not parts:
        fail(BAD_INPUT, f"`{pattern}` is not a name with one frame number; write %d or %04d, for example out_%04d.exr")
    wanted = re.compile(re.escape(parts[1]) + "([0-9]+)" + re.escape(parts[2]))
    try:
        names = os.listdir(folder or ".")
    except OSError as error:
        fail(BAD_INPUT, f"the folder `{folder}` cannot be read ({error.strerror}); check the name `{pattern}`")
    found = sorted((int(match[1]), os.path.join(folder, match[0])) for match in map(wanted.fullmatch, names) if match)
    frames = dict(found)
    if not frames:
        fail(BAD_INPUT, f"no file matches `{pattern}`; render the frames with `fovea render ... -o {name}`")
    if len(frames) < len(found):
        fail(BAD_INPUT, f"`{pattern}` has two files for one frame; the numbers must have the same number of digits")
    missing = set(range(min(frames), max(frames) + 1)) - frames.keys()
    if missing:
        fail(BAD_INPUT, f"`{pattern}` lacks frame {min(missing)}; "
                        f"render all frames from {min(frames)} to {max(frames)}")
    return frames


class Frame(Picture):
    """A picture with its gaze and exposure."""

    def gaze(self):
        return self.metadata("gaze", 2, "give --gaze X,Y or --no-foveation")

    def exposure(self):
        return self.metadata("exposure", 1, "give --exposure E")[0]


def read_sequences(patterns):
    """The pictures of every pattern. All patterns have the same frames, and all pictures the same size."""
    frames = [find_frames(pattern) for pattern in patterns]
    span = [f"frames {min(f)} to {max(f)}" for f in frames]
    for pattern, its_span in zip(patterns, span):
        if its_span != span[-1]:
            fail(BAD_INPUT, f"`{pattern}` has {its_span} but `{patterns[-1]}` {span[-1]}; "
                            "render the same frames of both with --first, --warmup and --frames")
    sequences = [[Frame(file) for file in f.values()] for f in frames]
    first = sequences[-1][0]
    for picture in sum(sequences, []):
        if picture.size != first.size:
            fail(BAD_INPUT, "`{}` has {}x{} pixels but `{}` {}x{}; render both with the same --size".format(
                picture.file, *picture.size, first.file, *first.size))
    return sequences


def common_exposure(frames):
    first = frames[0]
    for picture in frames:
        if picture.exposure() != first.exposure():
            fail(BAD_INPUT, f"`{picture.file}` has the exposure {picture.exposure():g} but `{first.file}` "
                            f"{first.exposure():g}; give one for both with --exposure E")
    return first.exposure()


def fixations(frames, gaze):
    """Where the eye looks in each picture, in pixels; the centre of the pixel at the top left is 0, 0."""
    return [[part * side - 0.5 for part, side in zip(gaze or picture.gaze(), picture.size)] for picture in frames]


# ---- Display

def displayed_luminance(radiance, exposure, peak, ambient):
    """Luminance in cd/m^2 of a display that shows exposure x radiance and clips what is brighter than its white.

    The light that a pixel emits is linear in the clipped value, since encoding and decoding with the sRGB curve cancel
    each other; the rounding to 8 bits is left out. Reflected ambient light is added to the black and to the white.
    """
    numpy = load("numpy")
    shown = numpy.clip(exposure * radiance, 0, 1) @ numpy.array(LUMINANCE_OF_RGB, dtype=numpy.float32)
    black = peak / CONTRAST
    return black + (peak - black) * shown + ambient * REFLECTIVITY / math.pi


def width_in_degrees(pixels, pixels_per_degree):
    """Width of a flat display with so many pixels, which has that resolution where it is nearest to the eye."""
    return 2 * math.degrees(math.atan(pixels * math.tan(math.radians(0.5 / pixels_per_degree))))


def resolution_in_degrees(pixels, width):
    """The inverse of width_in_degrees(): pixels per degree."""
    return 0.5 / math.degrees(math.atan(math.tan(math.radians(width / 2)) / pixels))


# ---- Metric

class Video:
    """Pairs of frames in the form in which FovVideoVDP asks for them: luminance as tensors of shape 1, 1, 1, H, W."""

    def __init__(self, test, reference, to_luminance, fps):
        self.test, self.reference, self.to_luminance, self.fps = test, reference, to_luminance, fps

    def get_video_size(self):
        width, height = self.test[0].size
        return height, width, len(self.test)

    def get_frames_per_second(self):
        return self.fps

    def get_test_frame(self, frame, device):
        return self.tensor(self.test[frame], device)

    def get_reference_frame(self, frame, device):
        return self.tensor(self.reference[frame], device)

    def tensor(self, picture, device):
        luminance = self.to_luminance(picture.pixels()).astype("float32")
        return load("torch").from_numpy(luminance).to(device)[None, None, None]


def write_heatmap(pattern, frames, heatmap):
    """Writes pictures, a tensor of shape 1, 3, F, H, W: all of them if the name has a frame number, else the last."""
    image_io = load("OpenImageIO")
    pixels = heatmap[0].permute(1, 2, 3, 0).float().numpy()
    files = {pattern % frame if "%" in pattern else pattern: picture for frame, picture in zip(frames, pixels)}
    for file, picture in files.items():
        buffer = image_io.ImageBuf(image_io.ImageSpec(picture.shape[1], picture.shape[0], 3, "uint8"))
        buffer.set_pixels(image_io.ROI(0, picture.shape[1], 0, picture.shape[0], 0, 1, 0, 3), picture)
        if not buffer.write(file):
            fail(CANNOT_WRITE, f"`{file}` cannot be written ({buffer.geterror()})")


# ---- Command line

def positive(text):
    value = float(text)
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"`{text}` is not greater than 0")
    return value


def illuminance(text):
    value = float(text)
    if not 0 <= value < math.inf:
        raise argparse.ArgumentTypeError(f"`{text}` is less than 0 or not finite")
    return value


def angle(text):
    value = float(text)
    if not 1 <= value <= 170:
        raise argparse.ArgumentTypeError(f"`{text}` is not from 1 to 170")
    return value


def position(text):
    x, y = map(float, text.split(","))
    if not 0 <= x <= 1 or not 0 <= y <= 1:
        raise argparse.ArgumentTypeError(f"`{text}` is not from 0,0 to 1,1")
    return x, y


def heatmap_file(text):
    if not re.fullmatch(r"[^%]*(%(0?\d+)?d)?[^%]*\.png", text):
        raise argparse.ArgumentTypeError(f"`{text}` is not the name of a PNG file, such as heat.png or heat_%04d.png")
    return text


def parse(arguments):
    parser = Parser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("tests", nargs="+", metavar="TEST", help="sequences to judge, for example foveal_%%04d.exr")
    add("reference", metavar="REFERENCE", help="the sequence with which each is compared")
    add("--fps", type=positive, default=42, help="frames per second; the default is 42, as in `fovea render`")
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--display-width-deg", type=angle, default=60, metavar="DEG",
                      help="angle that the width of the picture fills, seen from in front of its middle; default 60")
    size.add_argument("--pixels-per-degree", type=positive, metavar="P",
                      help="pixels per degree in the middle of the picture, instead of its width")
    add("--luminance", type=positive, default=200, metavar="CD_M2", help="peak luminance; the default is 200 cd/m^2")
    add("--ambient", type=illuminance, default=0, metavar="LUX", help="light on the screen; the default is 0")
    add("--exposure", type=positive, metavar="E",
        help="factor from radiance to the display's white; the default is that in the metadata of the files")
    gaze = parser.add_mutually_exclusive_group()
    gaze.add_argument("--gaze", type=position, metavar="X,Y",
                      help="where the eye looks in all frames, instead of the gaze in the metadata of TEST")
    gaze.add_argument("--no-foveation", action="store_true", help="the eye sees as sharply everywhere as in its fovea")
    add("--heatmap", type=heatmap_file, metavar="FILE.png",
        help="picture of the visible differences in the last frame of the only TEST, "
             "or in every frame if the name has a number such as %%04d")
    add("--json", action="store_true", help="print JSON instead of a table")
    result = parser.parse_args(arguments)
    if result.heatmap and len(result.tests) > 1:
        parser.error("--heatmap can only be written for one TEST")
    return result


def main():
    options = parse(sys.argv[1:])
    *tests, reference = read_sequences([*options.tests, options.reference])
    exposure = options.exposure or common_exposure(reference + sum(tests, []))
    gazes = [None if options.no_foveation else fixations(test, options.gaze) for test in tests]
    size = reference[0].size
    width = options.display_width_deg
    if options.pixels_per_degree:
        width = width_in_degrees(size[0], options.pixels_per_degree)

    if options.heatmap and not os.access(os.path.dirname(options.heatmap) or ".", os.W_OK):
        fail(CANNOT_WRITE, f"`{options.heatmap}` cannot be written; choose a folder that exists and can be written to")

    pyfvvdp, numpy = load("pyfvvdp"), load("numpy")
    metric = pyfvvdp.fvvdp(display_geometry=pyfvvdp.fvvdp_display_geometry(size, fov_horizontal=width),
                           foveated=not options.no_foveation, quiet=True,
                           heatmap="supra-threshold" if options.heatmap else None)
    rows = []
    for pattern, test, gaze in zip(options.tests, tests, gazes):
        video = Video(test, reference, lambda radiance: displayed_luminance(
            radiance, exposure, options.luminance, options.ambient), options.fps)
        jod, details = metric.predict_video_source(video, fixation_point=None if gaze is None else numpy.array(gaze))
        rows.append({"sequence": pattern, "jod": float(jod), "frames": len(test)})
        if options.heatmap:
            write_heatmap(options.heatmap, find_frames(pattern), details["heatmap"])

    settings = {"metric": f"FovVideoVDP {metric.version}", "reference": options.reference, "size": list(size),
                "fps": options.fps, "display_width_deg": width,
                "pixels_per_degree": resolution_in_degrees(size[0], width), "luminance": options.luminance,
                "ambient": options.ambient, "exposure": exposure, "foveated": not options.no_foveation}
    if options.json:
        print(json.dumps({**settings, "sequences": rows}, indent=2))
        return
    print(f"{settings['metric']}, {'foveated' if settings['foveated'] else 'not foveated'}; reference "
          f"{options.reference}\n{size[0]}x{size[1]} pixels, {width:.4g} degrees wide, "
          f"{settings['pixels_per_degree']:.3g} pixels per degree, {options.fps:g} frames per second\n"
          f"{options.luminance:g} cd/m^2, {options.ambient:g} lux, exposure {exposure:g}\n")
    column = max(len(row["sequence"]) for row in rows)
    print(f"{'sequence':{column}}    JOD  frames")
    for row in rows:
        print(f"{row['sequence']:{column}} {row['jod']:6.3f} {row['frames']:7}")


if __name__ == "__main__":
    main()
