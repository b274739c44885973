// Converts accessors to plain arrays: strides, component types, normalised integers, sparse substitution.
#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>

#include "framework/scene/gltf/internal.h"

namespace fovea::scene::gltf {
namespace {

// A run of elements inside a buffer, or of zeros.
struct Span {
  const uint8_t* data = nullptr;
  size_t stride = 0;
};

size_t componentBytes(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    default:
      return 4;
  }
}

template <class T>
T load(const uint8_t* p) {
  T v;
  std::memcpy(&v, p, sizeof v);  // unaligned offsets are common in old files
  return v;
}

// glTF 2.0, 3.11: f = max(c / 127, -1), and likewise for the other types.
float component(const uint8_t* p, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const float v = load<int8_t>(p);
      return normalized ? std::max(v / 127.0f, -1.0f) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
      const float v = load<uint8_t>(p);
      return normalized ? v / 255.0f : v;
    }
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const float v = load<int16_t>(p);
      return normalized ? std::max(v / 32767.0f, -1.0f) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const float v = load<uint16_t>(p);
      return normalized ? v / 65535.0f : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return float(load<uint32_t>(p));
    default:
      return load<float>(p);
  }
}

uint32_t integer(const uint8_t* p, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<uint8_t>(p);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<uint16_t>(p);
    default:
      return load<uint32_t>(p);
  }
}

// Second line of defence after checkDocument, on what tinygltf has actually loaded.
Span span(const Context& c, int view, size_t offset, size_t count, size_t bytes, bool strided,
          const std::string& path) {
  const tinygltf::BufferView& v = c.model.bufferViews.at(size_t(view));
  const auto& buffer = c.model.buffers.at(size_t(v.buffer)).data;
  const size_t stride = strided && v.byteStride != 0 ? v.byteStride : bytes;
  const size_t begin = v.byteOffset + offset;
  if (count == 0 || stride < bytes || begin > buffer.size() || bytes > buffer.size() - begin ||
      (count - 1) > (buffer.size() - begin - bytes) / stride)
    c.fail(path, "the accessor reaches past the end of its buffer");
  return {buffer.data() + begin, stride};
}

const char* typeName(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return "SCALAR";
    case TINYGLTF_TYPE_VEC2:
      return "VEC2";
    case TINYGLTF_TYPE_VEC3:
      return "VEC3";
    case TINYGLTF_TYPE_VEC4:
      return "VEC4";
    case TINYGLTF_TYPE_MAT4:
      return "MAT4";
    default:
      return "another type";
  }
}

struct SparseView {
  Span indices, values;
  size_t count = 0;
};

SparseView sparseView(const Context& c, const tinygltf::Accessor& a, size_t bytes, const std::string& path) {
  SparseView s;
  s.count = size_t(std::max(a.sparse.count, 0));
  s.indices = span(c, a.sparse.indices.bufferView, size_t(a.sparse.indices.byteOffset), s.count,
                   componentBytes(a.sparse.indices.componentType), false, path + ".sparse.indices");
  s.values = span(c, a.sparse.values.bufferView, size_t(a.sparse.values.byteOffset), s.count, bytes, false,
                  path + ".sparse.values");
  return s;
}

size_t sparseIndex(const Context& c, const tinygltf::Accessor& a, const SparseView& s, size_t i,
                   const std::string& path) {
  const uint32_t index = integer(s.indices.data + i * s.indices.stride, a.sparse.indices.componentType);
  if (index >= a.count)
    c.fail(path + ".sparse.indices", "index " + std::to_string(index) + " of an accessor with " +
                                         std::to_string(a.count) + " elements");
  return index;
}

}  // namespace

std::vector<float> readFloats(const Context& c, int accessor, int components, const std::string& path) {
  const tinygltf::Accessor& a = c.model.accessors.at(size_t(accessor));
  if (a.count == 0) c.fail(path, "the accessor has no elements that can be read");
  const int expected = components == 16  ? TINYGLTF_TYPE_MAT4
                       : components == 1 ? TINYGLTF_TYPE_SCALAR
                                         : components;
  if (a.type != expected)
    c.fail(path,
           std::string("expected an accessor of ") + typeName(expected) + ", found " + typeName(a.type));
  const size_t size = componentBytes(a.componentType), bytes = size * size_t(components);
  std::vector<float> out(a.count * size_t(components), 0.0f);
  const auto copy = [&](const uint8_t* from, size_t element) {
    for (int k = 0; k < components; ++k)
      out[element * size_t(components) + size_t(k)] =
          component(from + size_t(k) * size, a.componentType, a.normalized);
  };
  if (a.bufferView >= 0) {
    const Span s = span(c, a.bufferView, a.byteOffset, a.count, bytes, true, path);
    for (size_t i = 0; i < a.count; ++i) copy(s.data + i * s.stride, i);
  }
  if (a.sparse.isSparse) {
    const SparseView s = sparseView(c, a, bytes, path);
    for (size_t i = 0; i < s.count; ++i)
      copy(s.values.data + i * s.values.stride, sparseIndex(c, a, s, i, path));
  }
  return out;
}

std::vector<uint32_t> readIndices(const Context& c, int accessor, const std::string& path) {
  const tinygltf::Accessor& a = c.model.accessors.at(size_t(accessor));
  if (a.type != TINYGLTF_TYPE_SCALAR || (a.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                                         a.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                                         a.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
    c.fail(path, std::string("indices must be unsigned SCALARs, found ") + typeName(a.type) +
                     " of component type " + std::to_string(a.componentType));
  const size_t bytes = componentBytes(a.componentType);
  std::vector<uint32_t> out(a.count, 0);
  if (a.bufferView >= 0) {
    const Span s = span(c, a.bufferView, a.byteOffset, a.count, bytes, true, path);
    for (size_t i = 0; i < a.count; ++i) out[i] = integer(s.data + i * s.stride, a.componentType);
  }
  if (a.sparse.isSparse) {
    const SparseView s = sparseView(c, a, bytes, path);
    for (size_t i = 0; i < s.count; ++i)
      out[sparseIndex(c, a, s, i, path)] = integer(s.values.data + i * s.values.stride, a.componentType);
  }
  return out;
}

}  // namespace fovea::scene::gltf
