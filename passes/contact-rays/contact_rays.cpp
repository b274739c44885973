// Light of VPLs by rays where surfaces meet, in grooves and at the feet of things.
#include <algorithm>
#include <atomic>
#include <bit>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/packing.hpp>
#include <mutex>
#include <vector>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/base/random.h"
#include "framework/base/threads.h"
#include "framework/scene/frame.h"
#include "framework/scene/rays/surface_tracer.h"
#include "framework/shader_twins/octahedral.h"
#include "passes/bundles.h"
#include "shaders/common/records/vpl.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr uint32_t kContactStream = 0x636f6e74u;
constexpr size_t kSubsets = 4;        // a pixel looks at one of so many subsets of the VPLs in a frame
constexpr float kLeastChance = 0.1f;  // of a VPL that no ray has reached, relative to one that all reach
constexpr float kKept = 0.75f;        // share of the tallies that is kept from frame to frame
constexpr float kRayEnd = 0.999f;     // rays end just before the VPL's surface

// How many rays went to the VPL in a slot, and how many of them reached it.
struct Tally {
  float rays = 0, reached = 0;
};

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

// The VPLs that shine, those of a subset side by side.
class Subsets {
 public:
  Subsets(std::span<const scene::Vpl> vpls, std::span<const Tally> tallies) {
    for (size_t subset = 0; subset < kSubsets; ++subset) {
      starts_[subset] = lights_.size();
      for (size_t i = subset; i < vpls.size(); i += kSubsets) {
        const scene::Vpl& v = vpls[i];
        const float power = v.intensity.x + v.intensity.y + v.intensity.z;
        const float chance = std::max((tallies[i].reached + 1) / (tallies[i].rays + 1), kLeastChance);
        if (power > 0)
          lights_.push_back({v.position, v.area * glm::one_over_pi<float>(), v.normal, power, v.intensity,
                             chance, uint32_t(i)});
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

// Light of VPLs at single pixels, for one thread.
class Sampler {
 public:
  Sampler(const scene::RayScene& rays, const scene::View& view, const Subsets& subsets, uint32_t count,
          uint32_t seed, uint32_t turn, size_t slots)
      : tallies(slots),
        rays_(rays),
        view_(view),
        subsets_(subsets),
        count_(count),
        seed_(seed),
        turn_(turn) {}

  std::vector<Tally> tallies;

  // Irradiance / pi from VPLs of one subset, chosen by the light they would send if nothing hid them and by the chance
  // that nothing does. Over the frames, subsets and places in the sum follow one low-discrepancy sequence.
  // contact: a texel of pass contacts.
  glm::vec3 lightAt(glm::uvec2 pixel, glm::uvec2 contact) {
    const glm::vec3 away = glm::normalize(view_.rayDirection(glm::vec2(pixel) + 0.5f));
    const glm::vec3 position = view_.eye + std::bit_cast<float>(contact.x) * away;
    const glm::vec3 normal = scene::octDecode(glm::unpackSnorm2x16(contact.y));
    const glm::vec3 origin = position + (normal - away) * rays_.epsilon();
    const glm::vec2 u = scene::streamSequence(randomStream(seed_, pixel.x, kContactStream, pixel.y), turn_);
    const auto lights = subsets_[std::min(size_t(u.y * float(kSubsets)), kSubsets - 1)];
    sums_.resize(lights.size());
    float sum = 0;
    for (size_t i = 0; i < lights.size(); ++i)
      sums_[i] = sum += lights[i].chance * lights[i].power * transfer(lights[i], position, normal);
    if (!(sum > 0)) return glm::vec3(0);
    glm::vec3 light(0);
    for (uint32_t k = 0; k < count_; ++k) {
      const float place = (float(k) + u.x) / float(count_) * sum;
      const size_t i =
          std::min(size_t(std::ranges::upper_bound(sums_, place) - sums_.begin()), lights.size() - 1);
      const PointLight& l = lights[i];
      ++tallies[l.slot].rays;
      if (rays_.occluded({origin, l.position - origin, 0, kRayEnd})) continue;
      ++tallies[l.slot].reached;
      light += l.intensity / (l.power * l.chance);
    }
    return light * (sum * float(kSubsets) / float(count_) * glm::one_over_pi<float>());
  }

 private:
  const scene::RayScene& rays_;
  const scene::View& view_;
  const Subsets& subsets_;
  uint32_t count_, seed_, turn_;
  std::vector<float> sums_;
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
    d.input("contacts", image2D(VK_FORMAT_R32G32_UINT), Usage::HostRead,
            "x: bits of the distance from the eye, m; y: octahedral normal; 0 elsewhere (pass contacts)");
    d.input("vpls", vplBuffer(), Usage::HostRead, "light sources; empty slots have zero intensity");
    d.input("history", buffer("VplTally", sizeof(Tally)), Usage::HostRead, "`tallies` of the previous frame");
    d.output("light", image2D(VK_FORMAT_R16G16B16A16_SFLOAT, widthOf("contacts"), heightOf("contacts")),
             Usage::HostWrite,
             "rgb: irradiance / pi from VPLs, W/(sr m^2); a: `longer` where surfaces meet, else all 0");
    d.output("tallies", buffer("VplTally", sizeof(Tally), countOf("vpls")), Usage::HostWrite,
             "x: rays to the VPL in a slot, y: those that reached it; a quarter is forgotten in each frame");
    d.parameter("rays", integer(2, 1, 1024), "rays per pixel");
    d.parameter("longer", real(4, 1, 1000),
                "length of a running mean of `light`, in lengths of that elsewhere, for pass "
                "temporal-accumulation");
    d.counter("pixels", "pixels where surfaces meet");
    d.counter("rays", "rays traced towards VPLs");
    return d;
  }

  void execute(HostContext& ctx) override {
    const scene::Frame& frame = ctx.frame();
    const auto contacts = ctx.inputAs<glm::uvec2>("contacts");
    const auto vpls = ctx.inputAs<scene::Vpl>("vpls");
    const auto history = ctx.inputAs<Tally>("history");
    const auto light = ctx.outputAs<uint64_t>("light");
    const auto tallies = ctx.outputAs<Tally>("tallies");
    std::ranges::fill(light, 0);
    std::ranges::fill(tallies, Tally{});
    if (frame.scene == nullptr || frame.geometry == nullptr || frame.geometry->empty()) return;
    const uint32_t width = ctx.extent("contacts").width, height = ctx.extent("contacts").height;
    if (const glm::uvec2 size = ctx.view().size; size != glm::uvec2(width, height))
      throw Error(ExitCode::BadInput,
                  "pass `contact-rays`: `contacts` has " + std::to_string(width) + "x" +
                      std::to_string(height) + " pixels, its view " + std::to_string(size.x) + "x" +
                      std::to_string(size.y),
                  "wire contacts of the view that the pass looks through");
    const auto rays = scene::RayScene::cached(*frame.scene, *frame.geometry);
    const Subsets subsets(vpls, history);
    const uint32_t count = uint32_t(ctx.parameters().integer("rays"));
    const float longer = float(ctx.parameters().real("longer"));
    std::atomic<uint32_t> next = 0;
    std::mutex adding;
    uint64_t pixels = 0;
    onThreads(std::min(threadCount(0), height), [&] {
      Sampler sampler(*rays, ctx.view(), subsets, count, frame.seed, uint32_t(ctx.frameNumber()),
                      vpls.size());
      uint64_t found = 0;
      for (uint32_t y = next++; y < height; y = next++)
        for (uint32_t x = 0; x < width; ++x) {
          const size_t i = size_t(y) * width + x;
          if (contacts[i].x == 0) continue;
          ++found;
          const glm::vec3 value = sampler.lightAt({x, y}, contacts[i]);
          light[i] = glm::packHalf4x16(glm::vec4(glm::min(value, 65504.0f), longer));
        }
      const std::lock_guard lock(adding);
      pixels += found;
      for (size_t i = 0; i < tallies.size(); ++i) {  // whole numbers, so the order does not matter
        tallies[i].rays += sampler.tallies[i].rays;
        tallies[i].reached += sampler.tallies[i].reached;
      }
    });
    for (size_t i = 0; i < tallies.size(); ++i) {
      tallies[i].rays += kKept * history[i].rays;
      tallies[i].reached += kKept * history[i].reached;
    }
    ctx.counter("pixels", double(pixels));
    ctx.counter("rays", double(pixels * count));
  }
};

FOVEA_PASS(ContactRays);

}  // namespace
}  // namespace fovea::passes
