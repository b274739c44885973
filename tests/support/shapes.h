// Small scenes whose light can be worked out by hand: quads, closed boxes, and spheres seen from inside.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "framework/scene/scene.h"

namespace fovea::test {

inline uint32_t addMaterial(scene::Scene& s, glm::vec3 rho) {
  scene::Material m;
  m.baseColor = glm::vec4(rho, 1);
  s.materials.push_back(m);
  return uint32_t(s.materials.size() - 1);
}

inline void addPrimitive(scene::Scene& s, scene::Primitive p) {
  scene::Mesh mesh;
  mesh.primitives.push_back(std::move(p));
  s.meshes.push_back(std::move(mesh));
  scene::Node node;
  node.mesh = uint32_t(s.meshes.size() - 1);
  s.nodes.push_back(node);
}

// Parallelogram corner, corner + u, corner + u + v, corner + v; its front is where cross(u, v) points. uv =
// (0,0) .. (1,1).
inline void addQuad(scene::Scene& s, uint32_t material, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
  scene::Primitive p;
  p.material = material;
  p.positions = {corner, corner + u, corner + u + v, corner + v};
  p.normals.assign(4, glm::normalize(glm::cross(u, v)));
  p.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  p.indices = {0, 1, 2, 0, 2, 3};
  addPrimitive(s, std::move(p));
}

// The inside of the cube |x|, |y|, |z| <= h: six quads that face inwards. The order of materials is -x +x -y +y -z +z.
inline void addRoom(scene::Scene& s, const uint32_t materials[6], float h) {
  const glm::vec3 x(2 * h, 0, 0), y(0, 2 * h, 0), z(0, 0, 2 * h), low(-h), high(h);
  addQuad(s, materials[0], low, y, z);
  addQuad(s, materials[1], high, -z, -y);
  addQuad(s, materials[2], low, z, x);
  addQuad(s, materials[3], high, -x, -z);
  addQuad(s, materials[4], low, x, y);
  addQuad(s, materials[5], high, -y, -x);
}

// A sphere seen from inside, with smooth normals that point to its centre.
inline void addHollowSphere(scene::Scene& s, uint32_t material, glm::vec3 centre, float radius,
                            uint32_t segments, uint32_t rings) {
  scene::Primitive p;
  p.material = material;
  for (uint32_t r = 0; r <= rings; ++r) {
    for (uint32_t i = 0; i < segments; ++i) {
      const float theta = glm::pi<float>() * float(r) / float(rings);
      const float phi = glm::two_pi<float>() * float(i) / float(segments);
      const glm::vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      p.positions.push_back(centre + radius * n);
      p.normals.push_back(-n);
      p.uvs.push_back(glm::vec2(0));
    }
  }
  for (uint32_t r = 0; r < rings; ++r) {
    for (uint32_t i = 0; i < segments; ++i) {
      const uint32_t j = (i + 1) % segments;
      const uint32_t a = r * segments + i, b = r * segments + j, c = a + segments, d = b + segments;
      if (r > 0) p.indices.insert(p.indices.end(), {a, c, b});
      if (r + 1 < rings) p.indices.insert(p.indices.end(), {b, c, d});
    }
  }
  addPrimitive(s, std::move(p));
}

inline scene::Light pointLight(glm::vec3 position, glm::vec3 candela) {
  scene::Light l;
  l.type = scene::LightType::Point;
  l.position = position;
  l.color = candela;
  return l;
}

inline scene::Light sun(glm::vec3 direction, glm::vec3 lux) {
  scene::Light l;
  l.type = scene::LightType::Directional;
  l.direction = glm::normalize(direction);
  l.color = lux;
  return l;
}

inline scene::Light spotLight(glm::vec3 position, glm::vec3 direction, float inner, float outer,
                              glm::vec3 candela) {
  scene::Light l;
  l.type = scene::LightType::Spot;
  l.position = position;
  l.direction = glm::normalize(direction);
  l.innerConeAngle = inner;
  l.outerConeAngle = outer;
  l.color = candela;
  return l;
}

}  // namespace fovea::test
