// The materials of a scene at the points of its surfaces, with everything that glTF says of them. Diffuse materials
// need none of this (framework/scene/scene.h, reflectance()).
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "framework/scene/materials/bsdf.h"
#include "framework/scene/materials/passage.h"
#include "framework/scene/rays/ray_scene.h"
#include "framework/scene/scene.h"

namespace fovea::scene {

// A point of a surface. Normals are on the side seen counter-clockwise.
struct SurfacePoint {
  glm::vec3 position{0};  // world space, m
  glm::vec3 face{0};      // geometric, unit
  glm::vec3 normal{0};    // of shading, unit: interpolated, then bent by the normal map
  BsdfParameters bsdf;
  glm::vec3 emission{0};  // radiance, W/(sr m^2); of an unlit material, its base colour
  bool unlit = false, doubleSided = false;
  float coverage =
      1;  // the share of light that it stops with alphaMode BLEND; the rest goes straight through
};

// The shading normal on the side of a viewer in the direction `out`, who sees the surface. A normal map, or
// interpolation on a coarse mesh, may turn it away from the viewer; it is then bent back.
glm::vec3 normalTowards(const SurfacePoint& point, glm::vec3 out);

// Keeps references to both: they have to outlive it.
class SurfaceMaterials {
 public:
  SurfaceMaterials(const Scene& scene, const Geometry& geometry);

  SurfacePoint at(const RayHit& hit) const;
  // Radiance of the triangle at the barycentric weights u, v of its second and third vertex, times its coverage; 0 for
  // unlit materials, which are only seen.
  glm::vec3 emission(uint32_t triangle, float u, float v) const;
  // Whether light goes through any of them.
  bool anyTransmits() const { return anyTransmits_; }
  bool transmits(uint32_t triangle) const { return letsLightThrough(materialOf(triangle)); }
  bool isGlass(uint32_t triangle) const { return materialOf(triangle).transmission > 0; }

 private:
  struct Coordinates {  // texture coordinates at a point
    glm::vec2 uv[2];
  };
  const Material& materialOf(uint32_t triangle) const {
    return scene_.materials[geometry_.triangles[triangle].material()];
  }
  Coordinates coordinates(const Triangle& triangle, float u, float v) const;
  glm::vec4 texel(const TextureUse& use, const Coordinates& at) const;
  glm::vec3 mappedNormal(const Material& m, const RayHit& hit, const Coordinates& at, glm::vec3 normal) const;

  const Scene& scene_;
  const Geometry& geometry_;
  std::vector<const AlbedoTable*> dielectricAlbedos_;  // one for each material
  const AlbedoTable *metalAlbedo_ = &AlbedoTable::schlick(), *coatAlbedo_ = &AlbedoTable::dielectric(1.5f);
  bool anyTransmits_ = false;
};

}  // namespace fovea::scene
