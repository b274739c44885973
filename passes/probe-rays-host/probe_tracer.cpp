#include "passes/probe-rays-host/probe_tracer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include "framework/base/random.h"
#include "framework/base/threads.h"
#include "framework/scene/lights.h"
#include "framework/scene/rays/surface_tracer.h"
#include "framework/shader_twins/fovea.h"

namespace fovea::passes {
namespace {

using namespace scene;

constexpr uint32_t kProbesAtOnce = 8;  // probes that a thread takes at a time

// A uniformly distributed rotation (Shoemake, "Uniform Random Rotations", Graphics Gems III, 1992).
glm::mat3 randomRotation(uint32_t stream) {
  const auto number = [&](uint32_t i) { return uniformFloat(hashCombine(stream, i)); };
  const float a = std::sqrt(1 - number(0)), b = std::sqrt(number(0)), u = glm::two_pi<float>() * number(1),
              v = glm::two_pi<float>() * number(2);
  return glm::mat3_cast(glm::quat(b * std::cos(v), a * std::sin(u), a * std::cos(u), b * std::sin(v)));
}

class Tracer {
 public:
  Tracer(const Frame& frame, const View& view, const RayScene& rays, const ProbeRaySettings& settings)
      : surfaces_(frame, view, rays, settings.fullMaterials),
        field_(settings.grid, settings.previous, settings.bias),
        feedback_(settings.feedback),
        stream_(randomStream(frame.seed, uint32_t(frame.index), kProbeEmitterStream, 0)) {}

  // What ray `index` of all finds.
  glm::vec4 hitOf(glm::vec3 origin, glm::vec3 direction, uint32_t index, uint64_t& rays) const {
    const TracedSurface v = surfaces_.arrive(origin, direction, kFarAway, rays);
    if (v.isOutside()) return {v.brighter * surfaces_.outside(direction).radiance, kFarAway};
    const float distance = glm::distance(v.position, origin);
    if (!v.there) return {glm::vec3(0), -kBackShortened * distance};
    const glm::vec3 rho = surfaces_.reflectance(v), light = lightAt(v, -direction, index, rays);
    return {surfaces_.emitted(v) + surfaces_.direct(v, Reflection(rho), rays) + rho * light, distance};
  }

 private:
  // Irradiance / pi that does not come from the scene's lights. What the probes knew after the previous frame has one
  // bounce more in each frame.
  glm::vec3 lightAt(const TracedSurface& v, glm::vec3 towardsEye, uint32_t index, uint64_t& rays) const {
    return feedback_ ? field_.light(v.position, v.normal, towardsEye)
                     : surfaces_.gather(v, 0, 1, hashCombine(stream_, index), rays);
  }

  SurfaceTracer surfaces_;
  ProbeField field_;
  bool feedback_;
  uint32_t stream_;
};

// Whether a probe lights points that the eye may see in the fovea: those less than a cell away from its own cell's
// centre, and the bias off their surface.
class InFovea {
 public:
  InFovea(const View& view, const ProbeRaySettings& settings)
      : view_(view),
        fovea_(makeFovea(view.gaze, glm::vec2(view.size), settings.foveaRadius)),
        reach_((std::sqrt(3.0f) + settings.bias) * settings.grid.spacing) {
    for (size_t i = 0; i < rim_.size(); ++i) {
      const float a = glm::two_pi<float>() * float(i) / float(rim_.size());
      rim_[i] = glm::normalize(
          view.rayDirection(fovea_.centre + fovea_.radius * glm::vec2(std::cos(a), std::sin(a))));
    }
  }

  bool operator()(glm::vec3 centre) const {
    const glm::vec3 to = centre - view_.eye;
    const float distance = glm::length(to);
    if (distance <= reach_) return true;
    const glm::vec4 clip = view_.worldToClip * glm::vec4(centre, 1);
    const glm::vec2 pixel = glm::vec2(view_.size) * (0.5f * glm::vec2(clip) / clip.w + 0.5f);
    if (clip.w > 0 && glm::distance(pixel, fovea_.centre) <= fovea_.radius) return true;
    // The sphere around the probe meets the cone of the fovea where the angle to its rim is below that of the sphere.
    const float least = std::sqrt(distance * distance - reach_ * reach_);
    return std::ranges::any_of(rim_, [&](glm::vec3 d) { return glm::dot(d, to) >= least; });
  }

 private:
  const View& view_;
  Fovea fovea_;
  float reach_;                    // m
  std::array<glm::vec3, 64> rim_;  // unit
};

}  // namespace

void probeDirections(uint32_t seed, uint32_t frame, std::span<glm::vec4> directions) {
  const glm::mat3 turn = randomRotation(randomStream(seed, frame, kProbeTurnStream, 0));
  const double golden = glm::golden_ratio<double>() - 1;
  for (size_t i = 0; i < directions.size(); ++i) {
    const double z = 1 - (2 * double(i) + 1) / double(directions.size()), r = std::sqrt(1 - z * z),
                 phi = glm::two_pi<double>() * glm::fract(double(i) * golden);
    directions[i] = glm::vec4(turn * glm::vec3(r * std::cos(phi), r * std::sin(phi), z), 0);
  }
}

ProbeRayStatistics traceProbeRays(const Frame& frame, const View& view, const RayScene& rays,
                                  const ProbeRaySettings& settings, std::span<const glm::vec4> directions,
                                  std::span<glm::vec4> hits) {
  const Tracer tracer(frame, view, rays, settings);
  const InFovea inFovea(view, settings);
  const uint32_t probes = probesOf(settings.grid), count = uint32_t(directions.size());
  std::atomic<uint32_t> next = 0;
  std::atomic<uint64_t> traced = 0, inside = 0;
  onThreads(threadCount(settings.threads), [&] {
    uint64_t sum = 0, off = 0;
    for (uint32_t first = next.fetch_add(kProbesAtOnce); first < probes;
         first = next.fetch_add(kProbesAtOnce))
      for (uint32_t probe = first; probe < std::min(first + kProbesAtOnce, probes); ++probe) {
        const Probe& state = settings.previous.states[probe];
        const glm::vec3 origin = probePosition(settings.grid, probe, state);
        const bool outside = settings.outsideShare > 1 && !inFovea(probePosition(settings.grid, probe, {}));
        const uint32_t step =
            std::max(state.inside > 0 ? kInsideShare : 1u, outside ? settings.outsideShare : 1u);
        off += state.inside > 0;
        const auto of = hits.subspan(size_t(probe) * count, count);
        for (uint32_t i = 0; i < count; ++i)
          of[i] = i % step == 0 ? tracer.hitOf(origin, glm::vec3(directions[i]), probe * count + i, sum)
                                : glm::vec4(0);
      }
    traced += sum;
    inside += off;
  });
  return {traced, inside};
}

}  // namespace fovea::passes
