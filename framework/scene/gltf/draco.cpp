// Decodes the primitives that KHR_draco_mesh_compression compresses.
#include <tiny_gltf.h>

#include "framework/scene/gltf/internal.h"

#if FOVEA_DRACO
#include <draco/compression/decode.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <set>
#include <type_traits>
#endif

namespace fovea::scene::gltf {

#if FOVEA_DRACO
namespace {

// Ten times what a flat regular grid, the mesh that compresses best, decodes to.
constexpr uint64_t kMaxBytesPerByte = 4096;

// Looks at what a stream claims before memory is allocated for it: at the counts before the connectivity is decoded, and
// at the attributes before their values are.
template <class Base>
class CheckedDecoder : public Base {
 public:
  explicit CheckedDecoder(uint64_t maxBytes) : maxBytes_(maxBytes) {}
  const std::string& problem() const { return problem_; }

 protected:
  bool DecodeConnectivity() override {
    if (this->bitstream_version() != DRACO_BITSTREAM_VERSION(2, 2))
      return refuse("is not of version 2.2 of the bit stream, which glTF wants");
    draco::DecoderBuffer ahead = *this->buffer();
    uint32_t counts[2] = {0, 0};
    for (uint32_t& count : counts)
      if (!draco::DecodeVarint(&count, &ahead)) return refuse("ends before its counts");
    // The other count is that of vertices, which is at most three for each triangle.
    const uint32_t triangles = counts[std::is_same_v<Base, draco::MeshEdgebreakerDecoder> ? 1 : 0];
    bytes_ = 12 * uint64_t(triangles);
    if (bytes_ > maxBytes_)
      return refuse("cannot hold the " + std::to_string(triangles) + " triangles that it claims");
    return Base::DecodeConnectivity();
  }

  bool DecodeAllAttributes() override {
    const draco::PointCloud& mesh = *this->point_cloud();
    for (int i = 0; i < mesh.num_attributes(); ++i)
      bytes_ +=
          uint64_t(mesh.num_points()) * uint64_t(std::max<int64_t>(mesh.attribute(i)->byte_stride(), 0));
    if (bytes_ > maxBytes_) return refuse("cannot hold the attributes that it claims");
    return Base::DecodeAllAttributes();
  }

 private:
  bool refuse(std::string problem) {
    problem_ = std::move(problem);
    return false;
  }

  uint64_t maxBytes_, bytes_ = 0;  // decoded
  std::string problem_;
};

struct Decoded {
  std::unique_ptr<draco::Mesh> mesh = std::make_unique<draco::Mesh>();
  std::string problem;  // empty if there is none
};

template <class Base>
Decoded decodeWith(draco::DecoderBuffer& buffer) {
  Decoded out;
  CheckedDecoder<Base> decoder(kMaxBytesPerByte * uint64_t(buffer.remaining_size()));
  if (!decoder.Decode(draco::DecoderOptions(), &buffer, &*out.mesh).ok())
    out.problem = decoder.problem().empty() ? "is damaged or cut short" : decoder.problem();
  return out;
}

Decoded decode(std::span<const uint8_t> stream) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  draco::DecoderBuffer ahead = buffer;
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok()) return {nullptr, "is no Draco data"};
  if (header.encoder_type != draco::TRIANGULAR_MESH) return {nullptr, "holds no mesh"};
  return header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING
             ? decodeWith<draco::MeshEdgebreakerDecoder>(buffer)
             : decodeWith<draco::MeshSequentialDecoder>(buffer);
}

template <class T>
std::vector<unsigned char> valuesOf(const draco::PointAttribute& attribute, uint32_t points) {
  const size_t components = size_t(attribute.num_components());
  std::vector<unsigned char> bytes(points * components * sizeof(T));
  std::vector<T> value(components);
  for (uint32_t i = 0; i < points; ++i) {
    const draco::AttributeValueIndex at = attribute.mapped_index(draco::PointIndex(i));
    if (at.value() >= attribute.size() || !attribute.ConvertValue<T>(at, int8_t(components), value.data()))
      return {};
    std::memcpy(&bytes[i * components * sizeof(T)], value.data(), components * sizeof(T));
  }
  return bytes;
}

std::vector<unsigned char> valuesOf(const draco::PointAttribute& attribute, uint32_t points,
                                    int componentType) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return valuesOf<int8_t>(attribute, points);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return valuesOf<uint8_t>(attribute, points);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return valuesOf<int16_t>(attribute, points);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return valuesOf<uint16_t>(attribute, points);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return valuesOf<uint32_t>(attribute, points);
    default:
      return valuesOf<float>(attribute, points);
  }
}

class PrimitiveDecoder {
 public:
  PrimitiveDecoder(const Source& source, tinygltf::Model& model) : source_(source), model_(model) {}

