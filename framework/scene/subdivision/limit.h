// A refined cage: its vertices and triangles, and their limits for points or for weights of cage points.
// Private to framework/scene; the only header of OpenSubdiv's side.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "framework/scene/subdivision/subdivision.h"

namespace fovea::scene {

// A weighted sum of cage points, ascending.
struct SparseRow {
  std::vector<std::pair<uint32_t, float>> terms;
  void Clear() { terms.clear(); }  // the names that OpenSubdiv calls
  void AddWithWeight(const SparseRow& row, float weight);
};

class CageLimit {
 public:
  // The cage must have passed checkCage.
  explicit CageLimit(const SubdivisionCage& cage);
  ~CageLimit();

  // A point of the last level may have several sides: where creases still run at that level, one between each
  // two of them, with tangents of its own.
  struct Vertex {
    uint32_t point, side, uv;
  };
  struct Part {
    uint32_t material = 0;
    std::vector<Vertex> vertices;        // each once, in the order in which the triangles name them
    std::vector<uint32_t> indices;       // into vertices
    std::vector<uint32_t> lightIndices;  // likewise, of the cage's lightLevel; empty: none of its own
  };
  const std::vector<Part>& parts() const { return parts_; }

  template <class Value>
  struct Limits {
    std::vector<Value> positions;             // a point
    std::vector<Value> tangentsA, tangentsB;  // a side; a x b points outwards
  };
  struct Surface : Limits<glm::vec3> {
    std::vector<glm::vec2> uvs;
  };
  Surface surface(const std::vector<glm::vec3>& points, const std::vector<glm::vec2>& uvs) const;
  using Rows = Limits<SparseRow>;
  Rows rows() const;

 private:
  struct Refined;  // what needs OpenSubdiv's headers
  std::unique_ptr<Refined> refined_;
  std::vector<Part> parts_;
};

}  // namespace fovea::scene
