// Light of VPLs by rays where surfaces meet, in grooves and at the feet of things.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/packing.hpp>
#include <mutex>
#include <vector>

#include "fovea/pass.h"
#include "framework/base/random.h"
#include "framework/base/threads.h"
#include "framework/scene/frame.h"
#include "framework/scene/rays/surface_tracer.h"
#include "framework/shader_twins/fovea.h"
#include "passes/bundles.h"
#include "shaders/common/records/vpl.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr uint32_t kContactStream = 0x636f6e74u;
constexpr size_t kSubsets = 4;        // a pixel looks at one of so many subsets of the VPLs in a frame
constexpr float kRise = 0.3f;         // least slope at which a surface rises over another one's tangent plane
constexpr float kRounding = 1e-4f;    // least height of the rise, relative to the distance from the eye
constexpr float kWidest = 1 / 32.f;   // how far away on the screen rising surfaces are searched, image widths
constexpr float kLeastChance = 0.1f;  // of a VPL that no ray has reached, relative to one that all reach
constexpr float kKept = 0.75f;        // share of the tallies that is kept from frame to frame
constexpr float kRayEnd = 0.999f;     // rays end just before the VPL's surface

// What the choice of a VPL and its light need.
struct PointLight {
  glm::vec3 position;
  float area;  // of its disc, divided by pi, m^2
  glm::vec3 normal;
  float power;  // sum over the channels of its intensity
  glm::vec3 intensity;
  float chance;  // that a ray reaches it, by those of the frames before
  uint32_t slot;
};

// How many rays went to the VPL in a slot, and how many of them reached it.
struct Tally {
  float rays = 0, reached = 0;
};

// The VPLs that shine, those of a subset side by side.
class Subsets {
 public:
  Subsets(std::span<const scene::Vpl> vpls, std::span<const Tally> tallies) {
    for (size_t subset = 0; subset < kSubsets; ++subset) {
      starts_[subset] = lights_.size();
      for (size_t i = subset; i < vpls.size(); i += kSubsets) {
        const scene::Vpl& v = vpls[i];
        const float power = v.intensity.x + v.intensity.y + v.intensity.z;
        const float chance = (tallies[i].reached + 1) / (tallies[i].rays + 1);
        if (power > 0)
          lights_.push_back({v.position, v.area * glm::one_over_pi<float>(), v.normal, power, v.intensity,
                             std::max(chance, kLeastChance), uint32_t(i)});
      }
    }
    starts_[kSubsets] = lights_.size();
  }
  std::span<const PointLight> operator[](size_t subset) const {
    return std::span(lights_).subspan(starts_[subset], starts_[subset + 1] - starts_[subset]);
  }

 private:
  std::vector<PointLight> lights_;
  size_t starts_[kSubsets + 1] = {};
};

// cos_s cos_l / (d^2 + A / pi) / d^2, in the form in which pass deferred has it.
float transfer(const PointLight& light, glm::vec3 position, glm::vec3 normal) {
  const glm::vec3 to = position - light.position;
  const float d2 = std::max(glm::dot(to, to), 1e-12f);
  const float cosines = std::max(-glm::dot(normal, to), 0.0f) * std::max(glm::dot(light.normal, to), 0.0f);
  return cosines / (d2 * (d2 + light.area));
}

// The visible surfaces.
struct Surfaces {
  std::span<const glm::vec4> positions;
  std::span<const uint64_t> normals;
  glm::ivec2 size{0};

