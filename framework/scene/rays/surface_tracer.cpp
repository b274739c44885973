#include "framework/scene/rays/surface_tracer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "framework/base/random.h"
#include "framework/scene/environment/environment_map.h"
#include "framework/scene/lights.h"
#include "framework/scene/materials/bounced.h"
#include "framework/scene/materials/passage.h"
#include "framework/scene/rays/visibility.h"
#include "framework/scene/rays/directions.h"
#include "shaders/records/rays.h"
#include "shaders/records/scene.h"

namespace fovea::scene {

glm::vec3 cosineDirection(glm::vec3 normal, glm::vec2 u) {
  const float r = std::sqrt(u.x), phi = glm::two_pi<float>() * u.y;
  return toWorld(orthonormalFrame(normal), {r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0f - u.x)});
}

glm::vec2 streamSequence(uint32_t stream, uint32_t turn) {
  return {uniformFloat(hashCombine(stream, 0u) + turn * 3242174889u),
          uniformFloat(hashCombine(stream, 1u) + turn * 2447445414u)};
}

SurfaceTracer::SurfaceTracer(const Frame& frame, const View& view, const RayScene& rays, bool fullMaterials)
    : frame_(frame),
      view_(view),
      rays_(rays),
      emitters_(frame, fullMaterials),
      environment_(frame.scene->environmentMap.get()),
      surfaceShare_(surfaceShare(emitters_, environment_)) {
  if (fullMaterials) materials_.emplace(*frame.scene, *frame.geometry);
}

TracedSurface SurfaceTracer::surfaceOf(const RayHit& hit, glm::vec3 direction) const {
  const SurfaceHit s = surfaceAt(*frame_.geometry, hit);
  const Material& material = frame_.scene->materials[s.material];
  const bool front = glm::dot(s.geometricNormal, direction) < 0;
  const float side = front ? 1.0f : -1.0f;
  TracedSurface v;
  v.there = front || material.doubleSided;
  v.triangle = hit.triangle;
  v.u = hit.u;
  v.v = hit.v;
  v.position = s.position;
  v.normal = side * s.shadingNormal;
  v.face = side * s.geometricNormal;
  v.origin = s.position + (v.face - direction) * rays_.epsilon();
  v.uv = s.uv;
  v.material = &material;
  if (rays_.meetsTransparency() && material.transmission > 0)
    v.brighter /=
        1 - passage(*frame_.scene, material, v.uv, std::abs(glm::dot(v.normal, glm::normalize(direction))));
  return v;
}

bool SurfaceTracer::passes(const TracedSurface& v, glm::vec3 direction, float chance) const {
  if (!rays_.meetsTransparency() || !letsLightThrough(*v.material)) return false;
  const float cosine = std::abs(glm::dot(v.normal, direction));
  const float stopped =
      coverage(*frame_.scene, *v.material, v.uv) * (1 - passage(*frame_.scene, *v.material, v.uv, cosine));
  return stopped <= chance;
}

uint32_t SurfaceTracer::keyOf(glm::vec3 origin, glm::vec3 direction) const {
  if (!rays_.meetsTransparency()) return 0;
  uint32_t key = randomStream(frame_.seed, uint32_t(frame_.index), kPassedRayStream, 0);
  for (const float x : {origin.x, origin.y, origin.z, direction.x, direction.y, direction.z})
    key = hashCombine(key, std::bit_cast<uint32_t>(x));
  return key;
}

template <class Function>
TracedSurface SurfaceTracer::follow(Ray ray, bool meetsBacks, const Function& chanceAt,
                                    uint64_t& rays) const {
  TracedSurface v;
  glm::vec3 tint(1);
  for (uint32_t pane = 0; pane < kMaxPanes; ++pane) {
    ++rays;
    const RayHit hit = rays_.intersect(ray);
    v = hit ? surfaceOf(hit, ray.direction) : TracedSurface{};
    const bool passed =
        hit && ((!v.there && !meetsBacks) || passes(v, ray.direction, chanceAt(hit.triangle)));
    if (!passed) break;
    if (v.there && v.material->transmission > 0) tint *= glassTint(*frame_.scene, *v.material, v.uv);
    ray.near = std::nextafter(hit.distance, ray.far) * (1.0f + 1e-6f);
    v = {};
  }
  v.brighter *= tint;
  return v;
}

TracedSurface SurfaceTracer::look(glm::vec2 pixel, uint64_t& rays) const {
  Ray ray;
  ray.origin = view_.eye;
  ray.direction = glm::normalize(view_.rayDirection(pixel));
  // The same as in gbuffer/visibility.frag.
  const uint32_t key = hashCombine(frame_.seed, kPassageStream);
  const auto chanceAt = [&](uint32_t triangle) {
    return passageChance(hashCombine(key, triangle), glm::uvec2(pixel), uint32_t(frame_.index));
  };
  return follow(ray, false, chanceAt, rays);
}

TracedSurface SurfaceTracer::arrive(glm::vec3 origin, glm::vec3 direction, float reach,
                                    uint64_t& rays) const {
  const uint32_t key = keyOf(origin, direction);
  const auto chanceAt = [&](uint32_t triangle) { return uniformFloat(hashCombine(key, triangle)); };
  return follow({origin, direction, 0, reach}, true, chanceAt, rays);
}

