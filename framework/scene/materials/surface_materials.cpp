#include "framework/scene/materials/surface_materials.h"

#include <algorithm>
#include <cmath>

#include "framework/scene/materials/microfacets.h"
#include "framework/scene/materials/tangents.h"

namespace fovea::scene {
namespace {

constexpr float kLeastCosine = 0.01f;  // between the normal and the direction to the viewer

template <class T>
T interpolated(const std::vector<T>& list, const Triangle& t, float u, float v) {
  return list[t.v[0]] * (1.0f - u - v) + list[t.v[1]] * u + list[t.v[2]] * v;
}

}  // namespace

glm::vec3 normalTowards(const SurfacePoint& point, glm::vec3 out) {
  const glm::vec3 normal = glm::dot(point.face, out) > 0 ? point.normal : -point.normal;
  const float cosine = glm::dot(normal, out);
  return cosine < kLeastCosine ? glm::normalize(normal + (kLeastCosine - cosine) * out) : normal;
}

SurfaceMaterials::SurfaceMaterials(const Scene& scene, const Geometry& geometry)
    : scene_(scene), geometry_(geometry) {
  for (const Material& m : scene.materials) {
    dielectricAlbedos_.push_back(&AlbedoTable::dielectric(m.ior));
    anyTransmits_ = anyTransmits_ || letsLightThrough(m);
  }
}

SurfaceMaterials::Coordinates SurfaceMaterials::coordinates(const Triangle& t, float u, float v) const {
  Coordinates c;
  c.uv[0] = geometry_.uvs.empty() ? glm::vec2(0) : interpolated(geometry_.uvs, t, u, v);
  c.uv[1] = geometry_.secondUvs.empty() ? c.uv[0] : interpolated(geometry_.secondUvs, t, u, v);
  return c;
}

glm::vec4 SurfaceMaterials::texel(const TextureUse& use, const Coordinates& at) const {
  return sampleTexture(scene_, use, at.uv[use.set]);
}

glm::vec3 SurfaceMaterials::mappedNormal(const Material& m, const RayHit& hit, const Coordinates& at,
                                         glm::vec3 normal) const {
  if (!m.normalTexture || geometry_.tangents.empty()) return normal;
  const Triangle& triangle = geometry_.triangles[hit.triangle];
  const glm::vec3 a = geometry_.positions[triangle.v[0]];
  const TriangleTangents& tangents = geometry_.tangents[hit.triangle];
  glm::vec3 t = tangentAt(tangents, geometry_.positions[triangle.v[1]] - a,
                          geometry_.positions[triangle.v[2]] - a, hit.u, hit.v);
  t -= normal * glm::dot(normal, t);
  const float length = glm::length(t);
  if (!(length > 1e-6f)) return normal;
  t /= length;
  const glm::vec3 bitangent = tangents.bitangentSign * glm::cross(normal, t);
  glm::vec3 mapped = 2.0f * glm::vec3(texel(m.normalTexture, at)) - 1.0f;
  mapped.x *= m.normalScale;
  mapped.y *= m.normalScale;
  const glm::vec3 n = t * mapped.x + bitangent * mapped.y + normal * mapped.z;
  const float size = glm::length(n);
  return size > 1e-6f && std::isfinite(size) ? n / size : normal;
}

SurfacePoint SurfaceMaterials::at(const RayHit& hit) const {
  const SurfaceHit s = surfaceAt(geometry_, hit);
  const Triangle& triangle = geometry_.triangles[hit.triangle];
  const Material& m = scene_.materials[s.material];
  const Coordinates c = coordinates(triangle, hit.u, hit.v);
  SurfacePoint p;
  p.position = s.position;
  p.face = s.geometricNormal;
  p.normal = mappedNormal(m, hit, c, s.shadingNormal);
  p.doubleSided = m.doubleSided;
  p.unlit = m.unlit;
  if (m.blended) p.coverage = coverage(scene_, m, c.uv[0]);
  BsdfParameters& b = p.bsdf;
  b.baseColor = glm::vec3(m.baseColor) * glm::vec3(texel(m.baseColorTexture, c));
  if (!geometry_.colors.empty())
    b.baseColor *= glm::vec3(interpolated(geometry_.colors, triangle, hit.u, hit.v));
  b.baseColor = glm::min(b.baseColor, 1.0f);
  const glm::vec4 metalAndRoughness = texel(m.metallicRoughnessTexture, c);
  b.metallic = m.metallic * metalAndRoughness.b;
  b.roughness = m.roughness * metalAndRoughness.g;
  b.ior = m.ior;
  b.specularF90 = m.specular * texel(m.specularTexture, c).a;
  b.specularF0 =
      glm::min(normalReflectance(m.ior) * m.specularColor * glm::vec3(texel(m.specularColorTexture, c)),
               1.0f) *
      b.specularF90;
  if (m.transmission > 0) b.transmission = m.transmission * texel(m.transmissionTexture, c).r;
  if (m.clearcoat > 0) {
    b.clearcoat = m.clearcoat * texel(m.clearcoatTexture, c).r;
    b.clearcoatRoughness = m.clearcoatRoughness * texel(m.clearcoatRoughnessTexture, c).g;
  }
  b.metalAlbedo = metalAlbedo_;
  b.dielectricAlbedo = dielectricAlbedos_[s.material];
  b.coatAlbedo = coatAlbedo_;
  p.emission = m.unlit ? b.baseColor : m.emission * glm::vec3(texel(m.emissionTexture, c));
  return p;
}

glm::vec3 SurfaceMaterials::emission(uint32_t triangle, float u, float v) const {
  const Triangle& t = geometry_.triangles[triangle];
  const Material& m = scene_.materials[t.material()];
  if (m.unlit) return glm::vec3(0);
  const Coordinates c = coordinates(t, u, v);
  return m.emission * glm::vec3(texel(m.emissionTexture, c)) *
         (m.blended ? coverage(scene_, m, c.uv[0]) : 1.0f);
}

}  // namespace fovea::scene
