// The plainest possible ray caster, in double precision, which rasterised visibility is compared with.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "framework/scene/frame.h"
#include "framework/scene/scene.h"

namespace fovea::test {

struct RayHit {
  double t = std::numeric_limits<double>::infinity();  // in units of the direction
  uint32_t triangle = scene::kNoIndex;
  double u = 0, v = 0;  // barycentric weights of the second and third vertex
  explicit operator bool() const { return triangle != scene::kNoIndex; }
};

struct RayOptions {
  bool cullSingleSided = false;  // back faces of single-sided materials are not there
  double tMin = 0, tMax = std::numeric_limits<double>::infinity();
};

// Nearest hit by trying every triangle (Moeller and Trumbore); holes of alpha-masked materials are open.
inline RayHit castRay(const scene::Scene& scene, const scene::Geometry& geometry, glm::dvec3 origin,
                      glm::dvec3 direction, const RayOptions& options = {}) {
  RayHit best;
  best.t = options.tMax;
  for (uint32_t i = 0; i < geometry.triangles.size(); ++i) {
    const scene::Triangle& triangle = geometry.triangles[i];
    const glm::dvec3 a(geometry.positions[triangle.v[0]]);
    const glm::dvec3 e1 = glm::dvec3(geometry.positions[triangle.v[1]]) - a;
    const glm::dvec3 e2 = glm::dvec3(geometry.positions[triangle.v[2]]) - a;
    const glm::dvec3 p = glm::cross(direction, e2);
    const double det = glm::dot(e1, p);  // > 0: the front is seen
    if (det == 0) continue;
    const scene::Material& material = scene.materials[triangle.material()];
    if (options.cullSingleSided && det < 0 && !material.doubleSided) continue;
    const glm::dvec3 s = origin - a;
    const double u = glm::dot(s, p) / det;
    if (u < 0 || u > 1) continue;
    const glm::dvec3 q = glm::cross(s, e1);
    const double v = glm::dot(direction, q) / det;
    if (v < 0 || u + v > 1) continue;
    const double t = glm::dot(e2, q) / det;
    if (t <= options.tMin || t >= best.t) continue;
    if (material.masked) {
      const glm::vec2 uv = geometry.uvs[triangle.v[0]] * float(1 - u - v) +
                           geometry.uvs[triangle.v[1]] * float(u) + geometry.uvs[triangle.v[2]] * float(v);
      if (scene::reflectance(scene, material, uv).a < material.alphaCutoff) continue;
    }
    best = {t, i, u, v};
  }
  return best;
}

// A vertex attribute at a hit.
template <class V>
V interpolate(const scene::Geometry& geometry, const std::vector<V>& values, const RayHit& hit) {
  const scene::Triangle& t = geometry.triangles[hit.triangle];
  return values[t.v[0]] * float(1 - hit.u - hit.v) + values[t.v[1]] * float(hit.u) +
         values[t.v[2]] * float(hit.v);
}

inline glm::dvec3 faceNormal(const scene::Geometry& geometry, uint32_t triangle) {
  const scene::Triangle& t = geometry.triangles[triangle];
  const glm::dvec3 a(geometry.positions[t.v[0]]), b(geometry.positions[t.v[1]]),
      c(geometry.positions[t.v[2]]);
  return glm::normalize(glm::cross(b - a, c - a));
}

// Adds a mesh of one quad a, b, c, d (counter-clockwise from the front, uv 0,0 1,0 1,1 0,1) as a static node.
inline void addQuad(scene::Scene& scene, uint32_t material, glm::vec3 a, glm::vec3 b, glm::vec3 c,
                    glm::vec3 d) {
  const glm::vec3 n = glm::normalize(glm::cross(b - a, c - a));
  scene::Primitive primitive;
  primitive.positions = {a, b, c, d};
  primitive.normals = {n, n, n, n};
  primitive.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  primitive.indices = {0, 1, 2, 0, 2, 3};
  primitive.material = material;
  scene::Node node;
  node.mesh = uint32_t(scene.meshes.size());
  scene.meshes.push_back({"quad", {primitive}});
  scene.nodes.push_back(node);
}

// Six outward quads.
inline void addBox(scene::Scene& scene, uint32_t material, glm::vec3 lo, glm::vec3 hi) {
  auto at = [&](int x, int y, int z) { return glm::vec3(x ? hi.x : lo.x, y ? hi.y : lo.y, z ? hi.z : lo.z); };
  addQuad(scene, material, at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
  addQuad(scene, material, at(1, 0, 0), at(0, 0, 0), at(0, 1, 0), at(1, 1, 0));
  addQuad(scene, material, at(1, 0, 1), at(1, 0, 0), at(1, 1, 0), at(1, 1, 1));
  addQuad(scene, material, at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0));
  addQuad(scene, material, at(0, 1, 1), at(1, 1, 1), at(1, 1, 0), at(0, 1, 0));
  addQuad(scene, material, at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
}

// 8x8 texels whose alpha is a checker of 0 and 1 in blocks of 2; the colour is a ramp.
inline scene::Texture checkerTexture() {
  scene::Texture texture;
  texture.name = "checker";
  texture.width = texture.height = 8;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const uint8_t alpha = (x / 2 + y / 2) % 2 ? 255 : 0;
      texture.rgba.insert(texture.rgba.end(), {uint8_t(20 * x + 40), uint8_t(20 * y + 40), 128, alpha});
    }
  return texture;
}

}  // namespace fovea::test
