// A small model whose parts can be stored plainly or compressed.
#pragma once

#include <cmath>

#include "scene_support.h"

namespace fovea::test {

// A wavy square of `side` x `side` quads.
struct WavyGrid {
  std::vector<float> positions, normals, uvs;  // 3, 3 and 2 a vertex
  std::vector<uint32_t> indices;

  explicit WavyGrid(uint32_t side) {
    for (uint32_t y = 0; y <= side; ++y)
      for (uint32_t x = 0; x <= side; ++x) {
        const float u = float(x) / float(side), v = float(y) / float(side);
        const float slope = 1.2f * std::cos(6 * u), length = std::sqrt(slope * slope + 1);
        positions.insert(positions.end(), {u, 0.2f * std::sin(6 * u), v});
        normals.insert(normals.end(), {-slope / length, 1 / length, 0});
        uvs.insert(uvs.end(), {u, 0.5f * v});
      }
    for (uint32_t y = 0; y < side; ++y)
      for (uint32_t x = 0; x < side; ++x) {
        const uint32_t a = y * (side + 1) + x, b = a + side + 1;
        indices.insert(indices.end(), {a, b, b + 1, a, b + 1, a + 1});
      }
  }
  size_t vertices() const { return positions.size() / 3; }
};

// Collects buffer views and accessors for a TriangleDocument.
class DocumentBuilder {
 public:
  // Appends data to the buffer and returns its place there.
  size_t append(const void* data, size_t size) {
    while (bytes_.size() % 4) bytes_ += '\0';
    const size_t at = bytes_.size();
    bytes_.append(static_cast<const char*>(data), size);
    return at;
  }

  // Returns the number of the view; `more` are further members and starts with a comma.
  int view(size_t buffer, size_t offset, size_t length, const std::string& more = {}) {
    return add(views_, viewCount_,
               R"({"buffer":)" + std::to_string(buffer) + R"(,"byteOffset":)" + std::to_string(offset) +
                   R"(,"byteLength":)" + std::to_string(length) + more + "}");
  }

  template <class T>
  int plainView(const std::vector<T>& values) {
    const size_t size = values.size() * sizeof(T);
    return view(0, append(values.data(), size), size);
  }

  // A view of -1 is absent.
  int accessor(int view, int componentType, size_t count, const std::string& type, bool normalized = false) {
    return add(accessors_, accessorCount_,
               (view < 0 ? "{" : R"({"bufferView":)" + std::to_string(view) + ",") + R"("componentType":)" +
                   std::to_string(componentType) + R"(,"count":)" + std::to_string(count) + R"(,"type":")" +
                   type + '"' + (normalized ? R"(,"normalized":true)" : "") + "}");
  }

  TriangleDocument document(const std::string& primitive) const {
    TriangleDocument d;
    d.bytes = bytes_;
    d.views = "[" + views_ + "]";
    d.accessors = "[" + accessors_ + "]";
    d.primitive = primitive;
    return d;
  }

 private:
  static int add(std::string& list, int& count, const std::string& item) {
    list += (list.empty() ? "" : ",") + item;
    return count++;
  }

  std::string bytes_, views_, accessors_;
  int viewCount_ = 0, accessorCount_ = 0;
};

inline TriangleDocument plainDocument(const WavyGrid& grid) {
  DocumentBuilder b;
  const size_t n = grid.vertices();
  const int position = b.accessor(b.plainView(grid.positions), 5126, n, "VEC3");
  const int normal = b.accessor(b.plainView(grid.normals), 5126, n, "VEC3");
  const int uv = b.accessor(b.plainView(grid.uvs), 5126, n, "VEC2");
  const int indices = b.accessor(b.plainView(grid.indices), 5125, grid.indices.size(), "SCALAR");
  return b.document(R"({"attributes":{"POSITION":)" + std::to_string(position) + R"(,"NORMAL":)" +
                    std::to_string(normal) + R"(,"TEXCOORD_0":)" + std::to_string(uv) + R"(},"indices":)" +
                    std::to_string(indices) + "}");
}

inline scene::Primitive primitiveOf(const TriangleDocument& document, bool binary = false) {
  TemporaryFolder folder;
  Diagnostics warnings;
  const scene::Scene s = binary ? loadText(folder, document.glb(), warnings, "model.glb")
                                : loadText(folder, document.json(), warnings);
  return s.meshes.at(0).primitives.at(0);
}

}  // namespace fovea::test
