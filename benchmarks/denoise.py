#!/usr/bin/env python3
"""Removes the noise of traced pictures with Intel Open Image Denoise, outside the frame and its times.

Usage: benchmarks/denoise.py noisy.exr denoised.exr [--layer indirect]
The layer (default: every one of `radiance` and `indirect` that the file has) is linear light. Layers `albedo` and
`normal`, as the graph alternatives/pt_denoised writes them, keep textures and edges sharp. All other layers and the
metadata are copied. benchmarks/README.md says how to install the Python modules that this needs.

Exit code 2: the command line is wrong; 3: a file or a Python module cannot be used; 7: the picture cannot be written.
"""
import os

from pictures import BAD_INPUT, CANNOT_WRITE, USAGE, Parser, fail, load

LIGHT, GUIDES = ("radiance", "indirect"), ("albedo", "normal")


def channels(names, layer):
    """Indices of a layer's red, green and blue channel, or None if it is not there."""
    wanted = [f"{layer}.{c}" for c in "RGB"]
    return [names.index(w) for w in wanted] if all(w in names for w in wanted) else None


def main():
    parser = Parser(description=__doc__.split("\n")[0])
    parser.add_argument("noisy", help="EXR file with the layer, as `fovea render -o` writes it")
    parser.add_argument("denoised", help="EXR file to write")
    parser.add_argument("--layer", help="only this layer")
    options = parser.parse_args()
    if all(map(os.path.exists, (options.noisy, options.denoised))) and os.path.samefile(options.noisy, options.denoised):
        fail(USAGE, f"`{options.denoised}` would be written over the file that is read; choose another name")
    oiio, oidn, numpy = load("OpenImageIO"), load("pyoidn"), load("numpy")
    picture = oiio.ImageBuf(options.noisy)
    if picture.has_error or not picture.spec().nchannels:
        fail(BAD_INPUT, f"`{options.noisy}` cannot be read: {picture.geterror()}")
    names, pixels = list(picture.spec().channelnames), picture.get_pixels(oiio.FLOAT)
    layers = [n for n in ([options.layer] if options.layer else LIGHT) if channels(names, n)]
    if not layers:
        fail(BAD_INPUT, f"`{options.noisy}` has no layer `{options.layer or 'radiance'}`, only the channels "
                        f"{', '.join(names)}")

    def layer(name):
        return numpy.ascontiguousarray(pixels[:, :, channels(names, name)])

    guides = {name: layer(name) for name in GUIDES if channels(names, name)}
    for name in layers:
        pixels[:, :, channels(names, name)] = oidn.denoise(layer(name), hdr=True, **guides)
    result = oiio.ImageBuf(picture.spec())
    result.set_pixels(picture.roi, pixels)
    if not result.write(options.denoised):
        fail(CANNOT_WRITE, f"`{options.denoised}` cannot be written: {result.geterror()}")


if __name__ == "__main__":
    main()
