#include "passes/path-trace/path_integrator.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>

#include "framework/base/low_discrepancy.h"
#include "framework/base/random.h"
#include "framework/base/weighted_choice.h"
#include "passes/path-trace/directions.h"
#include "passes/path-trace/lights.h"

namespace fovea::path_trace {
namespace {

using namespace scene;

constexpr float kInversePi = glm::one_over_pi<float>();

// Shadow rays end just short of the point they are aimed at.
constexpr float kShadowEnd = 0.9999f;

// Returns (cos, sin) of (2 t - 1) pi for t in [0, 1], to within 1e-6: polynomials for half the
// angle (Chebyshev fits), doubled.
glm::vec2 onCircle(float t) {
  const float y = 2.0f * t - 1.0f, z = y * y;
  const float sine =
      y *
      (1.57079632f + z * (-0.64596376f + z * (0.0796899226f + z * (-0.00467415067f + z * 0.000151675118f))));
  const float cosine =
      1.0f + z * (-1.23370053f +
                  z * (0.253669322f + z * (-0.0208626875f + z * (0.000917723882f - z * 2.38245355e-05f))));
  return {cosine * cosine - sine * sine, 2.0f * sine * cosine};
}

glm::vec3 cosineDirection(glm::vec3 normal, float u, float v) {
  return toWorld(frameAround(normal), glm::vec3(std::sqrt(u) * onCircle(v), std::sqrt(1.0f - u)));
}

glm::vec3 reflectanceOf(const Material& material, glm::vec4 texture) {
  return glm::vec3(material.baseColor) * glm::vec3(texture) * (1.0f - material.meanMetallic());
}

}  // namespace

Ray eyeRay(const View& view, glm::vec2 pixel) {
  Ray ray;
  ray.origin = view.eye;
  ray.direction = view.rayDirection(pixel);
  const glm::vec4 a = view.worldToClip * glm::vec4(view.eye, 1),
                  b = view.worldToClip * glm::vec4(ray.direction, 0);
  if (b.z != 0) ray.near = std::max(0.0f, -a.z / b.z);
  if (const float far = (a.w - a.z) / (b.z - b.w); far > ray.near) ray.far = far;
  return ray;
}

float emitterShare(const Frame& frame, const Emitters& emitters) {
  if (!frame.scene->environmentMap) return 1;
  return emitters.empty() ? 0.0f : 0.5f;
}

float PathSampler::number(uint32_t k) const {
  return independent ? uniformFloat(hashCombine(stream, k)) : sobol(index, k, stream);
}

std::array<float, 2> PathSampler::pair(uint32_t k) const {
  if (independent) return {number(k), number(k + 1)};
  return sobolPair(index, k, stream);
}

// One path being traced.
struct PathIntegrator::Path {
  PathVertex vertex;  // its reflectance is included in the throughput
  glm::vec3 light{0}, throughput{0};
  glm::vec3 direction{0};  // direction of the ray from the vertex
  RayHit hit;
  glm::vec2 uv{0};  // texture coordinates of the vertex
  uint32_t material = 0;
  TextureTaps texture;
};

struct PathIntegrator::Wave {
  std::array<Path, kMaxPaths> paths;
  std::span<const PathSampler> random;   // random numbers of each path
  std::array<uint8_t, kMaxPaths> alive;  // numbers of the `count` paths that continue
  size_t count = 0;
};

PathIntegrator::PathIntegrator(const Frame& frame, const View& view, const RayScene& rays, uint32_t depth)
    : frame_(frame),
      view_(view),
      rays_(rays),
      emitters_(frame),
      emitterShare_(emitterShare(frame, emitters_)),
      surfaces_(frame),
      depth_(depth) {
  if (frame.scene->environmentMap) environment_.emplace(*frame.scene->environmentMap);
}

RayHit PathIntegrator::intersect(const Ray& ray, uint64_t& rays) const {
  ++rays;
  if (record_ != nullptr) record_->push_back({ray, false});
  return rays_.intersect(ray);
}

bool PathIntegrator::occluded(const Ray& ray, uint64_t& rays) const {
  ++rays;
  if (record_ != nullptr) record_->push_back({ray, true});
  return rays_.occluded(ray);
}

PathVertex PathIntegrator::vertexAt(const SurfaceHit& s, glm::vec3 direction) const {
  const float side = glm::dot(s.geometricNormal, direction) < 0 ? 1.0f : -1.0f;
  PathVertex v;
  v.normal = side * s.shadingNormal;
  v.face = side * s.geometricNormal;
  v.position = s.position;
  // Moves off the surface and back along the ray, where space is known to be empty. Where two walls meet, a step away
  // from one of them alone would stay in the seam.
  v.origin = s.position + (v.face - direction) * rays_.epsilon();
  return v;
}

EyePoint PathIntegrator::look(glm::vec2 pixel, uint64_t& rays) const {
  EyePoint point;
  Ray ray = eyeRay(view_, pixel);
  while (const RayHit hit = intersect(ray, rays)) {
    const SurfaceHit s = surfaceAt(*frame_.geometry, hit);
    const Material& material = frame_.scene->materials[s.material];
    const bool front = glm::dot(s.geometricNormal, ray.direction) < 0;
    if (!front && !material.doubleSided) {
      ray.near = std::nextafter(hit.distance, ray.far) * (1.0f + 1e-6f);
      continue;
    }
    point.surface = true;
    point.vertex = vertexAt(s, glm::normalize(ray.direction));
    point.vertex.reflectance =
        reflectanceOf(material, sampleTexture(*frame_.scene, material.baseColorTexture, s.uv));
    point.direct = emittedRadiance(*frame_.scene, material, s.uv);
    if (depth_ >= 2) point.direct += point.vertex.reflectance * kInversePi * allLights(point.vertex, rays);
    return point;
  }
  point.direct =
      environment_ ? environment_->radiance(glm::normalize(ray.direction)) : frame_.scene->environment;
  return point;
}

glm::vec3 PathIntegrator::unshadowed(const Light& light, const PathVertex& v, Ray& shadowRay) const {
  const IncidentLight l = incidentLight(light, v.position);
  const float cosine = glm::dot(v.normal, l.direction);
  if (cosine <= 0 || glm::dot(v.face, l.direction) <= 0) return glm::vec3(0);
  shadowRay.origin = v.origin;
  shadowRay.direction = l.direction;
  shadowRay.far = l.distance * kShadowEnd;
  return l.irradiance * cosine;
}

glm::vec3 PathIntegrator::allLights(const PathVertex& v, uint64_t& rays) const {
  glm::vec3 sum(0);
  for (const Light& light : frame_.lights) {
    Ray shadowRay;
    const glm::vec3 e = unshadowed(light, v, shadowRay);
    if (e != glm::vec3(0) && !occluded(shadowRay, rays)) sum += e;
  }
  return sum;
}

// Samples one light in proportion to its unoccluded contribution.
glm::vec3 PathIntegrator::oneLight(const PathVertex& v, const PathSampler& random, uint32_t k,
                                   uint64_t& rays) const {
  glm::vec3 chosen(0);
  Ray shadowRay;
  WeightedChoice choice(frame_.lights.size() > 1 ? random.number(k) : 0.0f);
  for (const Light& light : frame_.lights) {
    Ray ray;
    const glm::vec3 e = unshadowed(light, v, ray);
    const float weight = e.r + e.g + e.b;
    if (!(weight > 0) || !choice.takes(weight)) continue;
    chosen = e;
    shadowRay = ray;
  }
  if (!choice.any() || occluded(shadowRay, rays)) return glm::vec3(0);
  return chosen * choice.inverseProbability();
}

// The environment is reached in both ways, too.
glm::vec3 PathIntegrator::environmentLight(const PathVertex& v, float u1, float u2, uint64_t& rays) const {
  const Environment::Sample s = environment_->sample(u1, u2);
  const float cosine = glm::dot(v.normal, s.direction);
  if (!(s.density > 0) || cosine <= 0 || glm::dot(v.face, s.direction) <= 0) return glm::vec3(0);
  if (occluded({v.origin, s.direction}, rays)) return glm::vec3(0);
  return s.radiance * (cosine * kInversePi / ((1 - emitterShare_) * s.density + cosine * kInversePi));
}

// Both ways to reach an emissive triangle, a point chosen on it and a bounce that happens to hit it, are weighted
// by the balance heuristic (Veach and Guibas 1995), so neither causes bright spots where emitters touch other
// surfaces or are small.
glm::vec3 PathIntegrator::emitterLight(const PathVertex& v, float choice, float u1, float u2,
                                       uint64_t& rays) const {
  if (choice >= emitterShare_) return environmentLight(v, u1, u2, rays);
  const EmitterPoint p = emitters_.sample({v.origin, v.normal}, choice / emitterShare_, u1, u2);
  if (!p.hit) return glm::vec3(0);
  Ray ray;
  ray.origin = v.origin;
  ray.direction = p.position + p.normal * rays_.epsilon() - v.origin;
  const float d2 = glm::dot(ray.direction, ray.direction);
  if (!(d2 > 0)) return glm::vec3(0);
  const glm::vec3 w = ray.direction / std::sqrt(d2);
  const float cosine = glm::dot(v.normal, w), cosineEmitter = -glm::dot(p.normal, w);
  if (cosine <= 0 || cosineEmitter <= 0 || glm::dot(v.face, w) <= 0) return glm::vec3(0);
  const glm::vec3 radiance = emittedRadiance(*frame_.scene, frame_.scene->materials[p.material], p.uv);
  if (radiance == glm::vec3(0) || !rays_.isSolid(p.hit)) return glm::vec3(0);
  ray.far = kShadowEnd;
  if (occluded(ray, rays)) return glm::vec3(0);
  const float density = emitterShare_ * p.density * d2 / cosineEmitter;  // per sr
  return radiance * (cosine * kInversePi / (density + cosine * kInversePi));
}

// Adds the light found directly at the vertex, then chooses the ray to the next one. `edges` join the vertex to the
// eye; the light that it reflects has come along at least one more. Random numbers of a vertex: two for the
// direction, one for the light, one unused, two for the point on an emitter and one for the choice of emitter.
bool PathIntegrator::leave(Path& path, uint32_t edges, const PathSampler& random, uint64_t& rays) const {
  const PathVertex& v = path.vertex;
  const uint32_t k = 8 * edges;
  if (edges > 1) path.light += path.throughput * kInversePi * oneLight(v, random, k + 2, rays);
  if (emits()) {
    const std::array<float, 2> u = random.pair(k + 4);
    path.light += path.throughput * emitterLight(v, random.number(k + 6), u[0], u[1], rays);
  }
  const std::array<float, 2> u = random.pair(k);
  path.direction = cosineDirection(v.normal, u[0], u[1]);
  if (glm::dot(path.direction, v.face) <= 0) return false;
  path.hit = intersect({v.origin, path.direction}, rays);
  if (!path.hit) {
    if (environment_) {
      const float own = glm::dot(v.normal, path.direction) * kInversePi,
                  other = (1 - emitterShare_) * environment_->density(path.direction);
      path.light += path.throughput * environment_->radiance(path.direction) * (own / (own + other));
    }
    return false;
  }
  surfaces_.prefetch(path.hit.triangle);
  return true;
}

// Handles the hit and fills the vertex there, except for what its texture provides. `edges` join the eye
// to the previous vertex.
bool PathIntegrator::arrive(Path& path, uint32_t edges) const {
  const SurfaceHit s = surfaces_.at({path.vertex.origin, path.direction}, path.hit);
  if (glm::dot(s.geometricNormal, path.direction) >= 0 && !surfaces_.doubleSided(s.material)) return false;
  if (surfaces_.emits(s.material)) {
    const float cosineEmitter = std::abs(glm::dot(s.geometricNormal, path.direction));
    const float perArea =
        emitterShare_ * emitters_.density(path.hit.triangle, {path.vertex.origin, path.vertex.normal});
    const float other =
        perArea * path.hit.distance * path.hit.distance / std::max(cosineEmitter, 1e-12f);  // per sr
    const float own = glm::dot(path.vertex.normal, path.direction) * kInversePi;
    const glm::vec3 radiance = emittedRadiance(*frame_.scene, frame_.scene->materials[s.material], s.uv);
    path.light += path.throughput * radiance * (own / (own + other));
  }
  if (edges + 1 == depth_) return false;
  path.vertex = vertexAt(s, path.direction);
  path.material = s.material;
  path.uv = s.uv;
  return true;
}

bool PathIntegrator::reflect(Path& path) const {
  path.throughput *= surfaces_.reflectance(path.material, path.texture);
  return path.throughput != glm::vec3(0);
}

// Advances all paths along one edge. Each path looks up its hit while the ray of the next one is being traced, and
// its texels while the one after that is.
void PathIntegrator::bounce(Wave& wave, uint32_t edges, uint64_t& rays) const {
  const bool last = lastByLight(edges + 1);
  constexpr uint32_t kNone = kMaxPaths;
  uint32_t arriving = kNone, reflecting = kNone;
  size_t kept = 0;
  const auto advance = [&](uint32_t left) {
    if (reflecting != kNone && reflect(wave.paths[reflecting])) wave.alive[kept++] = uint8_t(reflecting);
    reflecting = kNone;
    if (arriving != kNone && arrive(wave.paths[arriving], edges)) {
      Path& path = wave.paths[arriving];
      if (last) {
        wave.alive[kept++] = uint8_t(arriving);
      } else {
        surfaces_.find(path.material, path.uv, path.texture);
        reflecting = arriving;
      }
    }
    arriving = left;
  };
  for (size_t n = 0; n < wave.count; ++n) {
    const uint32_t i = wave.alive[n];
    if (leave(wave.paths[i], edges, wave.random[i], rays)) advance(i);
  }
  advance(kNone);
  advance(kNone);
  wave.count = kept;
}

// Last reflection of paths to which no emitter can add. Many of these surfaces lie in shadow, and their textures
// need not be read.
void PathIntegrator::reflectLast(Wave& wave, uint32_t edges, uint64_t& rays) const {
  const auto add = [&](Path& path, glm::vec3 irradiance) {
    reflect(path);
    path.light += path.throughput * kInversePi * irradiance;
  };
  Path* lit = nullptr;  // the most recent lit path
  glm::vec3 litBy(0);
  for (size_t n = 0; n < wave.count; ++n) {
    const uint32_t i = wave.alive[n];
    Path& path = wave.paths[i];
    const glm::vec3 irradiance = oneLight(path.vertex, wave.random[i], 8 * edges + 2, rays);
    if (irradiance == glm::vec3(0)) continue;
    surfaces_.find(path.material, path.uv, path.texture);
    if (lit != nullptr) add(*lit, litBy);
    lit = &path;
    litBy = irradiance;
  }
  if (lit != nullptr) add(*lit, litBy);
}

void PathIntegrator::indirect(const PathVertex& first, std::span<const PathSampler> random,
                              std::span<glm::vec3> light, uint64_t& rays) const {
  Wave wave;
  wave.random = random;
  wave.count = random.size();
  for (size_t i = 0; i < wave.count; ++i) {
    wave.paths[i].vertex = first;
    wave.paths[i].throughput = first.reflectance;
    wave.alive[i] = uint8_t(i);
  }
  // Light of the lights comes along at least three edges, all other light along at least two.
  const uint32_t edgesAtLeast = emits() ? 2 : 3;
  for (uint32_t edges = 1; depth_ >= edgesAtLeast && edges < depth_ && wave.count > 0; ++edges) {
    if (lastByLight(edges)) {
      reflectLast(wave, edges, rays);
      break;
    }
    bounce(wave, edges, rays);
  }
  for (size_t i = 0; i < random.size(); ++i) light[i] = wave.paths[i].light;
}

}  // namespace fovea::path_trace
