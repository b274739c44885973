#include "framework/scene/subdivision/cage_builder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "framework/base/json.h"

namespace fovea::scene {
namespace {

uint32_t bitsOf(float v) { return std::bit_cast<uint32_t>(v + 0.0f); }  // -0 is 0

// Normal times twice the area (Newell) of a polygon that need not be flat.
glm::dvec3 areaVector(const SubdivisionCage& cage, size_t first, uint32_t size) {
  glm::dvec3 sum(0.0);
  for (uint32_t k = 0; k < size; ++k)
    sum += glm::cross(glm::dvec3(cage.positions[cage.faceVertices[first + k]]),
                      glm::dvec3(cage.positions[cage.faceVertices[first + (k + 1) % size]]));
  return sum;
}

}  // namespace

std::optional<uint32_t> readLightLevel(json::ObjectReader& r, std::string_view key, uint32_t level) {
  const json::Value* v = r.find(key);
  if (!v) return std::nullopt;
  if (v->isInt() && v->integer >= 0 && v->integer <= int64_t(level)) return uint32_t(v->integer);
  r.diagnostics().error(
      v->where.location(), r.pathOf(key),
      "`" + std::string(key) + "`: expected a whole number from 0 to " + std::to_string(level) +
          ", the picture's level, found " + v->describe(),
      "voxels and maps of secondary lights may see a coarser surface than the picture shows, not a "
      "finer one; leave it out for the same");
  return std::nullopt;
}

size_t CageBuilder::Hash::operator()(const Key& k) const {
  uint64_t h = 0;
  for (uint32_t b : k.bits) h = (h ^ b) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
  return size_t(h);
}

void CageBuilder::begin(const Primitive& primitive) {
  primitive_ = &primitive;
  points_.assign(primitive.positions.size(), kNoIndex);
  uvs_.assign(primitive.positions.size(), kNoIndex);
}

void CageBuilder::face(std::span<const uint32_t> vertices) {
  cage_.faceSizes.push_back(uint32_t(vertices.size()));
  cage_.faceMaterials.push_back(primitive_->material);
  for (uint32_t v : vertices) {
    cage_.faceVertices.push_back(pointOf(v));
    cage_.faceUvs.push_back(uvOf(v));
  }
}

uint32_t CageBuilder::pointOf(uint32_t vertex) {
  if (points_[vertex] != kNoIndex) return points_[vertex];
  const Primitive& p = *primitive_;
  const glm::vec3& at = p.positions[vertex];
  const auto [found, isNew] =
      known_.try_emplace(Key{{bitsOf(at.x), bitsOf(at.y), bitsOf(at.z)}}, uint32_t(cage_.positions.size()));
  points_[vertex] = found->second;
  if (!isNew) return found->second;
  cage_.positions.push_back(at);
  if (cage_.targets.size() < p.targets.size()) cage_.targets.resize(p.targets.size());
  for (size_t t = 0; t < cage_.targets.size(); ++t) {
    std::vector<glm::vec3>& moved = cage_.targets[t].positions;
    moved.resize(cage_.positions.size(), glm::vec3(0.0f));
    if (t < p.targets.size() && vertex < p.targets[t].positions.size())
      moved.back() = p.targets[t].positions[vertex];
  }
  if (vertex < p.joints.size() && vertex < p.weights.size()) {
    cage_.joints.resize(cage_.positions.size() - 1, glm::u16vec4(0));
    cage_.joints.push_back(p.joints[vertex]);
    cage_.weights.resize(cage_.positions.size() - 1, glm::vec4(1, 0, 0, 0));
    cage_.weights.push_back(p.weights[vertex]);
  }
  return found->second;
}

uint32_t CageBuilder::uvOf(uint32_t vertex) {
  if (uvs_[vertex] != kNoIndex) return uvs_[vertex];
  const glm::vec2 uv = vertex < primitive_->uvs.size() ? primitive_->uvs[vertex] : glm::vec2(0.0f);
  const auto [found, isNew] =
      knownUvs_.try_emplace(Key{{points_[vertex], bitsOf(uv.x), bitsOf(uv.y)}}, uint32_t(cage_.uvs.size()));
  if (isNew) cage_.uvs.push_back(uv);
  return uvs_[vertex] = found->second;
}

SubdivisionCage CageBuilder::take() {
  SubdivisionCage cage = std::exchange(cage_, {});
  const size_t points = cage.positions.size();
  for (MorphTarget& t : cage.targets) t.positions.resize(points, glm::vec3(0.0f));
  if (!cage.joints.empty()) {
    cage.joints.resize(points, glm::u16vec4(0));
    cage.weights.resize(points, glm::vec4(1, 0, 0, 0));
  }
  if (std::all_of(cage.uvs.begin(), cage.uvs.end(), [](glm::vec2 uv) { return uv == glm::vec2(0.0f); })) {
    cage.uvs.clear();
    cage.faceUvs.clear();
  }
  known_.clear();
  knownUvs_.clear();
  return cage;
}

void creaseByAngle(SubdivisionCage& cage, float degrees) {
  const double limit = std::cos(glm::radians(double(degrees)));
  std::unordered_map<uint64_t, glm::dvec3> normals;  // normal of the face to the left of each directed edge
  size_t first = 0;
  for (size_t f = 0; f < cage.faceSizes.size(); first += cage.faceSizes[f++]) {
    const uint32_t size = cage.faceSizes[f];
    const glm::dvec3 area = areaVector(cage, first, size);
    const double length = glm::length(area);
    for (uint32_t k = 0; k < size; ++k) {
      const uint32_t a = cage.faceVertices[first + k], b = cage.faceVertices[first + (k + 1) % size];
      if (length > 0) normals[uint64_t(a) << 32 | b] = area / length;
      const auto other = normals.find(uint64_t(b) << 32 | a);
      if (length > 0 && other != normals.end() && glm::dot(other->second, area / length) < limit)
        cage.creases.push_back({a, b, 10});
    }
  }
}

}  // namespace fovea::scene
