// A refined cage: its vertices and triangles, and their limits for points or for weights of cage points. Private to
// framework/scene. This header is the only interface to the code that uses OpenSubdiv.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "framework/scene/subdivision/subdivision.h"

namespace fovea::scene {

// A weighted sum of cage points, in ascending order of the points.
struct SparseRow {
  std::vector<std::pair<uint32_t, float>> terms;
  void Clear() { terms.clear(); }  // OpenSubdiv requires these names
  void AddWithWeight(const SparseRow& row, float weight);
};

class CageLimit {
 public:
  // The cage must have passed checkCage.
  explicit CageLimit(const SubdivisionCage& cage);
  ~CageLimit();

  // A point of the last level may have several sides. Where creases are still sharp at that level, each side lies
  // between two of them and has its own tangents.
  struct Vertex {
    uint32_t point, side, uv;
  };
  struct Part {
    uint32_t material = 0;
    std::vector<Vertex> vertices;        // each once, in the order of first use by the triangles
    std::vector<uint32_t> indices;       // into vertices
    std::vector<uint32_t> lightIndices;  // likewise, at the cage's lightLevel; empty if there is none
  };
  const std::vector<Part>& parts() const { return parts_; }

  template <class Value>
  struct Limits {
    std::vector<Value> positions;             // per point
    std::vector<Value> tangentsA, tangentsB;  // per side; a x b points outwards
  };
  struct Surface : Limits<glm::vec3> {
    std::vector<glm::vec2> uvs;
  };
  Surface surface(const std::vector<glm::vec3>& points, const std::vector<glm::vec2>& uvs) const;
  using Rows = Limits<SparseRow>;
  Rows rows() const;

 private:
  struct Refined;  // needs the headers of OpenSubdiv
  std::unique_ptr<Refined> refined_;
  std::vector<Part> parts_;
};

}  // namespace fovea::scene
