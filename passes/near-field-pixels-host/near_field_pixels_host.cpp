// Light from nearby surfaces at the few pixels that are shaded anew, which have no history to build on.
#include <algorithm>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "fovea/pass.h"
#include "framework/scene/frame.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/near-field-host/near_field_tracer.h"
#include "passes/near-field-pixels-host/near_field_pixels_ports.h"

namespace fovea::passes {
namespace {

using namespace graph;

class NearFieldPixelsHost : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "near-field-pixels-host",
        "light from nearby surfaces, as in pass near-field, at those pixels of a mask where it is "
        "not known, complete after one frame, found with rays on the CPU",
        PassKind::Host);
    declareNearFieldPixels(d, shadeMaskAlone(Usage::HostRead), Usage::HostRead,
                           Usage::HostRead | Usage::HostWrite);
    return d;
  }

  void execute(HostContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const Parameters& p = ctx.parameters();
    const auto mask = ctx.inputAs<uint8_t>("shade.mask");
    const auto image = ctx.outputAs<uint64_t>("near_field");
    checkNearFieldPixels(ctx, ctx.view().size);
    if (frame.scene == nullptr || frame.geometry == nullptr || frame.geometry->empty()) return;
    pixels_.clear();
    const uint32_t width = ctx.view().size.x;
    for (uint32_t i = 0; i < mask.size(); ++i)
      if (mask[i] != 0 && image[i] >> 48 == 0) pixels_.emplace_back(i % width, i / width);
    light_.resize(pixels_.size());
    NearFieldSettings settings;
    settings.area = ctx.inputAs<glm::vec4>("spread")[0].x;
    settings.samples = uint32_t(p.integer("samples"));
    settings.bounces = uint32_t(p.integer("bounces"));
    settings.fullMaterials = fullMaterials(p);
    settings.seed = frame.seed;  // the turn stays 0: without a mean over frames, new rays would flicker
    const auto rays = scene::RayScene::cached(*frame.scene, *frame.geometry, passingOf(p));
    const NearFieldStatistics statistics =
        traceNearFieldPixels(frame, ctx.view(), *rays, settings, pixels_, light_);
    if (settings.samples == 1) limitBrightest(ctx.view().size);
    uint64_t lit = 0;
    for (size_t i = 0; i < pixels_.size(); ++i) {
      if (light_[i].a == 0) continue;
      ++lit;
      image[size_t(pixels_[i].y) * width + pixels_[i].x] =
          glm::packHalf4x16(glm::vec4(glm::min(glm::vec3(light_[i]), 65504.0f), 1));
    }
    ctx.counter("rays", double(statistics.rays));
    ctx.counter("pixels", double(lit));
  }

 private:
  static float luminanceOf(glm::vec4 light) {
    return glm::dot(glm::vec3(light), {0.2126f, 0.7152f, 0.0722f});
  }

  // Among the pixels of each 4 x 4 block that got rays, makes the brightest one no brighter than the second: a single
  // ray that hits something sunlit would be a firefly. Means of several rays need this less and would lose light.
  void limitBrightest(glm::uvec2 size) {
    const uint32_t columns = (size.x + 3) / 4;
    const auto blockOf = [&](glm::uvec2 pixel) { return size_t(pixel.y / 4) * columns + pixel.x / 4; };
    most_.assign(size_t((size.y + 3) / 4) * columns, glm::vec2(-1));
    for (size_t i = 0; i < pixels_.size(); ++i) {
      if (light_[i].a == 0) continue;
      glm::vec2& most = most_[blockOf(pixels_[i])];
      const float luminance = luminanceOf(light_[i]);
      most = {std::max(most.x, luminance), std::max(most.y, std::min(most.x, luminance))};
    }
    for (size_t i = 0; i < pixels_.size(); ++i) {
      const float second = most_[blockOf(pixels_[i])].y, luminance = luminanceOf(light_[i]);
      if (second >= 0 && luminance > second)
        light_[i] = glm::vec4(glm::vec3(light_[i]) * (second / luminance), 1);
    }
  }

  std::vector<glm::uvec2> pixels_;
  std::vector<glm::vec4> light_;
  std::vector<glm::vec2> most_;  // the two largest luminances of each block; -1 if it has none
};

FOVEA_PASS(NearFieldPixelsHost);

}  // namespace
}  // namespace fovea::passes
