#include "passes/eye-paths-host/eye_path_tracer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>
#include <vector>

#include "framework/base/random.h"
#include "framework/base/threads.h"
#include "framework/scene/lights.h"
#include "framework/scene/rays/surface_tracer.h"
#include "framework/shader_twins/fovea.h"
#include "shaders/records/rays.h"

namespace fovea::passes {
namespace {

using namespace scene;

constexpr uint32_t kPointsAtOnce = 16;  // points that a thread takes at a time

float meanChannel(glm::vec3 colour) { return (colour.r + colour.g + colour.b) / 3; }

// How much light some paths find now differs from what they found before.
struct Difference {
  void add(const EyePathEnd& before, const EyePathEnd& now) {
    const float a = lightOf(before), b = lightOf(now);
    changed += std::abs(b - a);
    gained += double(b) - double(a);
    larger += std::max(a, b);
  }
  Difference operator+(const Difference& other) const {
    return {changed + other.changed, gained + other.gained, larger + other.larger};
  }
  // In [0, 1]; 0 where there is no light, or none that is a number.
  double share() const { return changed / larger > 0 ? std::min(changed / larger, 1.0) : 0; }

  double changed = 0, gained = 0, larger = 0;

 private:
  static float lightOf(const EyePathEnd& end) { return meanChannel(end.radiance) * end.weight; }
};

// EyePathStatistics::drift of the differences at all points and their sum. If their signs were random, the square of
// the sum would on average be the sum of the squares.
double driftOf(std::span<const Difference> differences, const Difference& sum) {
  double squares = 0;
  for (const Difference& d : differences) squares += d.gained * d.gained;
  const double drift = std::sqrt(std::max(sum.gained * sum.gained - squares, 0.0)) / sum.larger;
  return drift > 0 ? std::min(drift, 1.0) : 0;
}

class Tracer {
 public:
  Tracer(const Frame& frame, const View& view, const RayScene& rays, const EyePathSettings& settings)
      : view_(view),
        geometry_(*frame.geometry),
        rays_(rays),
        settings_(settings),
        seed_(frame.seed),
        surfaces_(frame, view, rays, settings.fullMaterials) {}

  EyePathStart look(glm::vec2 pixel, uint64_t& rays) const {
    const TracedSurface v = surfaces_.look(pixel, rays);
    return v.there ? EyePathStart{v.position, 1, v.normal, 0, v.face, 0} : EyePathStart{};
  }
  bool stands(EyePathStart& start, uint64_t& rays) const;
  bool belongs(const EyePathStart& start, glm::vec2 pixel, uint64_t& rays) const;
  // Traces all paths of a point anew.
  Difference tracePaths(const EyePathLists& lists, uint32_t point, uint64_t& rays) const;

 private:
  // Path `turn` of the `paths` that leave a start.
  EyePathEnd end(const EyePathStart& start, uint32_t point, uint32_t turn, uint32_t paths,
                 uint64_t& rays) const;

