// Initial samples of ReSTIR GI (Ouyang et al., "ReSTIR GI: Path Resampling for Real-Time Path Tracing", HPG 2021,
// Sec. 4.1): what a ray from each visible surface meets, and the light found there.
#include <algorithm>
#include <atomic>
#include <glm/gtc/constants.hpp>

#include "fovea/pass.h"
#include "framework/base/random.h"
#include "framework/base/threads.h"
#include "framework/base/weighted_choice.h"
#include "framework/scene/frame.h"
#include "framework/scene/lights.h"
#include "framework/scene/rays/surface_tracer.h"
#include "framework/shader_twins/fovea.h"
#include "passes/gi-samples-host/gi_samples_ports.h"
#include "passes/materials.h"
#include "passes/near-field-host/near_field_tracer.h"
#include "shaders/common/records/reservoir.h"

namespace fovea::passes {
namespace {

using namespace graph;

// Where surfaces shine, or the environment does, each path has a second ray that is aimed at them. One of all rays of a
// pixel is chosen by resampling, weighted by the balance heuristic (Veach and Guibas 1995).
class Sampler {
 public:
  Sampler(const scene::Frame& frame, const scene::View& view, const scene::RayScene& rays, bool fullMaterials,
          uint32_t depth, uint32_t paths, uint32_t turn)
      : surfaces_(frame, view, rays, fullMaterials),
        seed_(frame.seed),
        depth_(depth),
        paths_(paths),
        turn_(turn) {}

  Reservoir sampleAt(glm::uvec2 pixel, uint64_t& rays) const {
    const scene::TracedSurface v = surfaces_.look(glm::vec2(pixel) + 0.5f, rays);
    if (!v.there) return {};
    const uint32_t stream = randomStream(seed_, pixel.x, kGiSampleStream, pixel.y);
    Choice choice{WeightedChoice(uniformFloat(randomStream(stream, turn_, kGiChoiceStream, 0)))};
    for (uint32_t path = turn_ * paths_; path < (turn_ + 1) * paths_; ++path) {
      const uint32_t gatherStream = randomStream(stream, path, kGiGatherStream, 0);
      const glm::vec3 bounce = scene::cosineDirection(v.normal, scene::streamSequence(stream, path));
      consider(choice, v, bounce, nullptr, gatherStream, rays);
      if (!surfaces_.hasEmitters()) continue;
      const auto aim = surfaces_.towardsEmitter(v, randomStream(stream, path, kGiAimStream, 0));
      if (aim.there) consider(choice, v, aim.direction, &aim, hashCombine(gatherStream, 1), rays);
    }
    choice.sample.count = 1;
    if (choice.among.any())
      choice.sample.weight = choice.among.inverseProbability() / (choice.density * float(paths_));
    return choice.sample;
  }

 private:
  struct Choice {
    WeightedChoice among;
    Reservoir sample;   // the one chosen
    float density = 1;  // with which the rays of a path go there, per sr
  };

  // aim: what the ray is aimed at, if anything. A ray that meets something else instead does not count.
  void consider(Choice& choice, const scene::TracedSurface& v, glm::vec3 direction,
                const scene::SurfaceTracer::EmitterRay* aim, uint32_t stream, uint64_t& rays) const {
    const float cosine = glm::dot(v.normal, direction);
    if (cosine <= 0 || glm::dot(v.face, direction) <= 0) return;
    const scene::TracedSurface hit = surfaces_.arrive(v.origin, direction, scene::kFarAway, rays);
    if (aim != nullptr && hit.triangle != aim->triangle) return;
    Reservoir sample;
    float density = cosine * glm::one_over_pi<float>();
    if (hit.isOutside()) {
      const scene::SurfaceTracer::Outside outside = surfaces_.outside(direction);
      sample.position = v.position + kSky * direction;
      sample.normal = -direction;
      sample.radiance = hit.brighter * outside.radiance;
      density += outside.density;
    } else if (hit.there) {
      sample.position = hit.position;
      sample.normal = hit.face;
      sample.radiance = radianceOf(hit, stream, rays);
      density += surfaces_.emitterDensity(v, hit);
    }
    const float target = glm::dot(sample.radiance, kLuminance) * cosine;
    if (!(target > 0) || !choice.among.takes(target / density)) return;
    choice.sample = sample;
    choice.density = density;
  }

  // Light that leaves a surface by paths of at most `depth` edges to the eye, of which two are known.
  glm::vec3 radianceOf(const scene::TracedSurface& hit, uint32_t stream, uint64_t& rays) const {
    const glm::vec3 rho = surfaces_.reflectance(hit);
    return surfaces_.emitted(hit) + surfaces_.direct(hit, scene::Reflection(rho), rays) +
           rho * surfaces_.gather(hit, depth_ - 3, 1, stream, rays);
  }

  scene::SurfaceTracer surfaces_;
  uint32_t seed_, depth_, paths_, turn_;
};

class GiSamplesHost : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("gi-samples-host",
                      "one sample of the indirect light of each pixel: a ray, what it meets, and the light "
                      "that leaves from there; on the CPU",
                      PassKind::Host);
    declareGiSamples(d, Usage::HostWrite);
    return d;
  }

  void execute(HostContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const Parameters& p = ctx.parameters();
    const auto reservoirs = ctx.outputAs<Reservoir>("reservoirs");
    std::ranges::fill(reservoirs, Reservoir{});
    if (frame.scene == nullptr || frame.geometry == nullptr || frame.geometry->empty()) return;
    const glm::uvec2 size = ctx.view().size;
    const uint32_t inside = uint32_t(p.integer("spacing")), turn = uint32_t(ctx.frameNumber()),
                   outside = std::max(inside, uint32_t(p.integer("outside_spacing")));
    const scene::Fovea fovea = scene::makeFovea(ctx.view().gaze, size, ctx.view().foveaRadius);
    const auto rays = scene::RayScene::cached(*frame.scene, *frame.geometry, passingOf(p));
    const Sampler sampler(frame, ctx.view(), *rays, fullMaterials(p), uint32_t(p.integer("depth")),
                          uint32_t(p.integer("paths")), turn);
    std::atomic<uint32_t> next = 0;
    std::atomic<uint64_t> traced = 0, samples = 0;
    onThreads(std::min(threadCount(0), size.y), [&] {
      uint64_t count = 0, found = 0;
      for (uint32_t y = next++; y < size.y; y = next++)
        for (uint32_t x = 0; x < size.x; ++x) {
          const glm::uvec2 pixel(x, y);
          const bool seen = glm::distance(glm::vec2(pixel) + 0.5f, fovea.centre) <= fovea.radius;
          const uint32_t spacing = seen ? inside : outside;
          const glm::uvec2 block = pixel / spacing;
          if (pixel != spacing * block + samplePixel(turn, spacing, block)) continue;
          Reservoir& reservoir = reservoirs[size_t(y) * size.x + x];
          reservoir = sampler.sampleAt(pixel, count);
          found += reservoir.count > 0;
        }
      traced += count;
      samples += found;
    });
    ctx.counter("rays", double(traced));
    ctx.counter("samples", double(samples));
  }
};

FOVEA_PASS(GiSamplesHost);

}  // namespace
}  // namespace fovea::passes
