// Implements uniform refinement and the limit surface with OpenSubdiv; subdivision.h gives the rules.
#include "framework/scene/subdivision/subdivision.h"

#include <algorithm>
#include <cmath>

#include "fovea/error.h"
#include "framework/scene/subdivision/limit.h"

namespace fovea::scene {
namespace {

glm::vec3 unitNormal(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 n = glm::cross(a, b);
  const float length = glm::length(n);
  return length > 0.0f && std::isfinite(length) ? n / length : glm::vec3(0, 1, 0);
}

[[noreturn]] void fail(const std::string& what, const CageProblem& p) {
  throw Error(ExitCode::BadInput, what + (p.place.empty() ? "" : ": " + p.place) + ": " + p.message,
              p.remedy);
}

void requireGood(const std::string& what, const SubdivisionCage& cage) {
  const std::vector<CageProblem> problems = checkCage(cage);
  if (!problems.empty()) fail(what, problems.front());
}

std::vector<Primitive> refineChecked(const SubdivisionCage& cage) {
  const CageLimit limit(cage);
  const CageLimit::Surface surface = limit.surface(cage.positions, cage.uvs);
  std::vector<Primitive> primitives;
  for (const CageLimit::Part& part : limit.parts()) {
    Primitive& p = primitives.emplace_back();
    p.material = part.material;
    p.indices = part.indices;
    p.lightIndices = part.lightIndices;
    p.positions.reserve(part.vertices.size());
    p.normals.reserve(part.vertices.size());
    for (const CageLimit::Vertex& v : part.vertices) {
      p.positions.push_back(surface.positions[v.point]);
      p.normals.push_back(unitNormal(surface.tangentsA[v.side], surface.tangentsB[v.side]));
      p.uvs.push_back(surface.uvs.empty() ? glm::vec2(0.0f) : surface.uvs[v.uv]);
    }
  }
  return primitives;
}

}  // namespace

std::vector<Primitive> refine(const SubdivisionCage& cage) {
  requireGood("subdivision cage", cage);
  return refineChecked(cage);
}

void refineCages(Scene& scene) {
  // A few bytes of a file can require more memory than any machine has.
  constexpr uint64_t kMaxOfScene = uint64_t(1) << 24;
  uint64_t triangles = 0;
  for (Mesh& mesh : scene.meshes) {
    if (!mesh.cage || !mesh.primitives.empty()) continue;
    const std::string what = "mesh `" + mesh.name + "`: subdivision cage";
    requireGood(what, *mesh.cage);
    triangles += refinedTriangles(*mesh.cage);
    if (triangles > kMaxOfScene)
      fail(what,
           {"level", "the cages of the scene make more than " + std::to_string(kMaxOfScene) + " triangles",
            "lower their levels"});
    for (uint32_t material : mesh.cage->faceMaterials)
      if (material >= scene.materials.size())
        fail(what, {"faceMaterials",
                    "material " + std::to_string(material) + ", but there are only " +
                        std::to_string(scene.materials.size()),
                    ""});
    mesh.primitives = refineChecked(*mesh.cage);
  }
}

Stencils::Stencils(const SubdivisionCage& cage) {
  requireGood("subdivision cage", cage);
  points_ = uint32_t(cage.positions.size());
  const CageLimit limit(cage);
  const CageLimit::Rows rows = limit.rows();
  std::vector<Range> rangeOfSide(rows.tangentsA.size(), Range{0, 0});
  // A dense array, cleared through the list of touched entries.
  std::vector<glm::vec3> sums(points_, glm::vec3(0.0f));
  std::vector<uint32_t> touched;
  const auto add = [&](const SparseRow& row, int component) {
    for (const auto& [point, weight] : row.terms) {
      if (sums[point] == glm::vec3(0.0f)) touched.push_back(point);
      sums[point][component] += weight;
    }
  };
  for (const CageLimit::Part& part : limit.parts()) {
    for (const CageLimit::Vertex& v : part.vertices) {
      Range& range = rangeOfSide[v.side];
      if (range.count == 0) {
        add(rows.positions[v.point], 0);
        add(rows.tangentsA[v.side], 1);
        add(rows.tangentsB[v.side], 2);
        std::sort(touched.begin(), touched.end());
        touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
        range.first = uint32_t(entries_.size());
        for (uint32_t point : touched) {
          if (sums[point] != glm::vec3(0.0f))
            entries_.push_back({sums[point].x, sums[point].y, sums[point].z, point});
          sums[point] = glm::vec3(0.0f);
        }
        range.count = uint32_t(entries_.size()) - range.first;
        touched.clear();
      }
      ranges_.push_back(range);
    }
  }
}

void Stencils::evaluate(std::span<const glm::vec3> points, std::span<glm::vec3> positions,
                        std::span<glm::vec3> normals) const {
  if (points.size() != points_ || positions.size() != ranges_.size() || normals.size() != ranges_.size())
    throw Error(ExitCode::Internal,
                "stencils of " + std::to_string(points_) + " points and " + std::to_string(ranges_.size()) +
                    " vertices were given arrays of " + std::to_string(points.size()) + ", " +
                    std::to_string(positions.size()) + " and " + std::to_string(normals.size()));
  for (size_t v = 0; v < ranges_.size(); ++v) {
    glm::vec3 position(0.0f), a(0.0f), b(0.0f);
    for (uint32_t i = ranges_[v].first; i < ranges_[v].first + ranges_[v].count; ++i) {
      const Entry& e = entries_[i];
      position += e.position * points[e.point];
      a += e.tangentA * points[e.point];
      b += e.tangentB * points[e.point];
    }
    positions[v] = position;
    normals[v] = unitNormal(a, b);
  }
}

}  // namespace fovea::scene
