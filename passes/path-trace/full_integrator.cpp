#include "passes/path-trace/full_integrator.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "framework/base/weighted_choice.h"
#include "passes/path-trace/directions.h"
#include "passes/path-trace/lights.h"

namespace fovea::path_trace {
namespace {

using namespace scene;

constexpr float kShadowEnd = 0.9999f;  // shadow rays end just short of the point they are aimed at
constexpr uint32_t kMaxPanes = 64;     // surfaces that light passes on one edge

float mean(glm::vec3 c) { return (c.r + c.g + c.b) / 3.0f; }

}  // namespace

FullIntegrator::FullIntegrator(const Frame& frame, const View& view, const RayScene& rays, uint32_t depth)
    : frame_(frame),
      view_(view),
      rays_(rays),
      emitters_(frame),
      emitterShare_(emitterShare(frame, emitters_)),
      materials_(*frame.scene, *frame.geometry),
      depth_(depth) {
  if (frame.scene->environmentMap) environment_.emplace(*frame.scene->environmentMap);
}

RayHit FullIntegrator::intersect(const Ray& ray, uint64_t& rays) const {
  ++rays;
  return rays_.intersect(ray);
}

Ray FullIntegrator::beyond(Ray ray, const RayHit& hit) {
  ray.near = std::nextafter(hit.distance, ray.far) * (1.0f + 1e-6f);
  return ray;
}

FullIntegrator::Vertex FullIntegrator::vertexAt(const SurfacePoint& point, glm::vec3 direction) const {
  const float side = glm::dot(point.face, direction) < 0 ? 1.0f : -1.0f;
  const glm::vec3 face = side * point.face, out = -direction;
  const glm::mat3 frame = frameAround(point.normalTowards(out));
  return {point.position, point.position + (face + out) * rays_.epsilon(), face, frame,
          Bsdf(point.bsdf, glm::normalize(toLocal(frame, out)))};
}

glm::vec3 FullIntegrator::reflected(const Vertex& v, glm::vec3 direction) {
  if (glm::dot(v.face, direction) <= 0) return glm::vec3(0);
  return v.bsdf.evaluate(toLocal(v.frame, direction));
}

FullIntegrator::EyePoint FullIntegrator::look(glm::vec2 pixel, uint64_t& rays) const {
  EyePoint point;
  Ray ray = eyeRay(view_, pixel);
  const glm::vec3 direction = glm::normalize(ray.direction);
  glm::vec3 weight(1);
  float sum = 0;
  while (weight != glm::vec3(0) && point.vertex.size() < kMaxPanes) {
    const RayHit hit = intersect(ray, rays);
    if (!hit) {
      point.direct += weight * (environment_ ? environment_->radiance(direction) : frame_.scene->environment);
      break;
    }
    ray = beyond(ray, hit);
    const SurfacePoint s = materials_.at(hit);
    if (glm::dot(s.face, direction) >= 0 && !s.doubleSided) continue;
    if (s.coverage == 0) continue;
    const glm::vec3 covered = weight * s.coverage;
    point.direct += covered * s.emission;
    if (s.unlit) {
      weight *= 1 - s.coverage;
      continue;
    }
    const Vertex v = vertexAt(s, direction);
    if (depth_ >= 2) point.direct += covered * allLights(v, rays);
    const glm::vec3 through = passing(s, v);
    point.vertex.push_back({v, covered, mean(weight) * (1 - mean(through))});
    sum += point.vertex.back().probability;
    weight *= through;
  }
  for (Seen& seen : point.vertex) seen.probability = sum > 0 ? seen.probability / sum : 0;
  point.surface = sum > 0;
  return point;
}

glm::vec3 FullIntegrator::visibility(Ray ray, uint64_t& rays) const {
  if (!materials_.anyTransmits()) {
    ++rays;
    return glm::vec3(rays_.occluded(ray) ? 0.0f : 1.0f);
  }
  glm::vec3 share(1);
  const glm::vec3 direction = glm::normalize(ray.direction);
  for (uint32_t panes = 0; panes < kMaxPanes; ++panes) {
    const RayHit hit = intersect(ray, rays);
    if (!hit) return share;
    if (!materials_.transmits(hit.triangle)) break;
    const SurfacePoint s = materials_.at(hit);
    share *= passing(s, vertexAt(s, direction));
    if (share == glm::vec3(0)) break;
    ray = beyond(ray, hit);
  }
  return glm::vec3(0);
}

glm::vec3 FullIntegrator::unshadowed(const Light& light, const Vertex& v, Ray& shadowRay) const {
  const IncidentLight l = incidentLight(light, v.position);
  shadowRay.origin = v.origin;
  shadowRay.direction = l.direction;
  shadowRay.far = l.distance * kShadowEnd;
  return l.irradiance * reflected(v, l.direction);
}

glm::vec3 FullIntegrator::allLights(const Vertex& v, uint64_t& rays) const {
  glm::vec3 sum(0);
  for (const Light& light : frame_.lights) {
    Ray shadowRay;
    const glm::vec3 radiance = unshadowed(light, v, shadowRay);
    if (radiance != glm::vec3(0)) sum += radiance * visibility(shadowRay, rays);
  }
  return sum;
}

// Samples one light in proportion to its unoccluded contribution.
glm::vec3 FullIntegrator::oneLight(const Vertex& v, const PathSampler& random, uint32_t k,
                                   uint64_t& rays) const {
  glm::vec3 chosen(0);
  Ray shadowRay;
  WeightedChoice choice(frame_.lights.size() > 1 ? random.number(k) : 0.0f);
  for (const Light& light : frame_.lights) {
    Ray ray;
    const glm::vec3 radiance = unshadowed(light, v, ray);
    const float weight = radiance.r + radiance.g + radiance.b;
    if (!(weight > 0) || !choice.takes(weight)) continue;
    chosen = radiance;
    shadowRay = ray;
  }
  if (!choice.any()) return glm::vec3(0);
  return chosen * choice.inverseProbability() * visibility(shadowRay, rays);
}

glm::vec3 FullIntegrator::environmentLight(const Vertex& v, float u1, float u2, uint64_t& rays) const {
  const Environment::Sample s = environment_->sample(u1, u2);
  if (!(s.density > 0)) return glm::vec3(0);
  const glm::vec3 radiance = s.radiance * reflected(v, s.direction);
  if (radiance == glm::vec3(0)) return glm::vec3(0);
  const float density = (1 - emitterShare_) * s.density;
  return radiance * visibility({v.origin, s.direction}, rays) /
         (density + v.bsdf.density(toLocal(v.frame, s.direction)));
}

glm::vec3 FullIntegrator::emitterLight(const Vertex& v, float choice, float u1, float u2,
                                       uint64_t& rays) const {
  if (choice >= emitterShare_) return environmentLight(v, u1, u2, rays);
  const EmitterPoint p = emitters_.sample({v.origin, v.frame[2]}, choice / emitterShare_, u1, u2);
  if (!p.hit) return glm::vec3(0);
  Ray ray;
  ray.origin = v.origin;
  ray.direction = p.position + p.normal * rays_.epsilon() - v.origin;
  ray.far = kShadowEnd;
  const float d2 = glm::dot(ray.direction, ray.direction);
  if (!(d2 > 0)) return glm::vec3(0);
  const glm::vec3 w = ray.direction / std::sqrt(d2);
  const float cosineEmitter = -glm::dot(p.normal, w);
  if (cosineEmitter <= 0) return glm::vec3(0);
  const glm::vec3 radiance = materials_.emission(p.hit) * reflected(v, w);
  if (radiance == glm::vec3(0) || !rays_.isSolid(p.hit)) return glm::vec3(0);
  const float density = emitterShare_ * p.density * d2 / cosineEmitter;  // per sr
  return radiance * visibility(ray, rays) / (density + v.bsdf.density(toLocal(v.frame, w)));
}

glm::vec3 FullIntegrator::emitted(const Vertex& from, glm::vec3 direction, const RayHit& hit,
                                  const SurfacePoint& at, float density) const {
  const float facing = -glm::dot(at.face, direction);
  if (at.emission == glm::vec3(0) || (facing <= 0 && !at.doubleSided)) return glm::vec3(0);
  const float perArea = emitterShare_ * emitters_.density(hit.triangle, {from.origin, from.frame[2]}),
              cosine = std::max(std::abs(facing), 1e-12f);
  return at.emission * at.coverage * (density / (density + perArea * hit.distance * hit.distance / cosine));
}

// Random numbers of a vertex: two for the direction, one for the light, one for the part of the BSDF, two for the
// point on an emitter, one for the choice of emitter and one for whether glass is passed.
bool FullIntegrator::bounce(Path& path, uint32_t edges, const PathSampler& random, uint64_t& rays) const {
  const uint32_t k = 8 * edges;
  const std::array<float, 2> u = random.pair(k);
  const std::optional<Bsdf::Sample> sample = path.vertex.bsdf.sample(random.number(k + 3), u[0], u[1]);
  if (!sample) return false;
  const glm::vec3 direction = toWorld(path.vertex.frame, sample->in);
  if (glm::dot(direction, path.vertex.face) <= 0) return false;
  path.throughput *= sample->weight;
  Ray ray{path.vertex.origin, direction};
  float pass = random.number(k + 7);
  for (uint32_t panes = 0; panes < kMaxPanes; ++panes) {
    const RayHit hit = intersect(ray, rays);
    if (!hit) {
      if (environment_) {
        const float other = (1 - emitterShare_) * environment_->density(direction);
        path.light += path.throughput * environment_->radiance(direction) *
                      (sample->density / (sample->density + other));
      }
      return false;
    }
    const SurfacePoint s = materials_.at(hit);
    const bool black = s.unlit || (!s.glass && glm::dot(s.face, direction) >= 0 && !s.doubleSided);
    if (!black) path.light += path.throughput * emitted(path.vertex, direction, hit, s, sample->density);
    const Vertex next = vertexAt(s, direction);
    const glm::vec3 through = black ? glm::vec3(1 - s.coverage) : passing(s, next);
    if (black && through == glm::vec3(0)) return false;
    const float probability = through == glm::vec3(0) ? 0.0f
                              : s.coverage == 0       ? 1.0f
                                                      : std::clamp(mean(through), 0.1f, 0.9f);
    if (pass < probability) {
      pass /= probability;
      path.throughput *= through / probability;
      ray = beyond(ray, hit);
      continue;
    }
    if (black) return false;
    path.throughput *= s.coverage / (1 - probability);
    path.vertex = next;
    return path.throughput != glm::vec3(0);
  }
  return false;
}

void FullIntegrator::trace(Path& path, const PathSampler& random, uint64_t& rays) const {
  for (uint32_t edges = 1; edges < depth_; ++edges) {
    const uint32_t k = 8 * edges;
    if (edges > 1) path.light += path.throughput * oneLight(path.vertex, random, k + 2, rays);
    if (!emitters_.empty() || environment_) {
      const std::array<float, 2> u = random.pair(k + 4);
      path.light += path.throughput * emitterLight(path.vertex, random.number(k + 6), u[0], u[1], rays);
    } else if (edges + 1 == depth_) {
      return;
    }
    if (!bounce(path, edges, random, rays)) return;
  }
}

void FullIntegrator::indirect(const std::vector<Seen>& first, std::span<const PathSampler> random,
                              std::span<glm::vec3> light, uint64_t& rays) const {
  for (size_t i = 0; i < random.size(); ++i) {
    float choice = first.size() > 1 ? random[i].number(2) : 0.0f;
    size_t begin = 0;
    while (begin + 1 < first.size() && choice >= first[begin].probability)
      choice -= first[begin++].probability;
    const Seen& seen = first[begin];
    if (!(seen.probability > 0)) continue;
    Path path{seen.vertex, seen.weight / seen.probability};
    trace(path, random[i], rays);
    light[i] = path.light;
  }
}

}  // namespace fovea::path_trace
