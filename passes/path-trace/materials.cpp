#include "passes/path-trace/materials.h"

#include <algorithm>
#include <cmath>

#include "passes/path-trace/microfacets.h"

namespace fovea::path_trace {
namespace {

using namespace scene;

constexpr float kLeastCosine = 0.01f;  // between the normal and the direction to the viewer

bool isTransparent(const Material& m) { return m.blended || m.transmission > 0; }

glm::vec3 unitOr(glm::vec3 v, glm::vec3 otherwise) {
  const float length = glm::length(v);
  return length > 1e-6f && std::isfinite(length) ? v / length : otherwise;
}

}  // namespace

glm::vec3 SurfacePoint::normalTowards(glm::vec3 out) const {
  const glm::vec3 n = glm::dot(face, out) > 0 ? normal : -normal;
  const float cosine = glm::dot(n, out);
  return cosine < kLeastCosine ? glm::normalize(n + (kLeastCosine - cosine) * out) : n;
}

Materials::Materials(const Scene& scene, const Geometry& geometry) : scene_(scene), geometry_(geometry) {
  for (const Material& m : scene.materials) {
    dielectricAlbedos_.push_back(&AlbedoTable::dielectric(m.ior));
    anyTransmits_ = anyTransmits_ || isTransparent(m);
  }
}

bool Materials::transmits(uint32_t triangle) const { return isTransparent(materialOf(triangle)); }

template <class T>
T Materials::interpolated(const std::vector<T>& values, const RayHit& hit) const {
  const uint32_t* v = geometry_.triangles[hit.triangle].v;
  return values[v[0]] * (1 - hit.u - hit.v) + values[v[1]] * hit.u + values[v[2]] * hit.v;
}

glm::vec4 Materials::texel(const TextureUse& use, const RayHit& hit) const {
  if (!use) return glm::vec4(1);
  const bool second = use.set == 1 && !geometry_.secondUvs.empty();
  const std::vector<glm::vec2>& uvs = second ? geometry_.secondUvs : geometry_.uvs;
  return sampleTexture(scene_, use, uvs.empty() ? glm::vec2(0) : interpolated(uvs, hit));
}

// From the corners' tangents, which TriangleTangents gives in terms of two edges and a normal.
glm::vec3 Materials::tangent(const RayHit& hit) const {
  const TriangleTangents& from = geometry_.tangents[hit.triangle];
  const TriangleVertices t = triangleVertices(geometry_, hit.triangle);
  const glm::vec3 b = t.positions[1] - t.positions[0], c = t.positions[2] - t.positions[0],
                  n = glm::cross(b, c);
  const glm::mat3 axes(b, c, n / std::sqrt(std::max(glm::length(n), 1e-30f)));
  const float weights[3] = {1 - hit.u - hit.v, hit.u, hit.v};
  glm::vec3 sum(0);
  for (int k = 0; k < 3; ++k) {
    const glm::vec3 corner = axes * from.corners[k];
    sum += weights[k] / std::max(glm::length(corner), 1e-30f) * corner;
  }
  return sum;
}

glm::vec3 Materials::mappedNormal(const Material& m, const RayHit& hit, glm::vec3 normal) const {
  if (!m.normalTexture || geometry_.tangents.empty()) return normal;
  const glm::vec3 along = tangent(hit), x = unitOr(along - normal * glm::dot(normal, along), glm::vec3(0));
  if (x == glm::vec3(0)) return normal;
  const glm::vec3 y = geometry_.tangents[hit.triangle].bitangentSign * glm::cross(normal, x),
                  mapped = 2.0f * glm::vec3(texel(m.normalTexture, hit)) - 1.0f;
  return unitOr(m.normalScale * (mapped.x * x + mapped.y * y) + mapped.z * normal, normal);
}

// As for alpha masks, the first texture coordinates count.
float Materials::coverage(const Material& m, const RayHit& hit) const {
  if (!m.blended) return 1;
  TextureUse use = m.baseColorTexture;
  use.set = 0;
  const float vertex = geometry_.colors.empty() ? 1.0f : interpolated(geometry_.colors, hit).a;
  return std::clamp(vertex * m.baseColor.a * texel(use, hit).a, 0.0f, 1.0f);
}

BsdfParameters Materials::bsdf(const Material& m, const RayHit& hit) const {
  BsdfParameters b;
  b.baseColor = glm::vec3(m.baseColor) * glm::vec3(texel(m.baseColorTexture, hit));
  if (!geometry_.colors.empty()) b.baseColor *= glm::vec3(interpolated(geometry_.colors, hit));
  b.baseColor = glm::min(b.baseColor, 1.0f);
  const glm::vec4 metallicRoughness = texel(m.metallicRoughnessTexture, hit);
  b.roughness = m.roughness * metallicRoughness.g;
  b.metallic = m.metallic * metallicRoughness.b;
  b.ior = m.ior;
  b.specularF90 = m.specular * texel(m.specularTexture, hit).a;
  const glm::vec3 specular = m.specularColor * glm::vec3(texel(m.specularColorTexture, hit));
  b.specularF0 = glm::min(normalReflectance(m.ior) * specular, 1.0f) * b.specularF90;
  if (m.transmission > 0) b.transmission = m.transmission * texel(m.transmissionTexture, hit).r;
  if (m.clearcoat > 0) {
    b.clearcoat = m.clearcoat * texel(m.clearcoatTexture, hit).r;
    b.clearcoatRoughness = m.clearcoatRoughness * texel(m.clearcoatRoughnessTexture, hit).g;
  }
  return b;
}

SurfacePoint Materials::at(const RayHit& hit) const {
  const SurfaceHit s = surfaceAt(geometry_, hit);
  const Material& m = scene_.materials[s.material];
  SurfacePoint p;
  p.position = s.position;
  p.face = s.geometricNormal;
  p.normal = mappedNormal(m, hit, s.shadingNormal);
  p.bsdf = bsdf(m, hit);
  p.bsdf.metalAlbedo = metalAlbedo_;
  p.bsdf.dielectricAlbedo = dielectricAlbedos_[s.material];
  p.bsdf.coatAlbedo = coatAlbedo_;
  p.emission = m.unlit ? p.bsdf.baseColor : m.emission * glm::vec3(texel(m.emissionTexture, hit));
  p.unlit = m.unlit;
  p.doubleSided = m.doubleSided;
  p.glass = m.transmission > 0;
  p.coverage = coverage(m, hit);
  return p;
}

glm::vec3 Materials::emission(const RayHit& hit) const {
  const Material& m = materialOf(hit.triangle);
  if (m.unlit || m.emission == glm::vec3(0)) return glm::vec3(0);
  return m.emission * glm::vec3(texel(m.emissionTexture, hit)) * coverage(m, hit);
}

}  // namespace fovea::path_trace
