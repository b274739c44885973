#include "passes/eye-paths/eye_path_tracer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <thread>

#include "framework/base/random.h"
#include "framework/scene/fovea.h"
#include "framework/scene/lights.h"
#include "framework/scene/paraboloid.h"

namespace fovea::passes {
namespace {

using namespace scene;

constexpr uint32_t kPathStream = 0x70617468u, kGatherStream = 0x67617468u;  // of the random numbers
constexpr uint32_t kPointsAtOnce = 16;                                      // that a thread takes
constexpr float kShadowEnd = 0.9999f;  // shadow rays end just before the light
const glm::vec3 kLuminance(0.2126f, 0.7152f, 0.0722f);

glm::vec3 cosineDirection(glm::vec3 normal, glm::vec2 u) {
  const float r = std::sqrt(u.x), phi = glm::two_pi<float>() * u.y;
  return toWorld(orthonormalFrame(normal), {r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0f - u.x)});
}

// Point `turn` of the R2 sequence (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018)
// from a start of the stream's own.
glm::vec2 streamSequence(uint32_t stream, uint32_t turn) {
  return {uniformFloat(hashCombine(stream, 0u) + turn * 3242174889u),
          uniformFloat(hashCombine(stream, 1u) + turn * 2447445414u)};
}

struct Vertex {
  bool there = false;
  glm::vec3 origin{0};  // of rays that leave it, just off the surface
  glm::vec3 position{0};
  glm::vec3 normal{0}, face{0};  // shading and geometric, unit, on the side that was reached
  glm::vec2 uv{0};
  const Material* material = nullptr;
};

// What passes path-trace and emit take for granted holds here, too: the eye looks through the back of a
// single-sided material, for light it is black.
class Tracer {
 public:
  Tracer(const Frame& frame, const View& view, const RayScene& rays, const EyePathSettings& settings)
      : frame_(frame), view_(view), rays_(rays), settings_(settings) {
    for (const Material& m : frame.scene->materials) shines_ = shines_ || m.emission != glm::vec3(0);
  }

  EyePathStart look(glm::vec2 pixel, uint64_t& rays) const;
  bool stands(const EyePathStart& start, uint64_t& rays) const;
  EyePathEnd end(const EyePathStart& start, uint32_t point, uint32_t turn, uint64_t& rays) const;

 private:
  Vertex arrive(glm::vec3 origin, glm::vec3 direction, uint64_t& rays) const;
  Vertex vertexAt(const RayHit& hit, glm::vec3 direction) const;
  glm::vec3 irradiance(const Vertex& v, uint64_t& rays) const;
  glm::vec3 direct(const Vertex& v, glm::vec3 rho, uint64_t& rays) const;
  glm::vec3 gather(const Vertex& v, uint32_t bounces, uint32_t count, uint32_t stream, uint64_t& rays) const;

