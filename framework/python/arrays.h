// Texels and elements as arrays of numpy.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <span>

#include "fovea/graph.h"

namespace fovea::python {

using ReadArray = nanobind::ndarray<nanobind::numpy, nanobind::ro>;
using WriteArray = nanobind::ndarray<nanobind::numpy>;

// The finest mip of an image as it is stored: layers or slices (if there can be several), rows, columns, channels; or
// the bytes of a buffer. Nothing is copied: `owner` keeps the memory. Throws Error(Usage) for packed formats.
ReadArray readView(const graph::ResourceDesc& desc, std::span<const std::byte> bytes, nanobind::handle owner);
WriteArray writeView(const graph::ResourceDesc& desc, std::span<std::byte> bytes, nanobind::handle owner);

// The same as 32-bit floats, unless it is a buffer or an image of integers. Where the texels are no such floats, they
// are converted into memory of their own.
ReadArray floatView(const graph::ResourceDesc& desc, std::span<const std::byte> bytes,
                    nanobind::handle owner);

// Name of the type of numpy ("float16") and shape of what readView() returns.
std::string typeName(const graph::ResourceDesc& desc);
std::vector<size_t> shapeOf(const graph::ResourceDesc& desc);

}  // namespace fovea::python
