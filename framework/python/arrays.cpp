#include "framework/python/arrays.h"

#include <memory>
#include <vector>

#include "fovea/error.h"
#include "framework/gpu/format.h"

namespace fovea::python {

namespace nb = nanobind;
using graph::ResourceDesc;
using graph::ResourceKind;

namespace {

using Code = nb::dlpack::dtype_code;

nb::dlpack::dtype dtype(Code code, uint32_t bits) { return {uint8_t(code), uint8_t(bits), 1}; }

// The type of a channel. Throws Error(Usage) for formats whose channels share bytes.
nb::dlpack::dtype channelType(const ResourceDesc& desc) {
  if (desc.kind == ResourceKind::Buffer) return dtype(Code::UInt, 8);
  using Type = gpu::FormatInfo::Type;
  const gpu::FormatInfo& format = gpu::formatInfo(desc.format);
  const uint32_t bits = 8 * format.bytesPerTexel / format.channels;
  const bool whole = (bits == 8 || bits == 16 || bits == 32) && format.bytesPerTexel % format.channels == 0;
  if (!whole || (format.type == Type::Float && bits < 16))
    throw Error(ExitCode::Usage,
                "texels of the format " + std::string(format.name) + " are no array of numbers",
                "read an image with whole bytes for each channel");
  if (format.type == Type::Float) return dtype(Code::Float, bits);
  const bool negative = format.type == Type::Snorm || format.type == Type::Sint;
  return dtype(negative ? Code::Int : Code::UInt, bits);
}

std::span<const std::byte> finestMip(const ResourceDesc& desc, std::span<const std::byte> bytes) {
  if (desc.kind == ResourceKind::Buffer) return bytes;
  return bytes.first(size_t(desc.width) * desc.height * desc.depth * desc.layers *
                     gpu::formatInfo(desc.format).bytesPerTexel);
}

}  // namespace

std::vector<size_t> shapeOf(const ResourceDesc& desc) {
  if (desc.kind == ResourceKind::Buffer) return {size_t(desc.stride * desc.count)};
  std::vector<size_t> shape;
  if (desc.volume) shape.push_back(desc.depth);
  if (desc.array || desc.layers > 1) shape.push_back(desc.layers);
  shape.insert(shape.end(), {desc.height, desc.width, gpu::formatInfo(desc.format).channels});
  return shape;
}

std::string typeName(const ResourceDesc& desc) {
  const nb::dlpack::dtype type = channelType(desc);
  const char* kind = type.code == uint8_t(Code::Float) ? "float"
                     : type.code == uint8_t(Code::Int) ? "int"
                                                       : "uint";
  return kind + std::to_string(int(type.bits));
}

ReadArray readView(const ResourceDesc& desc, std::span<const std::byte> bytes, nb::handle owner) {
  const std::vector<size_t> shape = shapeOf(desc);
  return ReadArray(bytes.data(), shape.size(), shape.data(), owner, nullptr, channelType(desc));
}

WriteArray writeView(const ResourceDesc& desc, std::span<std::byte> bytes, nb::handle owner) {
  const std::vector<size_t> shape = shapeOf(desc);
  return WriteArray(bytes.data(), shape.size(), shape.data(), owner, nullptr, channelType(desc));
}

ReadArray floatView(const ResourceDesc& desc, std::span<const std::byte> bytes, nb::handle owner) {
  if (desc.kind == ResourceKind::Buffer) return readView(desc, bytes, owner);
  const gpu::FormatInfo& format = gpu::formatInfo(desc.format);
  const bool floats =
      format.type == gpu::FormatInfo::Type::Float && format.bytesPerTexel == 4 * format.channels;
  if (floats || format.integer()) return readView(desc, bytes, owner);
  auto texels =
      std::make_unique<std::vector<float>>(gpu::texelsToFloats(desc.format, finestMip(desc, bytes)));
  const float* data = texels->data();
  const nb::capsule keeper(texels.release(),
                           [](void* p) noexcept { delete static_cast<std::vector<float>*>(p); });
  const std::vector<size_t> shape = shapeOf(desc);
  return ReadArray(data, shape.size(), shape.data(), keeper, nullptr, dtype(Code::Float, 32));
}

}  // namespace fovea::python
