"""Shared by the tools next to `fovea bench`: exit codes, messages, and pictures written by `fovea render`."""
import argparse
import importlib
import math
import os
import sys

USAGE, BAD_INPUT, CANNOT_WRITE = 2, 3, 7


def fail(code, message):
    """Ends the program with one line on the standard error output."""
    print(f"{os.path.basename(sys.argv[0])}: {message}", file=sys.stderr)
    sys.exit(code)


def load(module):
    try:
        return importlib.import_module(module)
    except ImportError as error:
        fail(BAD_INPUT, f"{sys.executable} cannot import the module {module} ({error}); "
                        "benchmarks/README.md says how to install it")


class Parser(argparse.ArgumentParser):
    def error(self, message):
        fail(USAGE, f"{message}; --help prints the options")


class Picture:
    """Size and metadata of an EXR file. The pixels are read when they are asked for.

    layers: names of layers, of which the first that the file has is taken; "" stands for R, G and B alone.
    """

    def __init__(self, file, layers=("radiance", "")):
        self.file = file
        self.spec = self.open().spec()
        self.size = (self.spec.width, self.spec.height)
        names = [[f"{layer}.{colour}" if layer else colour for colour in "RGB"] for layer in layers]
        self.channels = next((channels for channels in names if set(channels) <= set(self.spec.channelnames)), None)
        if self.channels is None:
            wanted = " or ".join(f"layer `{layer}`" if layer else "channels R, G and B" for layer in layers)
            fail(BAD_INPUT, f"`{file}` has no {wanted}; render it with a graph that has the output `{layers[0]}`")

    def open(self):
        image_io = load("OpenImageIO")
        image = image_io.ImageInput.open(self.file)
        if image is None:
            fail(BAD_INPUT, f"`{self.file}` cannot be read ({image_io.geterror()}); render it again")
        return image

    def metadata(self, key, count, remedy):
        """The numbers of an entry that `fovea render` writes."""
        text = self.spec.getattribute(f"fovea.{key}")
        try:
            numbers = [float(part) for part in str(text).split(",")]
        except ValueError:
            numbers = []
        if len(numbers) != count or not all(map(math.isfinite, numbers)):
            fail(BAD_INPUT, f"`{self.file}` has no usable entry `fovea.{key}` in its metadata; {remedy}")
        return numbers

    def pixels(self):
        """Linear light, height x width x 3."""
        image = self.open()
        pixels = image.read_image("float")
        if pixels is None:
            fail(BAD_INPUT, f"`{self.file}` cannot be read ({image.geterror()}); render it again")
        pixels = pixels[:, :, [self.spec.channelnames.index(name) for name in self.channels]]
        if not load("numpy").isfinite(pixels).all():
            fail(BAD_INPUT, f"`{self.file}` holds radiance that is not finite; render it again")
        return pixels
