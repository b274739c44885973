// What the materials of a scene say at the points of its surfaces, with everything that glTF says of them. Diffuse
// materials need none of this (passes/path-trace/surface_table.h).
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/rays/ray_scene.h"
#include "framework/scene/scene.h"
#include "passes/path-trace/bsdf.h"

namespace fovea::path_trace {

// Normals are on the side seen counter-clockwise.
struct SurfacePoint {
  glm::vec3 position{0};  // world space, m
  glm::vec3 face{0};      // geometric, unit
  glm::vec3 normal{0};    // of shading, unit: interpolated, then bent by the normal map
  BsdfParameters bsdf;
  glm::vec3 emission{0};  // radiance, W/(sr m^2); of an unlit material, its base colour
  bool unlit = false, doubleSided = false, glass = false;
  float coverage = 1;  // alpha of alphaMode BLEND: the share of light that the surface stops or reflects

  // The shading normal on the side of a viewer in the direction `out`, who sees the surface. Where a normal map, or
  // interpolation on a coarse mesh, turns it away from the viewer, it is bent back.
  glm::vec3 normalTowards(glm::vec3 out) const;
};

// Scene and geometry have to outlive it.
class Materials {
 public:
  Materials(const scene::Scene& scene, const scene::Geometry& geometry);

  SurfacePoint at(const scene::RayHit& hit) const;
  // Radiance times coverage at a point of a triangle; 0 for unlit materials, which are only seen.
  glm::vec3 emission(const scene::RayHit& hit) const;
  // Whether surfaces let a part of the light through, any of them or the one of a triangle.
  bool anyTransmits() const { return anyTransmits_; }
  bool transmits(uint32_t triangle) const;

 private:
  // The values of vertices at a hit.
  template <class T>
  T interpolated(const std::vector<T>& values, const scene::RayHit& hit) const;
  glm::vec4 texel(const scene::TextureUse& use, const scene::RayHit& hit) const;
  const scene::Material& materialOf(uint32_t triangle) const {
    return scene_.materials[geometry_.triangles[triangle].material()];
  }
  glm::vec3 tangent(const scene::RayHit& hit) const;
  glm::vec3 mappedNormal(const scene::Material& m, const scene::RayHit& hit, glm::vec3 normal) const;
  float coverage(const scene::Material& m, const scene::RayHit& hit) const;
  BsdfParameters bsdf(const scene::Material& m, const scene::RayHit& hit) const;

  const scene::Scene& scene_;
  const scene::Geometry& geometry_;
  std::vector<const AlbedoTable*> dielectricAlbedos_;  // one for each material
  const AlbedoTable *metalAlbedo_ = &AlbedoTable::schlick(), *coatAlbedo_ = &AlbedoTable::dielectric(1.5f);
  bool anyTransmits_ = false;
};

}  // namespace fovea::path_trace
