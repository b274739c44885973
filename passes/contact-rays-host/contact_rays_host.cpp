// Light of VPLs by rays where surfaces meet, in grooves and at the feet of things.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/packing.hpp>
#include <mutex>
#include <numeric>
#include <vector>

#include "fovea/error.h"
#include "fovea/pass.h"
#include "framework/base/random.h"
#include "framework/base/threads.h"
#include "framework/scene/frame.h"
#include "framework/scene/rays/surface_tracer.h"
#include "framework/scene/rays/visibility.h"
#include "framework/shader_twins/octahedral.h"
#include "passes/bundles.h"
#include "passes/materials.h"
#include "passes/same_plane.h"
#include "shaders/common/records/contact.h"
#include "shaders/common/records/vpl.h"

namespace fovea::passes {
namespace {

using namespace graph;

constexpr size_t kSubsets = kContactSubsets;
constexpr size_t kBlock = 16;  // VPLs whose light is summed before one of them is chosen

// Of a pixel in a row of three, by its distance from the middle.
float rowWeight(int steps) { return steps == 0 ? kMiddleWeight : 1; }

// How many rays went to the VPL in a slot, and how many of them reached it.
struct Tally {
  float rays = 0, reached = 0;
};

// VPLs that shine, each value in a list of its own, so that a compiler can process several at a time. Their number is a
// multiple of kBlock; those added for that have a weight of 0.
struct Lights {
  void add(const scene::Vpl& vpl, uint32_t slot, float chance) {
    const float power = vpl.intensity.x + vpl.intensity.y + vpl.intensity.z;
    if (!(power > 0)) return;
    x.push_back(vpl.position.x), y.push_back(vpl.position.y), z.push_back(vpl.position.z);
    normalX.push_back(vpl.normal.x), normalY.push_back(vpl.normal.y), normalZ.push_back(vpl.normal.z);
    area.push_back(vpl.area * glm::one_over_pi<float>());
    weight.push_back(chance * power);
    slots.push_back(slot);
    colors.push_back(vpl.intensity / (power * chance));
  }
  void clear() {
    for (std::vector<float>* list : lists()) list->clear();
    slots.clear();
    colors.clear();
  }
  void fillBlock() {
    const size_t count = (size() + kBlock - 1) / kBlock * kBlock;
    for (std::vector<float>* list : lists()) list->resize(count);
    slots.resize(count);
    colors.resize(count);
  }
  size_t size() const { return weight.size(); }
  glm::vec3 position(size_t i) const { return {x[i], y[i], z[i]}; }

  std::vector<float> x, y, z, normalX, normalY, normalZ;
  std::vector<float> area;  // of the disc, divided by pi, m^2
  std::vector<float>
      weight;  // sum over the channels of the intensity, times the chance that a ray reaches it
  std::vector<uint32_t> slots;
  std::vector<glm::vec3> colors;  // intensity divided by the weight

 private:
  std::array<std::vector<float>*, 8> lists() {
    return {&x, &y, &z, &normalX, &normalY, &normalZ, &area, &weight};
  }
};

// Light that each of them would send if nothing hid it, by weight:
// cos_s cos_l / (d^2 + A / pi) / d^2, in the form in which pass deferred has it.
void lightOfEach(const Lights& lights, glm::vec3 position, glm::vec3 normal, std::vector<float>& result) {
  result.resize(lights.size());
  for (size_t i = 0; i < lights.size(); ++i) {
    const float x = position.x - lights.x[i], y = position.y - lights.y[i], z = position.z - lights.z[i];
    const float d2 = std::max(x * x + y * y + z * z, 1e-12f);
    const float facing = std::max(-(normal.x * x + normal.y * y + normal.z * z), 0.0f);
    const float along = std::max(lights.normalX[i] * x + lights.normalY[i] * y + lights.normalZ[i] * z, 0.0f);
    result[i] = lights.weight[i] * facing * along / (d2 * (d2 + lights.area[i]));
  }
}

// The entry in whose share of the sum `place` lies, from which those before it are taken. Never one of 0, if there is
// another.
size_t pick(std::span<const float> values, float& place) {
  size_t last = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] > 0)) continue;
    last = i;
    if (place < values[i]) break;
    place -= values[i];
  }
  return last;
}

