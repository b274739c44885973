// Where surfaces let light through, as a plain reference for shaders/materials/passage.glsl and
// shaders/rays/visibility.glsl.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "framework/base/random.h"
#include "framework/scene/frame.h"
#include "framework/scene/rays/ray_scene.h"
#include "passes/path-trace/albedo.h"
#include "passes/path-trace/microfacets.h"
#include "shaders/records/rays.h"
#include "shaders/records/scene.h"

namespace fovea::scene {

inline float meanChannel(glm::vec3 c) { return (c.r + c.g + c.b) / 3.0f; }

// What glass makes of the light that goes through it.
inline glm::vec3 glassColor(const Scene& scene, const Material& material, glm::vec2 uv) {
  const glm::vec3 texel(sampleTexture(scene, material.baseColorTexture, uv));
  return glm::min(glm::vec3(material.baseColor) * texel, 1.0f);
}

// The share of light that the surface stops before any of it enters glass: alpha of BLEND, 0 or 1 of MASK, else 1.
inline float coverage(const Scene& scene, const Material& material, glm::vec2 uv) {
  if (!material.masked) return 1;
  const float alpha = reflectance(scene, material, uv).a;
  if (material.blended) return std::clamp(alpha, 0.0f, 1.0f);
  return alpha >= material.alphaCutoff ? 1.0f : 0.0f;
}

// The share of light that goes straight through thin glass, as the mean of its colours; at most kMostPassed. cosine:
// between light and normal.
inline float passage(const Scene& scene, const Material& material, glm::vec2 uv, float cosine) {
  if (!(material.transmission > 0)) return 0;
  const glm::vec4 metalAndRoughness = sampleTexture(scene, material.metallicRoughnessTexture, uv);
  const float enters = material.transmission * sampleTexture(scene, material.transmissionTexture, uv).r *
                       (1 - material.metallic * metalAndRoughness.b);
  const path_trace::Albedo a =
      path_trace::AlbedoTable::dielectric(1.5f).at(cosine, material.roughness * metalAndRoughness.g);
  const float f0 =
      meanChannel(glm::min(path_trace::normalReflectance(material.ior) * material.specularColor, 1.0f));
  const float reflects = material.specular * (f0 * a.normal + a.grazing);
  return std::clamp(meanChannel(glassColor(scene, material, uv)) * enters * (1 - reflects), 0.0f,
                    kMostPassed);
}

// The share of light that passes the surface in either way, by channels.
inline glm::vec3 transmittance(const Scene& scene, const Material& material, glm::vec2 uv, float cosine) {
  const float covered = coverage(scene, material, uv);
  if (!(material.transmission > 0)) return glm::vec3(1 - covered);
  const glm::vec3 color = glm::max(glassColor(scene, material, uv), kDarkestGlass);
  return 1 - covered + covered * passage(scene, material, uv, cosine) * color / meanChannel(color);
}

// A number in [0, 1): a ray passes a triangle if it is not below the share of light that the triangle stops. key: a
// hash of the triangle.
inline float passageChance(uint32_t key, glm::uvec2 pixel, uint32_t turn) {
  const glm::uvec2 at = (key & 8u) != 0 ? glm::uvec2(pixel.y, pixel.x) : pixel;
  const uint32_t along = (key & 16u) != 0 ? 0u - at.y : at.y;
  return uniformFloat(key + at.x * kPassageAcross + along * kPassageAlong +
                      turn * (kPassageTurn + (key & 7u) * kPassageTurns));
}

// The share of light that comes through along a ray, by channels. rays: of Passing::Met if it may pass at all.
inline glm::vec3 visibility(const Frame& frame, const RayScene& rays, Ray ray) {
  glm::vec3 share(1);
  for (uint32_t pane = 0; pane < kMaxPanes; ++pane) {
    const RayHit hit = rays.intersect(ray);
    if (!hit) return share;
    const SurfaceHit s = surfaceAt(*frame.geometry, hit);
    const Material& material = frame.scene->materials[s.material];
    if (!rays.meetsTransparency() || !letsLightThrough(material)) break;
    const float cosine = std::abs(glm::dot(s.shadingNormal, glm::normalize(ray.direction)));
    share *= transmittance(*frame.scene, material, s.uv, cosine);
    if (share == glm::vec3(0)) break;
    ray.near = std::nextafter(hit.distance, ray.far) * (1.0f + 1e-6f);
  }
  return glm::vec3(0);
}

}  // namespace fovea::scene