glm::vec3 SurfaceTracer::reflectance(const TracedSurface& v) const {
  return v.brighter * bouncedReflectance(*frame_.scene, *v.material, v.uv, materials_.has_value());
}

template <class Function>
glm::vec3 SurfaceTracer::fromLights(const TracedSurface& v, uint64_t& rays, const Function& respond) const {
  glm::vec3 sum(0);
  for (const Light& light : frame_.lights) {
    const LightSample l = sampleLight(light, v.position);
    if (glm::dot(v.face, l.direction) <= 0 || l.irradiance == glm::vec3(0)) continue;
    const glm::vec3 response = respond(l.irradiance, l.direction);
    if (response == glm::vec3(0)) continue;
    Ray ray;
    ray.origin = v.origin;
    ray.direction = l.direction;
    if (l.distance < kFarAway) ray.far = l.distance * kShadowEnd;
    sum += response * scene::visibility(frame_, rays_, ray, rays);
  }
  return sum;
}

glm::vec3 SurfaceTracer::irradiance(const TracedSurface& v, uint64_t& rays) const {
  return fromLights(v, rays, [&](glm::vec3 irradiance, glm::vec3 direction) {
    return irradiance * std::max(glm::dot(v.normal, direction), 0.0f);
  });
}

glm::vec3 SurfaceTracer::seen(const TracedSurface& v, glm::vec3 out, uint64_t& rays,
                              float leastRoughness) const {
  if (!materials_) return emitted(v) + direct(v, Reflection(reflectance(v)), rays);
  const SurfacePoint point = materials_->at({v.triangle, 0, v.u, v.v});
  return v.brighter * point.emission + direct(v, Reflection(point, out, leastRoughness, v.brighter), rays);
}

Reflection SurfaceTracer::reflection(const TracedSurface& v, glm::vec3 out, glm::vec3 rho,
                                     float leastRoughness) const {
  if (!materials_) return Reflection(rho);
  return Reflection(materials_->at({v.triangle, 0, v.u, v.v}), out, leastRoughness, v.brighter);
}

glm::vec3 SurfaceTracer::emitted(const TracedSurface& v) const {
  const bool dark = emitters_.empty() || (materials_ && v.material->unlit);
  return dark ? glm::vec3(0) : v.brighter * emission(*frame_.scene, *v.material, v.uv);
}

glm::vec3 SurfaceTracer::direct(const TracedSurface& v, const Reflection& reflection, uint64_t& rays) const {
  if (!reflection.full()) return reflection.rho() * glm::one_over_pi<float>() * irradiance(v, rays);
  return fromLights(v, rays, [&](glm::vec3 irradiance, glm::vec3 direction) {
    return irradiance * reflection.evaluate(direction);
  });
}

glm::vec3 SurfaceTracer::directTowards(const TracedSurface& v, glm::vec3 out, glm::vec3 rho,
                                       float leastRoughness, uint64_t& rays) const {
  if (frame_.lights.empty()) return glm::vec3(0);
  return direct(v, reflection(v, out, rho, leastRoughness), rays);
}

SurfaceTracer::EmitterRay SurfaceTracer::towardsEmitter(const TracedSurface& v, uint32_t stream) const {
  const uint32_t own = hashCombine(stream, kAimedRayStream);
  const glm::vec2 u = streamSequence(own, 0);
  return towardsEmitter(v, {uniformFloat(hashCombine(own, 2u)), u.x, u.y});
}

SurfaceTracer::EmitterRay SurfaceTracer::towardsEmitter(const TracedSurface& v, glm::vec3 u) const {
  EmitterRay ray;
  if (u.x >= surfaceShare_) {
    if (environment_ == nullptr) return ray;
    const EnvironmentMap::Sample s = environment_->sample(u.y, u.z);
    if (!(s.density > 0) || glm::dot(v.normal, s.direction) <= 0 || glm::dot(v.face, s.direction) <= 0)
      return ray;
    return {true, s.direction, kFarAway, (1 - surfaceShare_) * s.density, kNoIndex, s.radiance};
  }
  const EmitterPoint p = emitters_.sample({v.origin, v.normal}, u.x / surfaceShare_, u.y, u.z);
  const glm::vec3 to = p.position - v.origin;
  const float d2 = glm::dot(to, to);
  if (p.triangle == kNoIndex || !(d2 > 0)) return ray;
  ray.distance = std::sqrt(d2);
  ray.direction = to / ray.distance;
  const float cosine = -glm::dot(p.normal, ray.direction);
  if (!(cosine > 0) || glm::dot(v.normal, ray.direction) <= 0 || glm::dot(v.face, ray.direction) <= 0)
    return ray;
  ray.there = true;
  ray.density = surfaceShare_ * p.density * d2 / cosine;
  ray.triangle = p.triangle;
  ray.radiance = p.radiance;
  return ray;
}