struct Surface {
  glm::vec3 position, normal;
};

// contact: a texel of pass contacts.
Surface surfaceAt(const scene::View& view, glm::uvec2 pixel, glm::uvec2 contact) {
  const glm::vec3 away = glm::normalize(view.rayDirection(glm::vec2(pixel) + 0.5f));
  return {view.eye + std::bit_cast<float>(contact.x) * away,
          scene::octDecode(glm::unpackSnorm2x16(contact.y))};
}

// The mean of what was found at a pixel and at the eight around it, as far as they are in contact and show the same
// surface. A few rays are a poor estimate, and a narrow window hardly widens the shadow of what is close.
glm::vec3 meanAround(const scene::View& view, glm::ivec2 size, std::span<const glm::uvec2> contacts,
                     std::span<const glm::vec3> found, glm::ivec2 pixel) {
  const auto indexOf = [&](glm::ivec2 p) { return size_t(p.y) * size_t(size.x) + size_t(p.x); };
  const Surface at = surfaceAt(view, pixel, contacts[indexOf(pixel)]);
  const glm::ivec2 low = glm::max(pixel - 1, 0), high = glm::min(pixel + 1, size - 1);
  glm::vec4 sum(0);
  for (glm::ivec2 p = low; p.y <= high.y; ++p.y)
    for (p.x = low.x; p.x <= high.x; ++p.x) {
      const size_t i = indexOf(p);
      if (contacts[i].x == 0) continue;
      const Surface other = surfaceAt(view, p, contacts[i]);
      const bool same = p == pixel || onSamePlane(at.position, at.normal, other.position, other.normal);
      const glm::ivec2 steps = glm::abs(p - pixel);
      if (same) sum += rowWeight(steps.x) * rowWeight(steps.y) * glm::vec4(found[i], 1);
    }
  return glm::vec3(sum) / sum.w;
}

// Light of VPLs at single pixels, for one thread.
class Sampler {
 public:
  Sampler(const scene::RayScene& rays, const scene::Frame& frame, const scene::View& view,
          std::span<const Lights> subsets, uint32_t count, uint32_t turn, size_t slots)
      : tallies(slots),
        rays_(rays),
        frame_(frame),
        view_(view),
        subsets_(subsets),
        count_(count),
        turn_(turn) {}

  std::vector<Tally> tallies;
  uint64_t traced = 0;  // rays so far

  // Irradiance / pi: the mean of `samples` estimates from one subset each. Over the frames, subsets and places in the
  // sum follow one low-discrepancy sequence. Further estimates take the places of the frames before, each in the next
  // subset.
  glm::vec3 lightAt(glm::uvec2 pixel, glm::uvec2 contact, uint32_t samples) {
    const Surface surface = surfaceAt(view_, pixel, contact);
    const uint32_t stream = randomStream(frame_.seed, pixel.x, kContactStream, pixel.y);
    const float part = scene::streamSequence(stream, turn_).y;
    const size_t first = std::min(size_t(part * float(kSubsets)), kSubsets - 1);
    glm::vec3 sum(0);
    for (uint32_t i = 0; i < samples; ++i)
      sum += lightOf(subsets_[(first + i) % kSubsets], surface, scene::streamSequence(stream, turn_ - i).x);
    traced += uint64_t(samples) * count_;
    return sum / float(samples);
  }

