// Visibility of shared samples (ReSTIR GI, Sec. 4.3): without bias, a sample lights only what sees it, and counts only
// among pixels that see it, as only these could have found it.
#include <algorithm>
#include <atomic>
#include <glm/gtc/packing.hpp>
#include <string>

#include "fovea/pass.h"
#include "framework/base/threads.h"
#include "framework/scene/frame.h"
#include "framework/scene/rays/visibility.h"
#include "framework/shader_twins/octahedral.h"
#include "passes/materials.h"
#include "passes/reservoirs-visibility-host/reservoirs_visibility_ports.h"
#include "shaders/records/reservoir.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr uint32_t kNone = 0xffffffffu;  // in place of a pixel: none

// What pixels show, and their reservoirs.
struct Pixels {
  std::span<const glm::vec4> position;
  std::span<const uint32_t> face;       // octahedral
  std::span<const glm::vec2> wideFace;  // the same, on devices that lack its format (graph::replaceFormats())
  std::span<const Reservoir> reservoirs;

  Pixels(const HostContext& ctx, const std::string& gbuffer, const std::string& reservoirs_)
      : position(ctx.inputAs<glm::vec4>(gbuffer + ".position")),
        face(ctx.inputAs<uint32_t>(gbuffer + ".face")),
        wideFace(ctx.inputAs<glm::vec2>(gbuffer + ".face")),
        reservoirs(ctx.inputAs<Reservoir>(reservoirs_)) {}

  glm::vec3 faceAt(size_t pixel) const {
    const bool wide = wideFace.size() == position.size();
    return scene::octDecode(wide ? wideFace[pixel] : glm::unpackSnorm2x16(face[pixel]));
  }
};

class ReservoirsVisibilityHost : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "reservoirs-visibility-host",
        "rays to the samples of indirect light that pixels are about to share (ReSTIR GI), on the CPU",
        PassKind::Host);
    declareReservoirsVisibility(d, Usage::HostRead, Usage::HostRead, Usage::HostWrite);
    return d;
  }

  void prepare(PrepareContext& ctx) override { checkReservoirsVisibility(ctx); }

  void execute(HostContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const auto visibility = ctx.outputAs<uint32_t>("seen");
    std::ranges::fill(visibility, 0u);
    if (frame.scene == nullptr || frame.geometry == nullptr || frame.geometry->empty()) return;
    const auto rays = scene::RayScene::cached(*frame.scene, *frame.geometry, passingOf(ctx.parameters()));
    const Pixels own(ctx, "gbuffer", "own"), others(ctx, "other_gbuffer", "others");
    const auto sources = ctx.inputAs<uint32_t>("sources");
    const VkExtent3D size = ctx.extent("gbuffer.position");
    const size_t each = sources.size() / visibility.size();
    const bool previous = ctx.parameters().flag("previous");
    const auto ids = ctx.inputAs<uint32_t>("gbuffer.id");
    std::atomic<uint32_t> next = 0;
    std::atomic<uint64_t> traced = 0, reached = 0;
    onThreads(std::min(threadCount(0), size.height), [&] {
      uint64_t count = 0, seen = 0;
      const auto sees = [&](const Pixels& pixels, size_t pixel, const Reservoir& r) {
        const bool found = r.weight > 0 && reaches(frame, *rays, ctx.view().eye, pixels, pixel, r, count);
        seen += found;
        return found ? 1u : 0u;
      };
      for (uint32_t y = next++; y < size.height; y = next++)
        for (size_t i = size_t(y) * size.width; i < size_t(y + 1) * size.width; ++i)
          for (uint32_t k = 0; k < each; ++k) {
            const uint32_t source = sources[i * each + k];
            if (source == kNone) continue;
            const size_t other = size_t(source >> 16) * size.width + (source & 0xffffu);
            visibility[i] |= sees(own, i, others.reservoirs[other]) << 2 * k;
            const bool gone = previous && ids[i] >> 16 != 0;
            visibility[i] |= (gone ? 1u : sees(others, other, own.reservoirs[i])) << (2 * k + 1);
          }
      traced += count;
      reached += seen;
    });
    ctx.counter("rays", double(traced));
    ctx.counter("hidden", double(traced - reached));
  }

 private:
  static bool reaches(const scene::Frame& frame, const scene::RayScene& rays, glm::vec3 eye,
                      const Pixels& pixels, size_t pixel, const Reservoir& r, uint64_t& count) {
    const glm::vec3 position(pixels.position[pixel]), face = pixels.faceAt(pixel);
    if (glm::dot(r.position - position, face) <= 0 || glm::dot(position - r.position, r.normal) <= 0)
      return false;
    const glm::vec3 origin = position + (face - glm::normalize(position - eye)) * rays.epsilon();
    const glm::vec3 to = r.position + r.normal * rays.epsilon() - origin;
    return scene::visibility(frame, rays, {origin, to, 0, kReservoirRayEnd}, count) != glm::vec3(0);
  }
};

FOVEA_PASS(ReservoirsVisibilityHost);

}  // namespace
}  // namespace fovea::passes
