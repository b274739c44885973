#include "framework/scene/device/simplify.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <limits>

#include "fovea/error.h"

namespace fovea::scene {
namespace {

constexpr uint32_t kMaxIndex = 1u << 24;  // whole numbers up to this are exact in a float

bool isMasked(const Scene& scene, const Triangle& t) {
  return t.material() < scene.materials.size() && scene.materials[t.material()].masked;
}

// Index list of the opaque static triangles over vertices welded by position, so that seams of normals and
// texture coordinates do not stop the simplifier. Returns the welded positions.
std::vector<glm::vec3> weld(const Geometry& geometry, std::vector<uint32_t>& indices) {
  const size_t vertices = geometry.positions.size();
  std::vector<uint32_t> remap(vertices);
  const size_t unique = meshopt_generateVertexRemap(remap.data(), indices.data(), indices.size(),
                                                    geometry.positions.data(), vertices, sizeof(glm::vec3));
  std::vector<glm::vec3> positions(unique);
  meshopt_remapVertexBuffer(positions.data(), geometry.positions.data(), vertices, sizeof(glm::vec3),
                            remap.data());
  meshopt_remapIndexBuffer(indices.data(), indices.data(), indices.size(), remap.data());
  return positions;
}

}  // namespace

SimplifiedMesh simplify(const Scene& scene, const Geometry& geometry, float ratio) {
  SimplifiedMesh mesh;
  const Geometry::LightTriangles light = geometry.light();
  mesh.sourceTriangles = light.firstMoving - light.first;
  std::vector<uint32_t> indices;
  for (uint32_t i = light.first; i < light.firstMoving; ++i) {
    const Triangle& t = geometry.triangle(i);
    if (!isMasked(scene, t)) {
      indices.insert(indices.end(), t.v, t.v + 3);
      continue;
    }
    if (i + 1 >= kMaxIndex)
      throw Error(ExitCode::BadInput,
                  "scene " + scene.name + ": triangle " + std::to_string(i) +
                      " has an alpha mask past the 16,777,215 triangles a simplified mesh can name",
                  "use the technique `exact`");
    for (int k = 0; k < 3; ++k)
      mesh.corners.push_back(glm::vec4(geometry.positions[t.v[k]], k == 0 ? float(i + 1) : 0.0f));
  }
  if (indices.empty()) return mesh;

  const std::vector<glm::vec3> positions = weld(geometry, indices);
  if (ratio < 1.0f) {
    const size_t target = size_t(double(indices.size() / 3) * std::max(ratio, 0.0f)) * 3;
    float error = 0;
    const size_t left =
        meshopt_simplify(indices.data(), indices.data(), indices.size(), &positions[0].x, positions.size(),
                         sizeof(glm::vec3), target, std::numeric_limits<float>::max(), 0, &error);
    indices.resize(left);
    mesh.error = error * meshopt_simplifyScale(&positions[0].x, positions.size(), sizeof(glm::vec3));
  }
  for (uint32_t i : indices) mesh.corners.push_back(glm::vec4(positions[i], 0.0f));
  return mesh;
}

}  // namespace fovea::scene
