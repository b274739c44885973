// What smooth surfaces reflect.
#include <algorithm>
#include <atomic>
#include <bit>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "fovea/pass.h"
#include "framework/base/random.h"
#include "framework/base/threads.h"
#include "framework/scene/frame.h"
#include "framework/scene/lights.h"
#include "framework/scene/materials/albedo_table.h"
#include "framework/scene/materials/microfacets.h"
#include "framework/scene/rays/surface_tracer.h"
#include "framework/shader_twins/octahedral.h"
#include "framework/shader_twins/paraboloid.h"
#include "passes/near-field-host/cached_light.h"
#include "passes/reflections-host/reflections_ports.h"
#include "shaders/records/mirror.h"

namespace fovea::passes {
namespace {

using namespace graph;

// A texel of pass mirrors, and the light that was found for it. If it reflects nothing, the other members mean nothing.
struct Mirror {
  Mirror(glm::uvec4 texel, glm::uvec2 block, const scene::View& view)
      : there(texel.x != 0), code(texel.w & 0xffffu) {
    if (!there) return;
    roughness = glm::unpackUnorm2x16(texel.w).y;
    alpha = scene::ggxAlpha(roughness);
    normal = scene::octDecode(glm::unpackSnorm2x16(texel.y));
    face = scene::octDecode(glm::unpackSnorm2x16(texel.z));
    const glm::uvec2 pixel = 2u * block + glm::uvec2(code >> 4 & 7u, code >> 7 & 7u);
    away = glm::normalize(view.rayDirection(glm::vec2(pixel) + 0.5f));
    distance = std::bit_cast<float>(texel.x);
    position = view.eye + distance * away;
  }

  bool there;
  uint32_t code;
  float roughness = 0, alpha = 0;
  glm::vec3 normal{0}, face{0}, away{0}, position{0};  // away: from the eye
  float distance = 0;                                  // from the eye, m
  glm::vec3 light{0};                                  // mean under the lobe, W/(sr m^2)
  float nearness = 0;  // mean of 1 / distance of what it shows, 0 for rays into the surface, 1/m
};

// The light that mirrors reflect, for one thread or more.
class Tracer {
 public:
  Tracer(const scene::SurfaceTracer& surfaces, float epsilon, uint32_t bounces, const GatherCache& cache)
      : surfaces_(surfaces), epsilon_(epsilon), bounces_(bounces), cache_(cache) {}

  // Sets the means over `count` rays, beginning with number `turn` of all that leave the block. stream: of the block.
  void look(Mirror& m, uint32_t stream, uint32_t turn, uint32_t count, GatheredLight& sum) const {
    const glm::mat3 frame = scene::orthonormalFrame(m.normal);
    glm::vec3 out = scene::toLocal(frame, -m.away);
    out.z = std::max(out.z, kLeastLobe);  // a bent normal may face away from the eye
    out = glm::normalize(out);
    for (uint32_t i = turn; i < turn + count; ++i) {
      const glm::vec4 seen = underLobe(m, frame, out, scene::streamSequence(stream, i),
                                       randomStream(stream, i, kMirrorLightStream, 0), sum);
      m.light += glm::vec3(seen);
      m.nearness += seen.a / float(count);
    }
    const float albedo = scene::AlbedoTable::schlick().at(out.z, m.roughness).total();
    m.light /= float(count) * std::max(albedo, kLeastLobe);
  }

 private:
  // An estimate of the integral of D V cos times the radiance that arrives, by a visible normal of the microfacets; a:
  // 1 / distance of what sends it, 0 if the ray goes into the surface, 1/m.
  glm::vec4 underLobe(const Mirror& m, const glm::mat3& frame, glm::vec3 out, glm::vec2 u, uint32_t stream,
                      GatheredLight& sum) const {
    const glm::vec3 h = scene::sampleVisibleNormal(out, m.alpha, u.x, u.y);
    const glm::vec3 in = 2 * glm::dot(out, h) * h - out, direction = scene::toWorld(frame, in);
    if (in.z <= 0 || glm::dot(m.face, direction) <= 0) return glm::vec4(0);
    const float hidden = scene::smithLambda(out, m.alpha);
    const float weight = (1 + hidden) / (1 + hidden + scene::smithLambda(in, m.alpha));
    const glm::vec3 origin = m.position + (m.face - m.away) * epsilon_;
    const scene::TracedSurface hit = surfaces_.arrive(origin, direction, scene::kFarAway, sum.rays);
    if (hit.isOutside()) return {weight * hit.brighter * surfaces_.outside(direction).radiance, 1 / kOutside};
    const float nearness = 1 / std::max(glm::distance(hit.position, origin), kLeastReach);
    if (!hit.there) return {0, 0, 0, nearness};
    const glm::vec3 gathered =
        gatheredLight(surfaces_, hit, bounces_ - 1, stream, &cache_, kMirrorCellWidth * m.distance, sum);
    return {weight * (surfaces_.seen(hit, -direction, sum.rays, m.roughness) +
                      surfaces_.reflectance(hit) * gathered),
            nearness};
  }

