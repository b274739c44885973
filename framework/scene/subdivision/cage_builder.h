// Builds control cages from triangle meshes, whose vertices are split where normals or texture coordinates differ.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "framework/scene/subdivision/subdivision.h"

namespace fovea::json {
class ObjectReader;
}

namespace fovea::scene {

// Reads SubdivisionCage::lightLevel from a file that gives it beside the picture's `level`; mistakes go to
// the reader's diagnostics.
std::optional<uint32_t> readLightLevel(json::ObjectReader& r, std::string_view key, uint32_t level);

// Vertices in exactly the same place become one point of the cage, which takes the morph targets and joints of the
// first of them. Equal texture coordinates are merged. Vertices that no face uses are left out.
class CageBuilder {
 public:
  // The faces that follow belong to this primitive, which must outlive them.
  void begin(const Primitive& primitive);
  void face(std::span<const uint32_t> vertices);  // vertices of the primitive
  // The cage point of a vertex of the primitive; kNoIndex if no face uses the vertex.
  uint32_t point(uint32_t vertex) const { return vertex < points_.size() ? points_[vertex] : kNoIndex; }
  // Returns the cage without scheme, level, creases and corners. The cage is not checked; see checkCage.
  SubdivisionCage take();

 private:
  struct Key {
    uint32_t bits[3];
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    size_t operator()(const Key& k) const;
  };
  uint32_t pointOf(uint32_t vertex);
  uint32_t uvOf(uint32_t vertex);

  const Primitive* primitive_ = nullptr;
  SubdivisionCage cage_;
  std::unordered_map<Key, uint32_t, Hash> known_, knownUvs_;
  std::vector<uint32_t> points_, uvs_;  // for each vertex of the primitive
};

// Adds infinitely sharp creases along the edges between two faces whose planes enclose more than `degrees`. The cage
// must have passed checkCage.
void creaseByAngle(SubdivisionCage& cage, float degrees);

}  // namespace fovea::scene