  void run(const json::Value& written, const std::string& place, tinygltf::Primitive& primitive) {
    const json::Value& extension = *extensionOf(&written, kDraco);
    extension_ = &extension;
    place_ = place;
    const int view = int(extension.find("bufferView")->integer);
    const Decoded decoded = decode(bytesOf(model_, view));
    if (!decoded.problem.empty())
      fail("the data in bufferViews[" + std::to_string(view) + "] " + decoded.problem);
    const draco::Mesh& mesh = *decoded.mesh;
    for (const json::Member& a : extension.find("attributes")->members)
      setAttribute(mesh, a, primitive.attributes.at(a.key));
    if (const json::Value* indices = written.find("indices")) primitive.indices = int(indices->integer);
    setIndices(mesh, primitive);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ExitCode::BadInput, {{Severity::Error, extension_->where.location(), place_,
                                      "compressed with " + std::string(kDraco) + ": " + message,
                                      "compress " + source_.name + " again, or export it uncompressed"}});
  }

  // The accessor that gets decoded elements. Primitives with different data may have described it by one accessor.
  tinygltf::Accessor& take(int& accessor) {
    if (accessor < 0 || !taken_.insert(accessor).second) {
      model_.accessors.push_back(accessor < 0 ? tinygltf::Accessor() : model_.accessors[size_t(accessor)]);
      accessor = int(model_.accessors.size() - 1);
    }
    return model_.accessors[size_t(accessor)];
  }

  void setElements(tinygltf::Accessor& accessor, std::vector<unsigned char> bytes) {
    total_ += bytes.size();
    if (total_ > kMaxBufferBytes)
      fail("the model decodes to more than " + std::to_string(kMaxBufferBytes) + " bytes");
    tinygltf::BufferView view;
    view.byteLength = bytes.size();
    view.buffer = addBuffer(model_, std::move(bytes));
    model_.bufferViews.push_back(view);
    accessor.bufferView = int(model_.bufferViews.size() - 1);
    accessor.byteOffset = 0;
  }

  void setAttribute(const draco::Mesh& mesh, const json::Member& written, int& index) {
    const std::string name = written.key + ", accessors[" + std::to_string(index) + "], ";
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(uint32_t(written.value.integer));
    if (!attribute)
      fail(name + "there is no attribute " + std::to_string(written.value.integer) + " in the data");
    tinygltf::Accessor& accessor = take(index);
    if (accessor.count != mesh.num_points())
      fail(name + "has " + std::to_string(accessor.count) + " elements, the data " +
           std::to_string(mesh.num_points()));
    const int components = tinygltf::GetNumComponentsInType(uint32_t(accessor.type));
    if (components != attribute->num_components())
      fail(name + "is of another type than the data, which has " +
           std::to_string(attribute->num_components()) + " components");
    std::vector<unsigned char> bytes = valuesOf(*attribute, mesh.num_points(), accessor.componentType);
    if (bytes.empty()) fail(name + "has another componentType than the data");
    setElements(accessor, std::move(bytes));
  }

  void setIndices(const draco::Mesh& mesh, tinygltf::Primitive& primitive) {
    if (mesh.num_faces() == 0) fail("the data holds no triangles");
    const size_t count = 3 * size_t(mesh.num_faces());
    const std::string name = "indices, accessors[" + std::to_string(primitive.indices) + "], ";
    tinygltf::Accessor& accessor = take(primitive.indices);
    if (primitive.mode == TINYGLTF_MODE_TRIANGLES && accessor.count != 0 && accessor.count != count)
      fail(name + "has " + std::to_string(accessor.count) + " elements, the data " + std::to_string(count));
    std::vector<unsigned char> bytes(count * sizeof(uint32_t));
    for (uint32_t i = 0; i < mesh.num_faces(); ++i)
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t vertex = mesh.face(draco::FaceIndex(i))[k].value();
        std::memcpy(&bytes[(3 * i + k) * sizeof vertex], &vertex, sizeof vertex);
      }
    accessor.type = TINYGLTF_TYPE_SCALAR;
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    accessor.count = count;
    accessor.sparse.isSparse = false;
    setElements(accessor, std::move(bytes));
    primitive.mode = TINYGLTF_MODE_TRIANGLES;  // strips are decoded to triangles, too
  }

  const Source& source_;
  tinygltf::Model& model_;
  const json::Value* extension_ = nullptr;
  std::string place_;
  std::set<int> taken_;
  uint64_t total_ = 0;  // decoded bytes
};

}  // namespace

void decodePrimitives(const Source& source, const json::Value& root, tinygltf::Model& model) {
  PrimitiveDecoder decoder(source, model);
  for (size_t m = 0; m < model.meshes.size(); ++m) {
    const json::Value& written = *root.find("meshes")->items[m].find("primitives");
    std::vector<tinygltf::Primitive>& primitives = model.meshes[m].primitives;
    if (written.items.size() != primitives.size()) continue;  // buildMeshes() reports it
    for (size_t i = 0; i < primitives.size(); ++i)
      if (extensionOf(&written.items[i], kDraco))
        decoder.run(written.items[i],
                    nameOf("meshes", m, model.meshes[m].name) + ".primitives[" + std::to_string(i) + "]",
                    primitives[i]);
  }
}

#else

void decodePrimitives(const Source&, const json::Value&, tinygltf::Model&) {}

#endif

}  // namespace fovea::scene::gltf