  size_t index(glm::ivec2 p) const { return size_t(p.y) * size_t(size.x) + size_t(p.x); }
  glm::vec3 normal(glm::ivec2 p) const {
    return glm::normalize(glm::vec3(glm::unpackHalf4x16(normals[index(p)])));
  }
  // Whether a surface close to the one at p rises over its tangent plane, so that it may hide light from it. Looks in
  // alternate directions at distances that double.
  bool inContact(glm::ivec2 p, glm::vec3 normal, float reach, int widest) const {
    static constexpr glm::ivec2 kAround[8] = {{1, 0}, {0, 1},  {-1, 0},  {0, -1},
                                              {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    const glm::vec4 here = positions[index(p)];
    const float rounding = kRounding * here.w;
    int turn = 0;
    for (int step = 1; step <= widest; step *= 2, turn ^= 4)
      for (int k = 0; k < 4; ++k) {
        const glm::ivec2 q = glm::clamp(p + step * kAround[turn + k], glm::ivec2(0), size - 1);
        const glm::vec4 there = positions[index(q)];
        if (!(there.w > 0)) continue;
        const glm::vec3 to = glm::vec3(there) - glm::vec3(here);
        const float height = glm::dot(to, normal), d2 = glm::dot(to, to);
        if (height > rounding && height * height > kRise * kRise * d2 && d2 < reach * reach) return true;
      }
    return false;
  }
};

// Light of VPLs at single pixels.
struct Sampling {
  const scene::RayScene& rays;
  const Subsets& subsets;
  glm::vec3 eye;
  uint32_t count, seed, turn;

  // Irradiance / pi from VPLs of one subset, chosen by the light they would send if nothing hid them and by the chance
  // that nothing does. Over the frames, subsets and places in the sum follow one low-discrepancy sequence.
  glm::vec3 light(glm::ivec2 pixel, glm::vec3 position, glm::vec3 normal, std::vector<float>& sums,
                  std::vector<Tally>& tallies) const {
    const uint32_t stream = randomStream(seed, uint32_t(pixel.x), kContactStream, uint32_t(pixel.y));
    const glm::vec2 u = scene::streamSequence(stream, turn);
    const auto lights = subsets[std::min(size_t(u.y * float(kSubsets)), kSubsets - 1)];
    sums.resize(lights.size());
    float sum = 0;
    for (size_t i = 0; i < lights.size(); ++i)
      sums[i] = sum += lights[i].chance * lights[i].power * transfer(lights[i], position, normal);
    if (!(sum > 0)) return glm::vec3(0);
    const glm::vec3 origin = position + (normal - glm::normalize(position - eye)) * rays.epsilon();
    glm::vec3 colours(0);
    for (uint32_t k = 0; k < count; ++k) {
      const float place = (float(k) + u.x) / float(count) * sum;
      const size_t i =
          std::min(size_t(std::ranges::upper_bound(sums, place) - sums.begin()), lights.size() - 1);
      const PointLight& l = lights[i];
      ++tallies[l.slot].rays;
      if (rays.occluded({origin, l.position - origin, 0, kRayEnd})) continue;
      ++tallies[l.slot].reached;
      colours += l.intensity / (l.power * l.chance);
    }
    return colours * (sum * float(kSubsets) / float(count) * glm::one_over_pi<float>());
  }
};

class ContactRays : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "contact-rays",
        "the light of VPLs by rays where surfaces meet in the fovea, in grooves and at the feet "
        "of things: shadow maps are too coarse for what hides light there, and the filter of "
        "pass deferred carries light across",
        PassKind::Host);
    d.view();
    d.inout(
        "irradiance", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::HostRead | Usage::HostWrite,
        "rgb: indirect irradiance / pi, W/(sr m^2); a: how many times as long the running mean shall be, for "
        "pass temporal-accumulation; becomes `longer` where rays decide");
    d.input("gbuffer", "gbuffer", gbufferMembers(Usage::HostRead, {"position", "normal"}),
            "surfaces seen by the eye");
    d.input("vpls", vplBuffer(), Usage::HostRead, "light sources; empty slots have zero intensity");
    d.input("near_field", image2D(VK_FORMAT_R16G16B16A16_SFLOAT), Usage::HostRead,
            "rgb: irradiance / pi from nearby surfaces, which VPLs shaded as discs leave out");
    d.input("spread", spreadBuffer(), Usage::HostRead,
            "x: least area of a VPL's disc, m^2 (pass near-field)");
    const ResourceSpec tallies = buffer("VplTally", sizeof(Tally), countOf("vpls"));
    d.input("history", buffer("VplTally", sizeof(Tally)), Usage::HostRead, "`tallies` of the previous frame");
    d.output("tallies", tallies, Usage::HostWrite,
             "x: rays to the VPL in a slot, y: those that reached it; a quarter is forgotten in each frame");
    d.parameter("fovea_radius", real(0.25, 0.001, 4, "image widths"), "radius of the fovea");
    d.parameter("rays", integer(2, 1, 1024), "rays per pixel");
    d.parameter("reach", real(0.5, 0, 1000),
                "how close a surface must be to be in contact, in radii of the smallest disc");
    d.parameter("longer", real(4, 1, 1000),
                "length of the running mean of these pixels, in lengths of that of the others");
    d.counter("pixels", "pixels in contact");
    d.counter("rays", "rays traced towards VPLs");
    return d;
  }

  void execute(HostContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const Parameters& p = ctx.parameters();
    const auto irradiance = ctx.outputAs<uint64_t>("irradiance");
    const auto tallies = ctx.outputAs<Tally>("tallies");
    std::ranges::fill(tallies, Tally{});
    if (frame.scene == nullptr || frame.geometry == nullptr || frame.geometry->empty()) return;
    const VkExtent3D extent = ctx.extent("irradiance");
    const Surfaces surfaces{ctx.inputAs<glm::vec4>("gbuffer.position"),
                            ctx.inputAs<uint64_t>("gbuffer.normal"), glm::ivec2(extent.width, extent.height)};
    const auto nearField = ctx.inputAs<uint64_t>("near_field");
    const auto vpls = ctx.inputAs<scene::Vpl>("vpls");
    const auto before = ctx.inputAs<Tally>("history");
    const Subsets subsets(vpls, before);
    const auto rays = scene::RayScene::cached(*frame.scene, *frame.geometry);
    const scene::Fovea fovea =
        scene::makeFovea(ctx.view().gaze, glm::vec2(surfaces.size), float(p.real("fovea_radius")));
    const float reach =
        float(p.real("reach")) * std::sqrt(ctx.inputAs<glm::vec4>("spread")[0].x * glm::one_over_pi<float>());
    const int widest = int(kWidest * float(surfaces.size.x));
    const glm::ivec2 low = glm::max(glm::ivec2(fovea.centre - fovea.radius), glm::ivec2(0)),
                     high = glm::min(glm::ivec2(fovea.centre + fovea.radius) + 1, surfaces.size);
    const Sampling sampling{
        *rays, subsets, ctx.view().eye, uint32_t(p.integer("rays")), frame.seed, uint32_t(ctx.frameNumber())};
    std::atomic<int> next = low.y;
    std::atomic<uint64_t> pixels = 0;
    std::mutex mutex;
    onThreads(threadCount(0), [&] {
      std::vector<float> sums;
      std::vector<Tally> own(vpls.size());
      uint64_t found = 0;
      for (int y = next++; y < high.y; y = next++)
        for (int x = low.x; x < high.x; ++x) {
          const glm::ivec2 at(x, y);
          const size_t i = surfaces.index(at);
          if (!(surfaces.positions[i].w > 0) ||
              glm::distance(glm::vec2(at) + 0.5f, fovea.centre) > fovea.radius)
            continue;
          const glm::vec3 normal = surfaces.normal(at);
          if (!surfaces.inContact(at, normal, reach, widest)) continue;
          ++found;
          const glm::vec3 light = sampling.light(at, glm::vec3(surfaces.positions[i]), normal, sums, own) +
                                  glm::vec3(glm::unpackHalf4x16(nearField[i]));
          irradiance[i] = glm::packHalf4x16(glm::vec4(glm::min(light, 65504.0f), p.real("longer")));
        }
      pixels += found;
      const std::lock_guard lock(mutex);
      for (size_t i = 0; i < own.size(); ++i) {  // whole numbers, so the order does not matter
        tallies[i].rays += own[i].rays;
        tallies[i].reached += own[i].reached;
      }
    });
    for (size_t i = 0; i < tallies.size(); ++i) {
      tallies[i].rays += kKept * before[i].rays;
      tallies[i].reached += kKept * before[i].reached;
    }
    ctx.counter("pixels", double(pixels));
    ctx.counter("rays", double(pixels) * double(p.integer("rays")));
  }
};

FOVEA_PASS(ContactRays);

}  // namespace
}  // namespace fovea::passes
