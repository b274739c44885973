// Sharp shadow edges: rays on the host decide where shadow maps cannot.
#include <algorithm>
#include <atomic>
#include <glm/gtc/packing.hpp>
#include <string>
#include <vector>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/base/threads.h"
#include "framework/scene/frame.h"
#include "framework/scene/rays/surface_tracer.h"
#include "passes/acuity.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/shadow_edges.h"

namespace fovea::passes {
namespace {

using namespace graph;

class ShadowRaysHost : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d("shadow-rays-host",
                      "direct light by rays through the triangles, at the edges of shadows, which shadow "
                      "maps widen and shift in steps of their texels",
                      PassKind::Host);
    d.view();
    d.input(
         "gbuffer", "gbuffer", gbufferMembers(Usage::HostRead, {"id"}),
         "not read, as rays from the eye find the surfaces; there so that `shadow-rays-device` has no input "
         "that this pass lacks")
        .makeOptional()
        .when(0);
    declareShadowEdges(d, Usage::HostRead | Usage::HostWrite);
    d.counter("rays", "rays traced, from the eye and towards lights");
    return d;
  }

  void execute(HostContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const auto direct = ctx.outputAs<uint64_t>("direct");
    if (frame.scene == nullptr || frame.geometry == nullptr || frame.geometry->empty()) return;
    const auto rays = scene::RayScene::cached(*frame.scene, *frame.geometry, passingOf(ctx.parameters()));
    const scene::SurfaceTracer surfaces(frame, ctx.view(), *rays, fullMaterials(ctx.parameters()));
    const uint32_t width = ctx.extent("direct").width, height = ctx.extent("direct").height;
    if (const glm::uvec2 size = ctx.view().size; size != glm::uvec2(width, height))
      throw Error(ExitCode::BadInput,
                  "`direct` has " + std::to_string(width) + "x" + std::to_string(height) +
                      " pixels, its view " + std::to_string(size.x) + "x" + std::to_string(size.y),
                  "wire direct light of the view that the pass looks through");
    const Square fine = fineSquare(ctx.view(), ctx.parameters(), 1).within(ctx.extent("direct"));
    const uint32_t first = uint32_t(fine.low.x), last = uint32_t(fine.high.x), end = uint32_t(fine.high.y);
    std::atomic<uint32_t> next = uint32_t(fine.low.y);
    std::atomic<uint64_t> pixels = 0, traced = 0;
    onThreads(std::min(threadCount(0), height), [&] {
      uint64_t doubted = 0, count = 0;
      for (uint32_t y = next++; y < end; y = next++)
        for (uint32_t x = first; x < last; ++x) {
          uint64_t& pixel = direct[size_t(y) * width + x];
          if (pixel >> 48 == kSure) continue;
          ++doubted;
          const scene::TracedSurface v = surfaces.look(glm::vec2(x, y) + 0.5f, count);
          if (v.there) {
            const glm::vec3 out = glm::normalize(ctx.view().eye - v.position);
            pixel = glm::packHalf4x16(glm::vec4(glm::min(surfaces.seen(v, out, count), 65504.0f), 1));
          } else {  // the ray falls between two triangles, so the map's result stays
            pixel = (pixel & 0xffffffffffffu) | kSure << 48;
          }
        }
      pixels += doubted;
      traced += count;
    });
    ctx.counter("pixels", double(pixels));
    ctx.counter("rays", double(traced));
  }

 private:
  static constexpr uint64_t kSure = 0x3c00;  // 1 as a half
};

FOVEA_PASS(ShadowRaysHost);

}  // namespace
}  // namespace fovea::passes
