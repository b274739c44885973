// Decodes the buffer views that EXT_meshopt_compression compresses.
#include <meshoptimizer.h>
#include <tiny_gltf.h>

#include "framework/scene/gltf/internal.h"

namespace fovea::scene::gltf {
namespace {

size_t numberIn(const json::Value& extension, std::string_view key) {
  const json::Value* v = extension.find(key);
  return v ? size_t(v->integer) : 0;
}

std::string textIn(const json::Value& extension, std::string_view key) {
  const json::Value* v = extension.find(key);
  return v ? v->string : "";
}

// Whether all of the stream could be decoded. `checkDocument` has seen that mode, filter, count and stride fit together.
bool decode(const json::Value& extension, std::span<const uint8_t> stream, std::vector<unsigned char>& out) {
  const size_t count = numberIn(extension, "count"), stride = numberIn(extension, "byteStride");
  out.resize(count * stride);
  const std::string mode = textIn(extension, "mode");
  if (mode == "TRIANGLES")
    return meshopt_decodeIndexBuffer(out.data(), count, stride, stream.data(), stream.size()) == 0;
  if (mode == "INDICES")
    return meshopt_decodeIndexSequence(out.data(), count, stride, stream.data(), stream.size()) == 0;
  if (meshopt_decodeVertexBuffer(out.data(), count, stride, stream.data(), stream.size()) != 0) return false;
  const std::string filter = textIn(extension, "filter");
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), count, stride);
  return true;
}

}  // namespace

std::span<const uint8_t> bytesOf(const tinygltf::Model& model, size_t buffer, size_t offset, size_t length) {
  const std::vector<unsigned char>& data = model.buffers.at(buffer).data;
  if (offset > data.size() || length > data.size() - offset)
    throw Error(ExitCode::Internal, "a buffer of the model is shorter than it was");
  return {data.data() + offset, length};
}

std::span<const uint8_t> bytesOf(const tinygltf::Model& model, int bufferView) {
  const tinygltf::BufferView& v = model.bufferViews.at(size_t(bufferView));
  return bytesOf(model, size_t(v.buffer), v.byteOffset, v.byteLength);
}

int addBuffer(tinygltf::Model& model, std::vector<unsigned char> bytes) {
  model.buffers.emplace_back().data = std::move(bytes);
  return int(model.buffers.size() - 1);
}

void decodeBufferViews(const Source& source, const json::Value& root, tinygltf::Model& model) {
  for (size_t i = 0; i < model.bufferViews.size(); ++i) {
    const json::Value* e = extensionOf(&root.find("bufferViews")->items[i], kMeshopt);
    if (!e) continue;
    std::vector<unsigned char> bytes;
    if (!decode(
            *e,
            bytesOf(model, numberIn(*e, "buffer"), numberIn(*e, "byteOffset"), numberIn(*e, "byteLength")),
            bytes))
      throw Error(ExitCode::BadInput,
                  {{Severity::Error, e->where.location(), "bufferViews[" + std::to_string(i) + "]",
                    "the compressed data (" + std::string(kMeshopt) +
                        ") is damaged or cut short, or `count`, " + "`byteStride` or `mode` is wrong",
                    "compress " + source.name + " again, or export it uncompressed"}});
    model.bufferViews[i].buffer = addBuffer(model, std::move(bytes));
    model.bufferViews[i].byteOffset = 0;
  }
}

}  // namespace fovea::scene::gltf