 private:
  // Irradiance / pi from all VPLs by those of one subset, chosen by the light they would send if nothing hid them and
  // by the chance that nothing does. offset: of the rays' places in the sum, from 0 to 1.
  glm::vec3 lightOf(const Lights& lights, const Surface& surface, float offset) {
    const auto [position, normal] = surface;
    const glm::vec3 away = glm::normalize(position - view_.eye);
    const glm::vec3 origin = position + (normal - away) * rays_.epsilon();
    lightOfEach(lights, position, normal, unhidden_);
    blocks_.clear();
    for (auto block = unhidden_.begin(); block != unhidden_.end(); block += kBlock)
      blocks_.push_back(std::reduce(block, block + kBlock));
    const float sum = std::reduce(blocks_.begin(), blocks_.end());
    if (!(sum > 0)) return glm::vec3(0);
    glm::vec3 light(0);
    for (uint32_t k = 0; k < count_; ++k) {
      float place = (float(k) + offset) / float(count_) * sum;
      const size_t block = kBlock * pick(blocks_, place);
      const size_t i = block + pick(std::span(unhidden_).subspan(block, kBlock), place);
      Tally& tally = tallies[lights.slots[i]];
      ++tally.rays;
      uint64_t surfaces = 0;
      const glm::vec3 visibility = scene::visibility(
          frame_, rays_, {origin, lights.position(i) - origin, 0, kContactRayEnd}, surfaces);
      if (visibility == glm::vec3(0)) continue;
      ++tally.reached;
      light += visibility * lights.colors[i];
    }
    return light * (sum * float(kSubsets) / float(count_) * glm::one_over_pi<float>());
  }

  const scene::RayScene& rays_;
  const scene::Frame& frame_;
  const scene::View& view_;
  std::span<const Lights> subsets_;
  uint32_t count_, turn_;
  std::vector<float> unhidden_, blocks_;  // light of each VPL if nothing hides it, and sums of kBlock of them
};

