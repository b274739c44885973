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
#include "passes/near-field/near_field_tracer.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr double kLengthKept = 7 / 8.0;  // share of the mean ray length kept from frame to frame
constexpr double kCellWidth = 0.1;       // width of the cache's cells, in mean ray lengths

// Rays per sample in the fovea, `most` if all of its history is lost.
uint32_t raysAfterChange(uint32_t most, float lost) {
  return uint32_t(std::lround(glm::mix(1.0f, float(most), lost)));
}

// Stands for the mean length of rays as long as no surface sees another: what the sky sends is found all the same.
double diagonal(const scene::Geometry& g) { return double(glm::distance(g.boundsMin, g.boundsMax)); }

class NearField : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "near-field",
        "light from nearby surfaces, in the part that VPLs shaded as discs take from it, and all "
        "light that comes straight from surfaces that shine and from an environment map, found with a "
        "few rays per frame through the triangles",
        PassKind::Host);
    d.view();
    d.input(
         "change", changeBuffer(), Usage::HostRead,
         "y: s, after which n rays gathered before are worth n / (1 + n s), as light has changed; z: share "
         "of their history that samples have lost (pass eye-paths)")
        .makeOptional();
    d.output("samples",
             image2D(VK_FORMAT_R16G16B16A16_SFLOAT, ceilDiv(viewWidth(), 2), ceilDiv(viewHeight(), 2)),
             Usage::HostWrite,
             "rgb: irradiance / pi, W/(sr m^2), at one pixel of each 2 x 2 block, or of each `spacing` x "
             "`spacing` block outside the fovea; a: code of the sampled pixel and of whether it shows a "
             "surface, for pass temporal-accumulation");
    d.output("spread", spreadBuffer(), Usage::HostWrite,
             "x: least area of a VPL's disc, m^2, for pass vpl-intensity");
    d.parameter("fovea_radius", real(0.25, 0.001, 4, "image widths"), "radius of the fovea");
    d.parameter("spacing", integer(4, 2, 8), "spacing of the rays outside the fovea: 2, 4 or 8");
    d.parameter("vpls", integer(1000, 1, 1 << 20), "number of VPLs");
    d.parameter("share", real(50, 0.01, 1e6),
                "total area of all discs, in squares of the mean distance between visible surfaces and the "
                "surfaces seen from them, or of the diagonal of the scene where no surface sees another");
    d.parameter(
        "bounces", integer(2, 1, 64),
        "reflections of the light before it reaches the visible surface; 2 matches a path tracer of depth 4");
    d.parameter("first_samples", integer(16, 1, 1024),
                "rays per sample after a camera cut, when there is no history to build on");
    d.parameter("saccade_samples", integer(1, 1, 16),
                "rays per sample in the fovea for 8 frames after a jump of the gaze, as the history of a new "
                "fovea is that of wide blocks, and up to so many when light changes");
    d.parameter(
        "emitter_points", integer(4, 1, 64),
        "points on surfaces that shine and in an environment map, of which the ray aimed at them chooses "
        "one; for a map there are as many cosine-weighted ones beside them");
    d.parameter("light", choice("all", {"none", "map", "all"}),
                "`map` brings the light of the scene's environment map alone, `none` nothing");
    declareMaterials(d, "`full` lets metals keep their colour");
    d.counter("rays", "rays traced, including those towards lights");
    d.counter("shaded", "rays from visible surfaces at whose ends the light was evaluated");
    d.counter("gathered",
              "those of them at whose ends light of further bounces was gathered rather than known");
    return d;
  }

  void execute(HostContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const Parameters& p = ctx.parameters();
    const bool first = ctx.firstFrame();
    const auto samples = ctx.outputAs<uint64_t>("samples");
    image_.resize(samples.size());
    NearFieldSettings settings;
    settings.foveaRadius = float(p.real("fovea_radius"));
    settings.spacing = uint32_t(p.integer("spacing"));
    if (!std::has_single_bit(settings.spacing))
      throw Error(ExitCode::BadInput,
                  "pass `near-field`: spacing " + std::to_string(settings.spacing) + " is not a power of two",
                  "use 2, 4 or 8");
    settings.bounces = uint32_t(p.integer("bounces"));
    settings.emitterPoints = uint32_t(p.integer("emitter_points"));
    settings.turn = uint32_t(ctx.frameNumber());
    settings.seed = frame.seed;
    settings.fullMaterials = fullMaterials(p);
    settings.mapAlone = p.text("light") == "map";
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
        settings.cellWidth = float(kCellWidth * length);
        return traceNearField(frame, ctx.view(), *rays, settings, image_);
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
    }
    std::ranges::transform(image_, samples.begin(), [](glm::vec4 v) {
      return glm::packHalf4x16(glm::vec4(glm::min(glm::vec3(v), 65504.0f), v.a));
    });
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
  std::vector<glm::vec4> image_;
};

FOVEA_PASS(NearField);

}  // namespace
}  // namespace fovea::passes
