// Compares what each pass that traces rays makes with rays on the host and on the device.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <string>
#include <vector>

#include "fovea/test.h"
#include "shaders/records/mirror.h"
#include "shaders/records/reservoir.h"
#include "shaders/records/vpl.h"
#include "tests/passes/deferred_reference.h"
#include "tests/passes/probe_reference.h"
#include "tests/passes/scene_of_everything.h"
#include "tests/passes/vpl_intensity_reference.h"
#include "tests/references/blocks.h"

namespace fovea::test {
namespace {

constexpr uint32_t kWidth = 36, kHeight = 28, kPixels = kWidth * kHeight;

// What the eye sees of the scene, and the inputs that passes need of it.
struct Inputs {
  Room room = lookInto(sceneOfEverything(false), 8, glm::ivec2(kWidth, kHeight));
  GBuffer seen{kWidth, kHeight, room.camera, [&](int x, int y) {
                 const Seen& s = room.pixels[size_t(y) * kWidth + size_t(x)];
                 SurfacePixel p;
                 p.position = s.position;
                 p.distance = s.there ? glm::length(s.position) : 0.0f;  // the eye is at the origin
                 p.normal = s.normal;
                 p.specular = {0.04f, 0.04f, 0.04f, 0.1f + 0.2f * float(x % 4)};
                 p.grazing = 1;
                 return p;
               }};
};

template <class T>
void wireImage(PassTest& test, const char* port, VkFormat format, const std::vector<T>& texels,
               uint32_t shrunk = 1) {
  test.image(port, format, kWidth / shrunk, kHeight / shrunk, 1, texels);
}

void dimSecondFrame(scene::Frame& frame) {
  if (frame.index == 1) frame.lights[0].color *= 0.8f;
}

// An image that passes update where nothing is known yet, which is everywhere in each frame.
void wireUnknown(PassTest& test, const char* port) {
  const std::vector<uint64_t> unknown(kPixels);
  wireImage(test, port, VK_FORMAT_R16G16B16A16_SFLOAT, unknown);
  test.beforeFrame([port, unknown](PassTest& t, scene::Frame& frame) {
    t.set(port, unknown);
    dimSecondFrame(frame);
  });
}

void wireNearField(PassTest& test, const Inputs& in) {
  test.param("first_samples", 3).buffer("change", std::vector<glm::vec4>{glm::vec4(0)}, "LightChange");
  if (in.seen.full) in.seen.wire(test);
}

void wireNearFieldPixels(PassTest& test, const Inputs&) {
  test.param("samples", 2).buffer("spread", std::vector<glm::vec4>{{0.5f, 0, 0, 0}}, "VplSpread");
  std::vector<uint8_t> mask;
  for (uint32_t i = 0; i < kPixels; ++i) mask.push_back(i % 3 == 0 ? 0 : 255);
  wireImage(test, "shade.mask", VK_FORMAT_R8_UNORM, mask);
  wireUnknown(test, "near_field");
}

void wireEyePaths(PassTest& test, const Inputs&) {
  test.param("points", 128).param("paths", 512).param("bounces", 3).param("region", "mixed");
  test.param("renew_frames", 1000).param("trace_frames", 2);
}

void wireShadowRays(PassTest& test, const Inputs& in) {
  in.seen.wire(test);
  wireImage(test, "gbuffer.emission", VK_FORMAT_R16G16B16A16_SFLOAT, std::vector<uint64_t>(kPixels));
  wireUnknown(test, "direct");
}

void wireContactRays(PassTest& test, const Inputs& in) {
  std::vector<glm::uvec2> contacts;
  for (const SurfacePixel& p : in.seen.pixels)
    contacts.emplace_back(std::bit_cast<uint32_t>(p.distance), glm::packSnorm2x16(octEncode(p.normal)));
  wireImage(test, "contacts", VK_FORMAT_R32G32_UINT, contacts);
  std::vector<scene::Vpl> vpls(16);
  for (size_t i = 0; i < vpls.size(); ++i)
    vpls[i] = {{0.4f * float(i) - 3, i % 2 == 0 ? 1.5f : -1.0f, -1}, 0.3f, {0, 0, -1}, 0, {3, 2, 1}, 0};
  test.buffer("vpls", vpls, "Vpl");
  test.buffer("history", std::vector<glm::vec2>(vpls.size(), glm::vec2(0)), "VplTally");
}

void wireReflections(PassTest& test, const Inputs& in) {
  constexpr uint32_t kColumns = kWidth / 2, kRows = kHeight / 2;
  std::vector<glm::uvec4> mirrors;
  for (uint32_t i = 0; i < kColumns * kRows; ++i) {
    const glm::uvec2 block(i % kColumns, i / kColumns), inside = passes::samplePixel(0, 2, block),
                                                        p = 2u * block + inside;
    const SurfacePixel& seen = in.seen.at(int(p.x), int(p.y));
    const uint32_t normal = glm::packSnorm2x16(octEncode(seen.normal));
    mirrors.emplace_back(std::bit_cast<uint32_t>(seen.distance), normal, normal,
                         passes::sampleCode(2, inside, true) | glm::packUnorm2x16(glm::vec2(0, 0.25f)));
  }
  wireImage(test, "mirrors", VK_FORMAT_R32G32B32A32_UINT, mirrors, 2);
}

void wireProbeRays(PassTest& test, const Inputs&) {
  test.param("probes", 4).param("rays", 32);
  knownProbes(64, 4).wire(test, "probes");
}

void wireGiSamples(PassTest& test, const Inputs&) { test.param("paths", 2); }

void wireReservoirsVisibility(PassTest& test, const Inputs& in) {
  in.seen.wire(test);
  std::vector<passes::Reservoir> own(kPixels), others(kPixels);
  std::vector<uint32_t> sources;
  Numbers numbers(7);
  const auto some = [&] { return uint32_t(numbers.next(0, float(kPixels) - 0.5f)); };
  for (uint32_t i = 0; i < kPixels; ++i) {
    for (passes::Reservoir* r : {&own[i], &others[i]}) {
      r->position = glm::vec3(numbers.next(-3, 3), numbers.next(-2, 2), numbers.next(-4, -1));
      r->normal = glm::normalize(r->position);  // towards the wall
      r->weight = 1;
    }
    const uint32_t source = some();
    sources.push_back(source % kWidth | source / kWidth << 16);
  }
  test.buffer("own", own, "Reservoir").buffer("others", others, "Reservoir");
  wireImage(test, "sources", VK_FORMAT_R32_UINT, sources);
}

struct Case {
  const char* pass;
  void (*wire)(PassTest&, const Inputs&);
  bool onlyFull = false;  // diffuse surfaces are no mirrors
};

class RaysBoth : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Passes, RaysBoth,
                         testing::Values(Case{"contact-rays", wireContactRays},
                                         Case{"eye-paths", wireEyePaths}, Case{"gi-samples", wireGiSamples},
                                         Case{"near-field", wireNearField},
                                         Case{"near-field-pixels", wireNearFieldPixels},
                                         Case{"probe-rays", wireProbeRays},
                                         Case{"reflections", wireReflections, true},
                                         Case{"reservoirs-visibility", wireReservoirsVisibility},
                                         Case{"shadow-rays", wireShadowRays}),
                         [](const testing::TestParamInfo<Case>& test) {
                           std::string name = test.param.pass;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

// The numbers of an output, and how many belong to one texel or record.
struct Elements {
  std::vector<float> numbers;  // whole numbers as floats of the same bits
  size_t each = 1;

  Elements(const PassTest& test, const std::string& port) {
    const graph::ResourceDesc& desc = test.desc(port);
    const bool image = desc.kind == graph::ResourceKind::Image;
    numbers = image && desc.format != VK_FORMAT_R32_UINT ? test.floats(port) : test.values<float>(port);
    each = image ? numbers.size() / (size_t(desc.width) * desc.height) : desc.stride / sizeof(float);
  }
  size_t size() const { return numbers.size() / each; }
  bool isZero(size_t element) const {
    return std::all_of(&numbers[element * each], &numbers[element * each] + each,
                       [](float x) { return std::bit_cast<uint32_t>(x) == 0; });
  }
  // But for rounding, relative to the largest number of the element.
  bool isLike(const Elements& other, size_t element) const {
    float largest = 0;
    for (size_t k = 0; k < each; ++k) {
      const float a = numbers[element * each + k];
      if (std::isnormal(a) && std::abs(a) < 1e29f) largest = std::max(largest, std::abs(a));
    }
    const auto isNumber = [](float x) { return x == 0 || std::isnormal(x); };
    for (size_t k = 0; k < each; ++k) {
      const float a = numbers[element * each + k], b = other.numbers[element * each + k];
      if (std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b)) continue;
      if (!isNumber(a) || !isNumber(b) || !(std::abs(a - b) <= 0.01f * largest + 1e-6f)) return false;
    }
    return true;
  }
};

// Both take the same random numbers, so that they differ by rounding alone, and by what a few rays meet at edges.
TEST_P(RaysBoth, FindTheSame) {
  Inputs in;
  for (const char* materials : {"diffuse", "full"}) {
    SCOPED_TRACE(materials);
    in.seen.full = materials == std::string("full");
    if (GetParam().onlyFull && !in.seen.full) continue;
    PassTest host(GetParam().pass), device(GetParam().pass);
    for (PassTest* test : {&host, &device}) {
      test->viewSize(kWidth, kHeight).scene(in.room.scene).view("materials", materials);
      test->beforeFrame([](PassTest&, scene::Frame& frame) { dimSecondFrame(frame); });
      GetParam().wire(*test, in);
      test->raysOnHost(test == &host).run(2);
    }
    for (const graph::PortSpec& port : host.declaration().ports) {
      if (port.direction != graph::Direction::Output && port.direction != graph::Direction::InOut) continue;
      for (const graph::MemberSpec& member : port.members) {
        const std::string name = graph::memberPath(port, member);
        SCOPED_TRACE(name);
        const Elements a(host, name), b(device, name);
        ASSERT_EQ(a.numbers.size(), b.numbers.size());
        if (host.desc(name).kind == graph::ResourceKind::Image && a.size() == 1)
          continue;  // not of these materials
        size_t zero = 0, different = 0;
        for (size_t i = 0; i < a.size(); ++i) {
          zero += a.isZero(i);
          different += !a.isLike(b, i);
        }
        EXPECT_LE(different, a.size() / 50) << "of " << a.size();
        EXPECT_LE(zero, a.size() * 3 / 4) << "of " << a.size();
      }
    }
    const double rays = host.counter("rays");
    EXPECT_GT(rays, 100);
    EXPECT_NEAR(device.counter("rays"), rays, 0.02 * rays);
  }
}

}  // namespace
}  // namespace fovea::test