class ContactRaysHost : public Pass {
 public:
  static PassDeclaration declaration() {
    PassDeclaration d(
        "contact-rays-host",
        "the light of VPLs by rays where surfaces meet in the fovea, in grooves and at the feet "
        "of things: shadow maps are too coarse for what hides light there, and the filter of "
        "pass deferred carries light across",
        PassKind::Host);
    d.view();
    d.input("contacts", image2D(VK_FORMAT_R32G32_UINT), Usage::HostRead,
            "x: bits of the distance from the eye, m; y: octahedral normal; 0 elsewhere (pass contacts)");
    d.input("vpls", vplBuffer(), Usage::HostRead, "light sources; empty slots have zero intensity");
    d.input("history", buffer("VplTally", sizeof(Tally)), Usage::HostRead, "`tallies` of the previous frame");
    d.input("origin", image2D(VK_FORMAT_R32_UINT), Usage::HostRead,
            "0xffffffff where a surface has come into view and has no history (pass motion-vectors)")
        .makeOptional();
    d.output("light", image2D(VK_FORMAT_R16G16B16A16_SFLOAT, widthOf("contacts"), heightOf("contacts")),
             Usage::HostWrite,
             "rgb: irradiance / pi from VPLs, W/(sr m^2); a: `longer` where surfaces meet, else all 0");
    d.output("tallies", buffer("VplTally", sizeof(Tally), countOf("vpls")), Usage::HostWrite,
             "x: rays to the VPL in a slot, y: those that reached it; a quarter is forgotten in each frame");
    d.parameter("rays", integer(8, 1, 1024), "rays per pixel");
    d.parameter(
        "first_samples", integer(4, 1, 1024),
        "times as many rays where `origin`, if wired, says that there is no history; with 4 they look at "
        "all VPLs instead of a quarter");
    d.parameter(
        "filter", flag(true),
        "whether the light of a pixel is averaged with that of the eight around it, as far as they are in "
        "contact and on the same plane");
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
    const auto origin = ctx.has("origin") ? ctx.inputAs<uint32_t>("origin") : std::span<const uint32_t>{};
    const auto light = ctx.outputAs<uint64_t>("light");
    const auto tallies = ctx.outputAs<Tally>("tallies");
    std::ranges::fill(light, 0);
    std::ranges::fill(tallies, Tally{});
    if (frame.scene == nullptr || frame.geometry == nullptr || frame.geometry->empty()) return;
    const uint32_t width = ctx.extent("contacts").width, height = ctx.extent("contacts").height;
    if (const glm::uvec2 size = ctx.view().size; size != glm::uvec2(width, height))
      throw Error(ExitCode::BadInput,
                  "pass `contact-rays-host`: `contacts` has " + std::to_string(width) + "x" +
                      std::to_string(height) + " pixels, its view " + std::to_string(size.x) + "x" +
                      std::to_string(size.y),
                  "wire contacts of the view that the pass looks through");
    if (!origin.empty() && origin.size() != contacts.size())
      throw Error(ExitCode::BadInput,
                  "pass `contact-rays-host`: `origin` has " + std::to_string(origin.size()) +
                      " pixels, `contacts` " + std::to_string(contacts.size()),
                  "make both from the same G-buffer");
    const auto rays = scene::RayScene::cached(*frame.scene, *frame.geometry, passingOf(ctx.parameters()));
    for (size_t s = 0; s < kSubsets; ++s) {
      subsets_[s].clear();
      for (size_t i = s; i < vpls.size(); i += kSubsets)
        subsets_[s].add(vpls[i], uint32_t(i),
                        std::max((history[i].reached + 1) / (history[i].rays + 1), kLeastChance));
      subsets_[s].fillBlock();
    }
    const uint32_t count = uint32_t(ctx.parameters().integer("rays"));
    const uint32_t firstSamples = uint32_t(ctx.parameters().integer("first_samples"));
    const float longer = float(ctx.parameters().real("longer"));
    const bool filters = ctx.parameters().flag("filter");
    unfiltered_.resize(contacts.size());
    std::atomic<uint32_t> next = 0;
    std::mutex adding;
    uint64_t pixels = 0, traced = 0;
    onThreads(std::min(threadCount(0), height), [&] {
      Sampler sampler(*rays, frame, ctx.view(), subsets_, count, uint32_t(ctx.frameNumber()), vpls.size());
      uint64_t found = 0;
      for (uint32_t y = next++; y < height; y = next++)
        for (uint32_t x = 0; x < width; ++x) {
          const size_t i = size_t(y) * width + x;
          if (contacts[i].x == 0) continue;
          ++found;
          const uint32_t samples = !origin.empty() && origin[i] == scene::kNoIndex ? firstSamples : 1;
          unfiltered_[i] = glm::min(sampler.lightAt({x, y}, contacts[i], samples), 65504.0f);
        }
      const std::lock_guard lock(adding);
      pixels += found;
      traced += sampler.traced;
      for (size_t i = 0; i < tallies.size(); ++i) {  // whole numbers, so the order does not matter
        tallies[i].rays += sampler.tallies[i].rays;
        tallies[i].reached += sampler.tallies[i].reached;
      }
    });
    next = 0;
    onThreads(std::min(threadCount(0), height), [&] {
      for (uint32_t y = next++; y < height; y = next++)
        for (uint32_t x = 0; x < width; ++x) {
          const size_t i = size_t(y) * width + x;
          if (contacts[i].x == 0) continue;
          const glm::vec3 value = filters
                                      ? meanAround(ctx.view(), {width, height}, contacts, unfiltered_, {x, y})
                                      : unfiltered_[i];
          light[i] = glm::packHalf4x16(glm::vec4(value, longer));
        }
    });
    for (size_t i = 0; i < tallies.size(); ++i) {
      tallies[i].rays += kTallyKept * history[i].rays;
      tallies[i].reached += kTallyKept * history[i].reached;
    }
    ctx.counter("pixels", double(pixels));
    ctx.counter("rays", double(traced));
  }

 private:
  Lights subsets_[kSubsets];
  std::vector<glm::vec3> unfiltered_;  // light at each pixel in contact
};

FOVEA_PASS(ContactRaysHost);

}  // namespace
}  // namespace fovea::passes