  const scene::SurfaceTracer& surfaces_;
  float epsilon_;
  uint32_t bounces_;
  const GatherCache& cache_;
};

// At which distance, as 1/m, lobes have to overlap for light to be shared.
float sharingNearness(const Mirror& m) {
  return m.nearness > 0 ? m.nearness : m.alpha / (kHardlyApart * m.distance);
}

// The share of a neighbour's light that counts for `m`, too, as far as their lobes overlap where the nearer of the
// things that they see lies.
float overlap(const Mirror& m, const Mirror& neighbour) {
  if (!neighbour.there) return 0;
  const glm::vec3 to = neighbour.position - m.position;
  if (std::abs(glm::dot(to, m.face)) > kSameSlope * glm::length(to)) return 0;
  const glm::vec3 turned =
      2.0f * (neighbour.normal - m.normal);  // a mirror turns light by twice its own turn
  const glm::vec3 parallax = 0.5f * std::max(sharingNearness(m), sharingNearness(neighbour)) * to;
  const float apart = glm::dot(turned, turned) + glm::dot(parallax, parallax);
  const float blurred = std::min(m.alpha / kSharp, 1.0f);
  return blurred * blurred * std::exp(-apart / (m.alpha * m.alpha));
}

class ReflectionsHost : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "reflections-host",
        "indirect light under the narrow lobes of smooth surfaces, found with a ray per block of "
        "pixels and frame on the CPU: VPLs would show as blurred discs there",
        PassKind::Host);
    declareReflections(d, Usage::HostRead, Usage::HostWrite);
    return d;
  }

  void execute(HostContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const auto texels = ctx.inputAs<glm::uvec4>("mirrors");
    const auto samples = ctx.outputAs<uint64_t>("samples");
    const auto distances = ctx.outputAs<float>("distances");
    const uint32_t width = ctx.extent("mirrors").width, height = ctx.extent("mirrors").height;
    checkReflections(ctx, (ctx.view().size + 1u) / 2u);
    mirrors_.clear();
    for (uint32_t i = 0; i < texels.size(); ++i)
      mirrors_.emplace_back(texels[i], glm::uvec2(i % width, i / width), ctx.view());
    if (ctx.firstFrame()) cache_.clear();
    Row sum;
    if (frame.scene != nullptr && frame.geometry != nullptr && !frame.geometry->empty())
      sum = trace(ctx, glm::uvec2(width, height));
    forRows(height, [&](uint32_t y) {
      for (uint32_t x = 0; x < width; ++x) {
        const glm::vec3 light = glm::min(meanAround(glm::ivec2(x, y), glm::ivec2(width, height)), 65504.0f);
        const Mirror& m = mirrors_[size_t(y) * width + x];
        const float code = m.there ? float(m.code) : kNoMirror;
        samples[size_t(y) * width + x] = glm::packHalf4x16(glm::vec4(light, code));
        distances[size_t(y) * width + x] = m.nearness > 0 ? 1 / m.nearness : 0;
      }
    });
    ctx.counter("mirrors", double(sum.mirrors));
    ctx.counter("rays", double(sum.rays));
    ctx.counter("gathered", double(sum.gathered));
  }

 private:
  // What one row of texels adds.
  struct Row : GatheredLight {
    uint64_t mirrors = 0;
  };

  template <class Function>
  static void forRows(uint32_t count, const Function& function) {
    std::atomic<uint32_t> next = 0;
    onThreads(std::min(threadCount(0), count), [&] {
      for (uint32_t row = next++; row < count; row = next++) function(row);
    });
  }

  // Finds the light of all mirrors.
  Row trace(HostContext& ctx, glm::uvec2 size) {
    Row sum;
    if (std::ranges::none_of(mirrors_, &Mirror::there)) return sum;
    const scene::Frame& frame = ctx.frame();
    const auto rays = scene::RayScene::cached(*frame.scene, *frame.geometry, scene::Passing::Met);
    const scene::SurfaceTracer surfaces(frame, ctx.view(), *rays, true);
    const Tracer tracer(surfaces, rays->epsilon(), uint32_t(ctx.parameters().integer("bounces")), cache_);
    const uint32_t samples = ctx.firstFrame() ? uint32_t(ctx.parameters().integer("first_samples")) : 1;
    const auto turn = uint32_t(ctx.frameNumber());
    std::vector<Row> rows(size.y);
    forRows(size.y, [&](uint32_t y) {
      for (uint32_t x = 0; x < size.x; ++x) {
        Mirror& m = mirrors_[size_t(y) * size.x + x];
        if (!m.there) continue;
        ++rows[y].mirrors;
        tracer.look(m, randomStream(frame.seed, x, kMirrorStream, y), turn, samples, rows[y]);
      }
    });
    for (const Row& row : rows) {  // in a fixed order
      sum.mirrors += row.mirrors;
      sum.rays += row.rays;
      sum.gathered += row.gathered;
      cache_.add(row.samples);
    }
    return sum;
  }

  // The mean over 5 x 5 texels: single rays are poor estimates of what wide lobes reflect.
  glm::vec3 meanAround(glm::ivec2 at, glm::ivec2 size) const {
    const Mirror& m = mirrors_[size_t(at.y) * size.x + at.x];
    glm::vec4 sum(m.light, 1);
    for (int y = std::max(at.y - kSharing, 0); m.there && y <= std::min(at.y + kSharing, size.y - 1); ++y)
      for (int x = std::max(at.x - kSharing, 0); x <= std::min(at.x + kSharing, size.x - 1); ++x) {
        const Mirror& other = mirrors_[size_t(y) * size.x + x];
        if (&other != &m) sum += overlap(m, other) * glm::vec4(other.light, 1);
      }
    return glm::vec3(sum) / sum.w;
  }

  std::vector<Mirror> mirrors_;
  GatherCache cache_;  // of the frames so far
};

FOVEA_PASS(ReflectionsHost);

}  // namespace
}  // namespace fovea::passes