  const Frame& frame_;
  const View& view_;
  const RayScene& rays_;
  const EyePathSettings& settings_;
  bool shines_ = false;  // any material
};

Vertex Tracer::vertexAt(const RayHit& hit, glm::vec3 direction) const {
  const SurfaceHit s = surfaceAt(*frame_.geometry, hit);
  const Material& material = frame_.scene->materials[s.material];
  const bool front = glm::dot(s.geometricNormal, direction) < 0;
  Vertex v;
  if (!front && !material.doubleSided) return v;
  const float side = front ? 1.0f : -1.0f;
  v.there = true;
  v.position = s.position;
  v.normal = side * s.shadingNormal;
  v.face = side * s.geometricNormal;
  v.origin = s.position + (v.face - direction) * rays_.epsilon();
  v.uv = s.uv;
  v.material = &material;
  return v;
}

EyePathStart Tracer::look(glm::vec2 pixel, uint64_t& rays) const {
  Ray ray;
  ray.origin = view_.eye;
  ray.direction = glm::normalize(view_.rayDirection(pixel));
  for (;;) {
    ++rays;
    const RayHit hit = rays_.intersect(ray);
    if (!hit) return {};
    if (const Vertex v = vertexAt(hit, ray.direction); v.there)
      return {v.position, 1, v.normal, 0, v.face, 0};
    ray.near = std::nextafter(hit.distance, ray.far) * (1.0f + 1e-6f);
  }
}

// Whether the surface is still where a start was found, or the background: things move.
bool Tracer::stands(const EyePathStart& start, uint64_t& rays) const {
  if (start.there == 0) return true;
  const float reach = 4 * rays_.epsilon();
  Ray ray;
  ray.origin = start.position + reach * start.face;
  ray.direction = -start.face;
  ray.far = 2 * reach;
  ++rays;
  return bool(rays_.intersect(ray));
}

Vertex Tracer::arrive(glm::vec3 origin, glm::vec3 direction, uint64_t& rays) const {
  ++rays;
  const RayHit hit = rays_.intersect({origin, direction});
  return hit ? vertexAt(hit, direction) : Vertex{};
}

glm::vec3 Tracer::irradiance(const Vertex& v, uint64_t& rays) const {
  glm::vec3 sum(0);
  for (const Light& light : frame_.lights) {
    const LightSample l = sampleLight(light, v.position);
    const float cosine = glm::dot(v.normal, l.direction);
    if (cosine <= 0 || glm::dot(v.face, l.direction) <= 0 || l.irradiance == glm::vec3(0)) continue;
    Ray ray;
    ray.origin = v.origin;
    ray.direction = l.direction;
    if (l.distance < kFarAway) ray.far = l.distance * kShadowEnd;
    ++rays;
    if (!rays_.occluded(ray)) sum += l.irradiance * cosine;
  }
  return sum;
}

glm::vec3 Tracer::direct(const Vertex& v, glm::vec3 rho, uint64_t& rays) const {
  glm::vec3 sum = rho * glm::one_over_pi<float>() * irradiance(v, rays);
  if (shines_) sum += emission(*frame_.scene, *v.material, v.uv);
  return sum;
}

// Mean radiance that reaches v over its hemisphere, in proportion to the cosine, after `bounces` reflections
// at most.
glm::vec3 Tracer::gather(const Vertex& v, uint32_t bounces, uint32_t count, uint32_t stream,
                         uint64_t& rays) const {
  glm::vec3 sum(0);
  for (uint32_t i = 0; i < count; ++i) {
    const glm::vec3 direction = cosineDirection(v.normal, streamSequence(stream, i));
    if (glm::dot(direction, v.face) <= 0) continue;
    const Vertex next = arrive(v.origin, direction, rays);
    if (!next.there) continue;
    const glm::vec3 rho(reflectance(*frame_.scene, *next.material, next.uv));
    sum += direct(next, rho, rays);
    if (bounces > 1) sum += rho * gather(next, bounces - 1, 1, hashCombine(stream, i + 2), rays);
  }
  return sum / float(count);
}

EyePathEnd Tracer::end(const EyePathStart& start, uint32_t point, uint32_t turn, uint64_t& rays) const {
  EyePathEnd end;
  const glm::vec3 direction =
      cosineDirection(start.normal, streamSequence(randomStream(0, 0, kPathStream, point), turn));
  if (glm::dot(direction, start.face) <= 0) return end;
  const glm::vec3 origin =
      start.position + (start.face - glm::normalize(start.position - view_.eye)) * rays_.epsilon();
  const Vertex v = arrive(origin, direction, rays);
  if (!v.there) return end;
  const glm::vec3 rho(reflectance(*frame_.scene, *v.material, v.uv));
  end.radiance = direct(v, rho, rays);
  end.kind = end.radiance == glm::vec3(0) ? 1.0f : 2.0f;
  if (settings_.bounces > 1)
    end.radiance += rho * gather(v, settings_.bounces - 1, settings_.gathered,
                                 randomStream(turn, 0, kGatherStream, point), rays);
  end.position = v.position;
  end.normal = v.face;
  end.luminance = glm::dot(end.radiance, kLuminance);
  return end;
}

}  // namespace

float sumUnit(std::span<const EyePathEnd> ends) {
  glm::dvec3 sum(0);
  for (const EyePathEnd& e : ends) sum += glm::dvec3(e.radiance);
  return float(std::max({sum.r, sum.g, sum.b}) / 2147483648.0);
}

EyePathStatistics traceEyePaths(const Frame& frame, const View& view, const RayScene& rays,
                                const EyePathSettings& settings, const EyePathLists& lists) {
  const Tracer tracer(frame, view, rays, settings);
  const std::span<EyePathEnd> ends = lists.ends;
  const uint32_t points = uint32_t(lists.starts.size()), renew = std::max(settings.renewFrames, 1u);
  const Fovea fovea = makeFovea(view.gaze, glm::vec2(view.size), settings.foveaRadius);
  std::atomic<uint32_t> next = 0;
  std::atomic<uint64_t> traced = 0;
  // All paths of one point after each other: its start is found once.
  const auto work = [&] {
    uint64_t count = 0;
    for (uint32_t first = next.fetch_add(kPointsAtOnce); first < points;
         first = next.fetch_add(kPointsAtOnce))
      for (uint32_t point = first; point < std::min(first + kPointsAtOnce, points); ++point) {
        EyePathStart& start = lists.starts[point];
        if (point % renew == settings.turn % renew || !tracer.stands(start, count))
          start = tracer.look(
              glm::vec2(screenPoint(settings.region, point, points, fovea, glm::ivec2(view.size))) + 0.5f,
              count);
        for (uint32_t path = point, turn = 0; path < ends.size(); path += points, ++turn)
          ends[path] = start.there > 0 ? tracer.end(start, point, turn, count) : EyePathEnd{};
      }
    traced += count;
  };
  {
    const uint32_t cores =
        std::max(settings.threads != 0 ? settings.threads : std::thread::hardware_concurrency(), 1u);
    std::vector<std::jthread> helpers;
    for (uint32_t i = 1; i < std::min(cores, (points + kPointsAtOnce - 1) / kPointsAtOnce); ++i)
      helpers.emplace_back(work);
    work();
  }
  EyePathStatistics statistics{traced, 0};
  const float unit = sumUnit(ends);
  for (EyePathEnd& e : ends) {
    e.unit = unit;
    statistics.ends += e.kind > 0;
  }
  return statistics;
}

}  // namespace fovea::passes