SurfaceTracer::EmitterRay SurfaceTracer::towardsOutside(const TracedSurface& v, glm::vec3 direction) const {
  if (environment_ == nullptr || glm::dot(v.normal, direction) <= 0 || glm::dot(v.face, direction) <= 0)
    return {};
  const Outside light = outside(direction);
  return {true, direction, kFarAway, light.density, kNoIndex, light.radiance};
}

glm::vec3 SurfaceTracer::visibility(const TracedSurface& v, const EmitterRay& to, uint64_t& rays) const {
  return scene::visibility(frame_, rays_, {v.origin, to.direction, 0, to.distance * kShadowEnd}, rays);
}

float SurfaceTracer::emitterDensity(const TracedSurface& v, const TracedSurface& hit) const {
  const float density = surfaceShare_ * emitters_.density(hit.triangle, {v.origin, v.normal});
  if (!(density > 0)) return 0;
  const glm::vec3 to = hit.position - v.origin;
  const float d2 = glm::dot(to, to);
  return density * d2 * std::sqrt(d2) / std::max(std::abs(glm::dot(hit.face, to)), 1e-12f);
}

SurfaceTracer::Outside SurfaceTracer::outside(glm::vec3 direction) const {
  if (environment_ == nullptr) return {};
  return {environment_->radiance(direction), (1 - surfaceShare_) * environment_->density(direction)};
}

// The part of one point on an emissive surface in the balance heuristic (Veach and Guibas 1995), beside `count`
// cosine-weighted rays that may hit such a surface by chance. Neither way alone would do: small emitters are hardly
// ever hit, and points on a close one make bright spots.
glm::vec3 SurfaceTracer::fromEmitters(const TracedSurface& v, uint32_t count, uint32_t stream,
                                      uint64_t& rays) const {
  if (!hasEmitters()) return glm::vec3(0);
  const EmitterRay to = towardsEmitter(v, stream);
  if (!to.there) return glm::vec3(0);
  const float cosine = glm::dot(v.normal, to.direction) * glm::one_over_pi<float>();
  return to.radiance * visibility(v, to, rays) * (cosine / (to.density + float(count) * cosine));
}

void SurfaceTracer::addArriving(glm::vec3& sum, glm::vec3 factor, const TracedSurface& v, glm::vec3 direction,
                                float density, uint32_t bounces, uint32_t stream, uint64_t& rays) const {
  const auto balance = [&](float other) { return density / (other + density); };
  const TracedSurface next = arrive(v.origin, direction, kFarAway, rays);
  if (!next.there) {
    if (const Outside light = outside(direction); next.isOutside() && light.density > 0)
      sum += factor * next.brighter * light.radiance * balance(light.density);
    return;
  }
  const glm::vec3 rho = reflectance(next);
  sum += factor * directTowards(next, -direction, rho, kGatheredRoughness, rays);
  if (const glm::vec3 shining = emitted(next); shining != glm::vec3(0))
    sum += factor * shining * balance(emitterDensity(v, next));
  sum += factor * rho * gather(next, bounces - 1, 1, stream, rays);
}

glm::vec3 SurfaceTracer::gather(const TracedSurface& v, uint32_t bounces, uint32_t count, uint32_t stream,
                                uint64_t& rays) const {
  if (bounces == 0) return fromEmitters(v, 0, stream, rays);
  glm::vec3 sum(0);
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 direction = cosineDirection(v.normal, streamSequence(stream, i));
    if (glm::dot(direction, v.face) <= 0) continue;
    const float density = float(count) * glm::dot(v.normal, direction) * glm::one_over_pi<float>();
    addArriving(sum, glm::vec3(1), v, direction, density, bounces, hashCombine(stream, i + 2), rays);
  }
  return sum / float(count) + fromEmitters(v, count, stream, rays);
}

glm::vec3 SurfaceTracer::passedOn(const TracedSurface& v, const Reflection& reflection, uint32_t bounces,
                                  uint32_t count, uint32_t stream, uint64_t& rays) const {
  if (!reflection.full()) return reflection.rho() * gather(v, bounces, count, stream, rays);
  if (bounces == 0) count = 0;
  TracedSurface bent = v;  // with the normal about which rays are chosen
  bent.normal = reflection.normal();
  glm::vec3 sum(0);
  for (uint32_t i = 0; i < count; ++i) {
    const float choice = uniformFloat(hashCombine(hashCombine(stream, kLobeStream), i));
    const std::optional<Reflection::Sample> s = reflection.sample(choice, streamSequence(stream, i));
    if (!s || s->weight == glm::vec3(0) || glm::dot(s->direction, v.face) <= 0) continue;
    addArriving(sum, s->weight / float(count), bent, s->direction, float(count) * s->density, bounces,
                hashCombine(stream, i + 2), rays);
  }
  if (!hasEmitters()) return sum;
  const EmitterRay to = towardsEmitter(bent, stream);
  if (!to.there) return sum;
  const glm::vec3 response = reflection.evaluate(to.direction);
  if (response == glm::vec3(0)) return sum;
  return sum + response * to.radiance * visibility(v, to, rays) /
                   (to.density + float(count) * reflection.density(to.direction));
}

}  // namespace fovea::scene
