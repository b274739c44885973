// Light from nearby surfaces, which VPLs shaded as discs leave out.
#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/near-field-host/near_field_ports.h"
#include "passes/near-field-host/near_field_tracer.h"
#include "shaders/common/records/near_field.h"

namespace fovea::passes {
namespace {

using namespace graph;

// Rays per sample in the fovea, `most` if all of its history is lost.
uint32_t raysAfterChange(uint32_t most, float lost) {
  return uint32_t(std::lround(glm::mix(1.0f, float(most), lost)));
}

// Stands for the mean length of rays as long as no surface sees another: what the sky sends is found all the same.
double diagonal(const scene::Geometry& g) { return double(glm::distance(g.boundsMin, g.boundsMax)); }

class NearFieldHost : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "near-field-host",
        "light from nearby surfaces, in the part that VPLs shaded as discs take from it, and all "
        "light that comes straight from surfaces that shine and from an environment map, found with a "
        "few rays per frame through the triangles on the CPU",
        PassKind::Host);
    d.view();
    declareNearField(d, Usage::HostRead, Usage::HostWrite);
    return d;
  }

  void prepare(PrepareContext& ctx) override { checkNearField(ctx, "near-field-host"); }

  void execute(HostContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const Parameters& p = ctx.parameters();
    const bool first = ctx.firstFrame();
    const auto samples = ctx.outputAs<uint64_t>("samples");
    image_.resize(samples.size());
    NearFieldSettings settings;
    settings.foveaRadius = nearFieldFovea(ctx.view(), p);
    settings.spacing = uint32_t(p.integer("spacing"));
    settings.bounces = uint32_t(p.integer("bounces"));
    settings.emitterPoints = uint32_t(p.integer("emitter_points"));
    settings.turn = uint32_t(ctx.frameNumber());
    settings.seed = frame.seed;
    settings.fullMaterials = fullMaterials(p);
    settings.mapAlone = p.text("light") == "map";
    checkGBufferSize(ctx, "near-field-host", ctx.view().size);
    if (ctx.has("gbuffer")) {
      settings.normal = ctx.inputAs<uint64_t>("gbuffer.normal");
      settings.specular = ctx.inputAs<uint64_t>("gbuffer.specular");
    }
    gloss_.resize(settings.fullMaterials ? samples.size() : 0);
    NearFieldStatistics statistics;
    double area = 0;
    if (p.text("light") != "none" && frame.scene != nullptr && frame.geometry != nullptr &&
        !frame.geometry->empty()) {
      const auto rays = scene::RayScene::cached(*frame.scene, *frame.geometry, passingOf(p));
      const glm::vec4 change = ctx.has("change") ? ctx.inputAs<glm::vec4>("change")[0] : glm::vec4(0);
      settings.cache = &cache_;
      cache_.age(change.y);
      const auto trace = [&](double length) {
        area = p.real("share") * length * length / double(p.integer("vpls"));
        settings.area = float(area);
        settings.cellWidth = float(kNearCellWidth * length);
        return traceNearField(frame, ctx.view(), *rays, settings, image_, gloss_);
      };
      const auto knownLength = [&] { return length_ > 0 ? length_ : diagonal(*frame.geometry); };
      if (first) {  // first the length alone, then the cache
        length_ = 0;
        cache_.clear();
        if (!settings.mapAlone) learnLength(trace(0));
        settings.samples = uint32_t(p.integer("first_samples"));
        if (!settings.mapAlone) trace(knownLength());
      } else {
        settings.foveaFactor =
            raysAfterChange(uint32_t(p.integer("saccade_samples")), frame.saccade > 0 ? 1 : change.z);
      }
      statistics = trace(knownLength());
      learnLength(statistics);
    } else {
      std::ranges::fill(image_, glm::vec4(0));
      std::ranges::fill(gloss_, glm::vec4(0));
    }
    const auto halves = [](glm::vec4 v) {
      return glm::packHalf4x16(glm::vec4(glm::min(glm::vec3(v), 65504.0f), v.a));
    };
    std::ranges::transform(image_, samples.begin(), halves);
    if (!gloss_.empty()) std::ranges::transform(gloss_, ctx.outputAs<uint64_t>("gloss").begin(), halves);
    ctx.outputAs<glm::vec4>("spread")[0] = glm::vec4(area, 0, 0, 0);
    ctx.counter("rays", double(statistics.rays));
    ctx.counter("shaded", double(statistics.shaded));
    ctx.counter("gathered", double(statistics.gathered));
  }

 private:
  void learnLength(const NearFieldStatistics& statistics) {
    if (!(statistics.hits > 0)) return;
    const double length = statistics.length / statistics.hits;
    length_ = length_ > 0 ? kLengthKept * length_ + (1 - kLengthKept) * length : length;
  }

  double length_ = 0;  // m, mean ray length of the frames so far; 0 as long as no ray has met anything
  GatherCache cache_;  // of the frames so far
  std::vector<glm::vec4> image_, gloss_;
};

FOVEA_PASS(NearFieldHost);

}  // namespace
}  // namespace fovea::passes