  const View& view_;
  const Geometry& geometry_;
  const RayScene& rays_;
  const EyePathSettings& settings_;
  uint32_t seed_;
  SurfaceTracer surfaces_;
};

// Whether the surface (or the background) is still where the start was found, as objects may have moved. The start
// follows one that moves or turns slowly: paths from below it would meet its inside.
bool Tracer::stands(EyePathStart& start, uint64_t& rays) const {
  if (start.there == 0) return true;
  const float reach = 4 * rays_.epsilon();
  Ray ray;
  ray.origin = start.position + reach * start.face;
  ray.direction = -start.face;
  ray.far = 2 * reach;
  ++rays;
  const RayHit hit = rays_.intersect(ray);
  if (!hit) return false;
  const SurfaceHit found = surfaceAt(geometry_, hit);
  const float side = glm::dot(found.geometricNormal, start.face) < 0 ? -1.0f : 1.0f;
  const glm::vec3 face = side * found.geometricNormal;
  const float risen = reach - hit.distance;
  if (face == start.face && std::abs(risen) <= kStill * rays_.epsilon()) return true;
  start = {start.position + risen * start.face, 1, side * found.shadingNormal, 0, face, 0};
  return glm::dot(face, ray.direction) < -kSameFace;
}

// Whether the eye still sees the start, and close to `pixel`, where it belongs.
bool Tracer::belongs(const EyePathStart& start, glm::vec2 pixel, uint64_t& rays) const {
  if (settings_.stray == 0 || start.there == 0) return false;
  const glm::vec4 clip = view_.worldToClip * glm::vec4(start.position, 1);
  if (!(clip.w > 0)) return false;
  const glm::vec2 size(view_.size), at = (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * size;
  const bool inside = glm::all(glm::greaterThanEqual(at, glm::vec2(0))) && glm::all(glm::lessThan(at, size));
  if (!inside || glm::distance(at, pixel) > settings_.stray * size.x) return false;
  const TracedSurface v = surfaces_.look(at, rays);
  const float reach = std::max(4 * rays_.epsilon(), kSamePlace * glm::distance(start.position, view_.eye));
  return v.there && glm::distance(v.position, start.position) <= reach;
}

EyePathEnd Tracer::end(const EyePathStart& start, uint32_t point, uint32_t turn, uint32_t paths,
                       uint64_t& rays) const {
  EyePathEnd end;
  TracedSurface from;
  from.position = start.position;
  from.normal = start.normal;
  from.face = start.face;
  from.origin = start.position + (start.face - glm::normalize(start.position - view_.eye)) * rays_.epsilon();
  const uint32_t stream = randomStream(seed_, 0, kEyePathStream, point);
  const bool shines = !surfaces_.emitters().empty() && settings_.emission;
  const uint32_t aimed = shines ? paths / kAimedShare : 0, others = paths - aimed;
  const bool isAimed = turn >= others;
  SurfaceTracer::EmitterRay aim;
  if (isAimed) aim = surfaces_.towardsEmitter(from, hashCombine(stream, turn));
  if (isAimed && !aim.there) return end;
  const glm::vec3 direction =
      isAimed ? aim.direction : cosineDirection(start.normal, streamSequence(stream, turn));
  if (glm::dot(direction, start.face) <= 0) return end;
  const TracedSurface v = surfaces_.arrive(from.origin, direction, kFarAway, rays);
  if (!v.there || (isAimed && v.triangle != aim.triangle)) return end;
  const glm::vec3 rho = surfaces_.reflectance(v),
                  emitted = settings_.emission ? surfaces_.emitted(v) : glm::vec3(0);
  const Reflection reflection = surfaces_.reflection(v, -direction, rho, kBounceRoughness);
  end.radiance = surfaces_.direct(v, reflection, rays);
  end.kind = meanChannel(emitted) > meanChannel(end.radiance) ? 3.0f
             : end.radiance == glm::vec3(0)                   ? 1.0f
                                                              : 2.0f;
  const glm::vec3 gathered = surfaces_.passedOn(v, reflection, settings_.bounces - 1, settings_.gathered,
                                                randomStream(seed_, turn, kPathGatherStream, point), rays);
  if (surfaces_.hasEmitters() && end.kind < 3 && meanChannel(gathered) > meanChannel(end.radiance))
    end.kind = 4;
  end.radiance += emitted + gathered;
  end.position = v.position;
  end.normal = v.face;
  end.weight = 1;
  if (aimed == 0) return end;
  const float cosine = glm::dot(start.normal, direction) * glm::one_over_pi<float>();
  end.weight =
      float(paths) * cosine / (float(others) * cosine + float(aimed) * surfaces_.emitterDensity(from, v));
  return end;
}

Difference Tracer::tracePaths(const EyePathLists& lists, uint32_t point, uint64_t& rays) const {
  const uint32_t points = uint32_t(lists.starts.size()),
                 paths = (uint32_t(lists.ends.size()) - point + points - 1) / points;
  const EyePathStart& start = lists.starts[point];
  Difference difference;
  for (uint32_t turn = 0; turn < paths; ++turn) {
    EyePathEnd& before = lists.ends[turn * points + point];
    const EyePathEnd now = start.there > 0 ? end(start, point, turn, paths, rays) : EyePathEnd{};
    difference.add(before, now);
    before = now;
  }
  return difference;
}

}  // namespace

float sumUnit(std::span<const EyePathEnd> ends) {
  glm::dvec3 sum(0);
  for (const EyePathEnd& e : ends) sum += glm::dvec3(e.radiance) * double(e.weight);
  return float(std::max({sum.r, sum.g, sum.b}) / double(kChannelSum));
}

EyePathStatistics traceEyePaths(const Frame& frame, const View& view, const RayScene& rays,
                                const EyePathSettings& settings, const EyePathLists& lists) {
  const Tracer tracer(frame, view, rays, settings);
  const std::span<EyePathEnd> ends = lists.ends;
  const uint32_t points = uint32_t(lists.starts.size()), renew = std::max(settings.renewFrames, 1u),
                 trace = std::max(settings.traceFrames, 1u);
  const Fovea fovea = makeFovea(view.gaze, glm::vec2(view.size), settings.foveaRadius);
  std::atomic<uint64_t> traced = 0;
  // Calls work(point, rays) for all points.
  const auto forPoints = [&](const auto& work) {
    std::atomic<uint32_t> next = 0;
    onThreads(std::min(threadCount(settings.threads), (points + kPointsAtOnce - 1) / kPointsAtOnce), [&] {
      uint64_t count = 0;
      for (uint32_t first = next.fetch_add(kPointsAtOnce); first < points;
           first = next.fetch_add(kPointsAtOnce))
        for (uint32_t point = first; point < std::min(first + kPointsAtOnce, points); ++point)
          work(point, count);
      traced += count;
    });
  };

  std::vector<Difference> differences(points);
  std::vector<uint8_t> waits(points);
  forPoints([&](uint32_t point, uint64_t& count) {
    EyePathStart& start = lists.starts[point];
    const glm::vec2 pixel = glm::vec2(screenPoint(settings.region, settings.imageShare64ths, point, points,
                                                  fovea, glm::ivec2(view.size))) +
                            0.5f;
    const bool due = point % renew == settings.turn % renew;
    const bool anew = (due && !tracer.belongs(start, pixel, count)) || !tracer.stands(start, count);
    if (anew) start = tracer.look(pixel, count);
    waits[point] = !anew && point % trace != settings.turn % trace;
    if (waits[point]) return;
    const Difference difference = tracer.tracePaths(lists, point, count);
    if (!anew) differences[point] = difference;
  });
  EyePathStatistics statistics;
  const Difference sum = std::accumulate(differences.begin(), differences.end(), Difference{});
  statistics.change = sum.share();
  statistics.drift = driftOf(differences, sum);
  if (const double share = double(kOutOfTurn) * (statistics.change - settings.usualChange); share > 0)
    forPoints([&](uint32_t point, uint64_t& count) {
      if (waits[point] && uniformFloat(point * kGoldenRatio) < share) tracer.tracePaths(lists, point, count);
    });
  statistics.rays = traced;
  const float unit = sumUnit(ends);
  for (EyePathEnd& e : ends) {
    e.unit = unit;
    statistics.ends += e.kind > 0;
  }
  return statistics;
}

}  // namespace fovea::passes
