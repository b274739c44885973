// Compares the light of VPLs where surfaces meet with a plain sum over rays.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "tests/passes/eye_scene.h"
#include "tests/passes/vpl_scene.h"
#include "tests/passes/where_rays_run.h"

namespace fovea::test {
namespace {

class ContactRays : public WhereRaysRun {};
INSTANTIATE_TEST_SUITE_P(Rays, ContactRays, testing::Bool(), nameOfPlace);

constexpr float kArea = 0.5f;
constexpr int kSubsets = 4;  // of which a frame uses one for each pixel

// Six VPLs around the box that shine at the wall, so that it hides some of them from parts of the wall; four copies of each, so
// that all subsets are the same.
std::vector<scene::Vpl> lamps() {
  std::vector<scene::Vpl> list;
  for (int i = 0; i < 6; ++i) {
    scene::Vpl v =
        vpl({-2.5f + float(i), i % 2 == 0 ? -1.5f : 1.2f, -2.6f - 0.1f * float(i)}, {0.1f, 0.2f, -1});
    v.intensity = glm::vec3(3, 1 + float(i), 6 - float(i)) / float(kSubsets);
    v.area = kArea;
    list.insert(list.end(), kSubsets, v);
  }
  list.insert(list.begin() + 5, kSubsets, scene::Vpl{});  // empty slots in between
  list.push_back({});
  return list;
}

constexpr uint32_t kWidth = uint32_t(kSize.x), kHeight = uint32_t(kSize.y);

constexpr float kLonger = 3;  // length of means of this light, in those of others

bool everyThird(size_t pixel) { return pixel % 3 == 0; }
bool mostPixels(size_t pixel) { return pixel % 5 != 0; }
bool everySecond(size_t pixel) { return pixel % 2 == 0; }
bool allPixels(size_t) { return true; }

// The chosen pixels of the eye's picture are in contact.
std::vector<glm::uvec2> contactsOf(const GBuffer& seen, bool (*chosen)(size_t)) {
  std::vector<glm::uvec2> contacts(seen.pixels.size(), glm::uvec2(0));
  for (size_t i = 0; i < contacts.size(); ++i)
    if (chosen(i))
      contacts[i] = {std::bit_cast<uint32_t>(seen.pixels[i].distance),
                     glm::packSnorm2x16(octEncode(seen.pixels[i].normal))};
  return contacts;
}

struct Result {
  std::vector<uint64_t> light;
  std::vector<glm::vec2> tallies;
  double pixels = 0;
};

struct Settings {
  int rays = 1024;
  std::vector<glm::vec2> history;
  bool filter = false;
  bool (*contact)(size_t) = everyThird;
  uint32_t frames = 1;
  // Pixels whose surface has come into view; without it, `origin` is not wired.
  bool (*fresh)(size_t) = nullptr;
  int firstSamples = kSubsets;
};

// Any pixel where there is a history.
std::vector<uint32_t> originOf(size_t pixels, bool (*fresh)(size_t)) {
  std::vector<uint32_t> origin(pixels);
  for (size_t i = 0; i < pixels; ++i) origin[i] = fresh(i) ? 0xffffffffu : uint32_t(i);
  return origin;
}

Result run(const Eye& eye, const std::vector<scene::Vpl>& vpls, const Settings& settings, bool onHost) {
  const int rays = settings.rays;
  std::vector<glm::vec2> history = settings.history;
  history.resize(vpls.size());
  PassTest test("contact-rays");
  test.raysOnHost(onHost);
  test.param("filter", settings.filter);
  test.param("longer", kLonger);
  test.param("rays", rays);
  test.param("first_samples", settings.firstSamples);
  if (settings.fresh)
    test.image("origin", VK_FORMAT_R32_UINT, kWidth, kHeight, 1,
               originOf(eye.seen.pixels.size(), settings.fresh));
  test.viewSize(kWidth, kHeight).scene(eye.scene);
  test.beforeFrame([&](PassTest&, scene::Frame& frame) {
    frame.views[0] = eye.view;
    frame.views[0].foveaRadius = 2;  // all of the picture
  });
  test.image("contacts", VK_FORMAT_R32G32_UINT, kWidth, kHeight, 1, contactsOf(eye.seen, settings.contact));
  test.buffer("vpls", vpls, "Vpl");
  test.buffer("history", history, "VplTally");
  test.run(settings.frames);
  Result result{test.values<uint64_t>("light"), test.values<glm::vec2>("tallies"), test.counter("pixels")};
  size_t inContact = 0, samples = 0;
  for (size_t i = 0; i < eye.seen.pixels.size(); ++i) {
    const bool fresh = settings.fresh && settings.fresh(i);
    inContact += settings.contact(i);
    if (settings.contact(i)) samples += fresh ? size_t(settings.firstSamples) : 1;
  }
  EXPECT_EQ(result.pixels, double(inContact));
  EXPECT_EQ(test.counter("rays"), double(rays) * double(samples));
  return result;
}

Result run(const Eye& eye, const std::vector<scene::Vpl>& vpls, const Settings& settings = {}) {
  return run(eye, vpls, settings, ContactRays::GetParam());
}

// Compares all pixels in contact with rays to all VPLs.
void expectLightOfAllVpls(const Eye& eye, const std::vector<scene::Vpl>& vpls, const Result& got) {
  int hidden = 0;
  for (size_t i = 0; i < got.light.size(); ++i) {
    if (i % 3 != 0) {
      EXPECT_EQ(got.light[i], 0u) << i;
      continue;
    }
    const SurfacePixel& p = eye.seen.pixels[i];
    DeferredReference reference;
    reference.disc = true;
    glm::dvec3 want(0), open(0);
    for (const scene::Vpl& v : vpls) {
      const glm::dvec3 light = reference.shade(p, {v}, 0, 1);
      const glm::dvec3 from = glm::dvec3(p.position) + 1e-4 * glm::dvec3(p.normal);
      RayOptions options;
      options.tMax = 0.999;
      open += light;
      if (!castRay(eye.scene, eye.geometry, from, glm::dvec3(v.position) - from, options)) want += light;
    }
    hidden += want.g < 0.9 * open.g;
    const glm::vec4 light = glm::unpackHalf4x16(got.light[i]);
    EXPECT_EQ(light.a, kLonger);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[c], want[c], 0.01 * open[c] + 1e-3) << "pixel " << i;
  }
  EXPECT_GT(hidden, 20);
}

TEST_P(ContactRays, LightOfAllVplsThatRaysReach) {
  const Eye eye({0.3f, 0.2f, 0});
  const auto vpls = lamps();
  expectLightOfAllVpls(eye, vpls, run(eye, vpls));
}

// The results of rays of earlier frames change which VPLs are chosen, but not the light on average.
TEST_P(ContactRays, AnyHistoryGivesTheSameLight) {
  const Eye eye({0.3f, 0.2f, 0});
  const auto vpls = lamps();
  std::vector<glm::vec2> history;
  for (size_t i = 0; i < vpls.size(); ++i) history.emplace_back(100, 40 * (i % 3));
  const Result got = run(eye, vpls, {.history = history});
  expectLightOfAllVpls(eye, vpls, got);
  double rays = 0;
  for (size_t i = 0; i < vpls.size(); ++i) {
    const glm::vec2 added = got.tallies[i] - 0.75f * history[i];
    rays += added.x;
    EXPECT_GE(added.y, 0);
    EXPECT_LE(added.y, added.x);
    EXPECT_TRUE(vpls[i].intensity != glm::vec3(0) || added == glm::vec2(0)) << "a ray to an empty slot";
  }
  EXPECT_GT(rays, 0.9 * 1024 * got.pixels) << "few pixels lie in no VPL's light";
}

// Where a surface has come into view there is no mean over frames in which subsets could take turns.
TEST_P(ContactRays, AllSubsetsAtOnceWithoutHistory) {
  const Eye eye({0.3f, 0.2f, 0});
  std::vector<scene::Vpl> vpls = lamps();
  for (size_t i = 0; i < vpls.size(); ++i) vpls[i].intensity *= 0.25f + 0.5f * float(i % kSubsets);
  expectLightOfAllVpls(eye, vpls, run(eye, vpls, {.rays = 256, .fresh = allPixels}));
  expectLightOfAllVpls(eye, vpls,
                       run(eye, vpls, {.rays = 128, .fresh = allPixels, .firstSamples = 2 * kSubsets}));
}

// The others are as they are without `origin`, and a single sample is the one that they have.
TEST_P(ContactRays, MoreSamplesOnlyWithoutHistory) {
  const Eye eye({0.3f, 0.2f, 0});
  const auto vpls = lamps();
  const Result none = run(eye, vpls, {.rays = 1}),
               single = run(eye, vpls, {.rays = 1, .fresh = everySecond, .firstSamples = 1}),
               got = run(eye, vpls, {.rays = 1, .fresh = everySecond});
  EXPECT_EQ(single.light, none.light);
  int different = 0;
  for (size_t i = 0; i < got.light.size(); ++i) {
    if (everySecond(i))
      different += got.light[i] != none.light[i];
    else
      EXPECT_EQ(got.light[i], none.light[i]) << i;
  }
  EXPECT_GT(different, 200);
}

// Each of several samples is an estimate of its own: their mean has a fraction of the variance.
TEST_P(ContactRays, SamplesOfFramesThatWereMissed) {
  const Eye eye({0.3f, 0.2f, 0});
  const auto vpls = lamps();
  const auto varianceOf = [&](bool (*fresh)(size_t)) {
    const Result exact = run(eye, vpls), got = run(eye, vpls, {.rays = 1, .fresh = fresh});
    double sum = 0;
    for (size_t i = 0; i < got.light.size(); i += 3) {
      const float d = glm::unpackHalf4x16(got.light[i]).g - glm::unpackHalf4x16(exact.light[i]).g;
      sum += double(d) * d;
    }
    return sum;
  };
  EXPECT_LT(varianceOf(allPixels), 0.35 * varianceOf(nullptr));
}

// The box hides part of the wall, so that many windows show both, and pixels that are not in contact.
TEST_P(ContactRays, FilterAveragesPixelsOnTheSamePlane) {
  const Eye eye({0.3f, 0.2f, 0});
  const auto vpls = lamps();
  const Result single = run(eye, vpls, {.rays = 2, .contact = mostPixels}),
               got = run(eye, vpls, {.rays = 2, .filter = true, .contact = mostPixels});
  int others = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const size_t at = size_t(y * kSize.x + x);
      if (!mostPixels(at)) {
        EXPECT_EQ(got.light[at], 0u);
        continue;
      }
      const SurfacePixel& p = eye.seen.pixels[at];
      glm::dvec3 sum(0);
      double weights = 0;
      for (int k = 0; k < 9; ++k) {
        const int dx = k % 3 - 1, dy = k / 3 - 1;
        if (x + dx < 0 || y + dy < 0 || x + dx >= kSize.x || y + dy >= kSize.y) continue;
        const size_t i = at + size_t(dy * kSize.x + dx);
        if (!mostPixels(i)) continue;
        const glm::vec3 to = eye.seen.pixels[i].position - p.position;
        const bool same = glm::dot(eye.seen.pixels[i].normal, p.normal) > 0.9f &&
                          std::abs(glm::dot(to, p.normal)) < 0.1f * glm::length(to) + 1e-6f;
        others += !same;
        if (!same) continue;
        const double weight = (dx == 0 ? 2 : 1) * (dy == 0 ? 2 : 1);
        sum += weight * glm::dvec3(glm::unpackHalf4x16(single.light[i]));
        weights += weight;
      }
      const glm::vec4 light = glm::unpackHalf4x16(got.light[at]);
      EXPECT_EQ(light.a, kLonger);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(light[c], sum[c] / weights, 2e-3 * sum[c] / weights + 1e-6) << x << " " << y;
    }
  EXPECT_GT(others, 100);
}

// Both take the same random numbers, so that they differ by rounding alone.
TEST(ContactRaysBoth, GiveTheSameLight) {
  const Eye eye({0.3f, 0.2f, 0});
  const auto vpls = lamps();
  std::vector<glm::vec2> history;
  for (size_t i = 0; i < vpls.size(); ++i) history.emplace_back(100, 40 * (i % 3));
  const Settings settings{.rays = 3,
                          .history = history,
                          .filter = true,
                          .contact = mostPixels,
                          .frames = 3,
                          .fresh = everySecond};
  const Result host = run(eye, vpls, settings, true), device = run(eye, vpls, settings, false);
  int different = 0;
  for (size_t i = 0; i < host.light.size(); ++i) {
    const glm::vec4 a = glm::unpackHalf4x16(host.light[i]), b = glm::unpackHalf4x16(device.light[i]);
    different += !(glm::length(a - b) <= 2e-3f * glm::length(a));
  }
  EXPECT_LE(different, int(host.light.size()) / 200);
  for (size_t i = 0; i < vpls.size(); ++i)
    EXPECT_LE(glm::length(host.tallies[i] - device.tallies[i]), 0.01f * host.tallies[i].x + 2) << i;
}

// In each frame one subset stands for all.
TEST_P(ContactRays, SubsetsTakeTurns) {
  const Eye eye({0.3f, 0.2f, 0});
  std::vector<scene::Vpl> vpls = lamps();
  const auto litShare = [&] {
    int lit = 0, all = 0;
    const Result got = run(eye, vpls, {.rays = 256});
    for (size_t i = 0; i < got.light.size(); i += 3, ++all) lit += glm::unpackHalf4x16(got.light[i]).g > 0;
    return double(lit) / all;
  };
  EXPECT_GT(litShare(), 0.6);
  for (size_t i = 0; i < vpls.size(); ++i)
    if (i % kSubsets != 1) vpls[i].intensity = glm::vec3(0);
  EXPECT_NEAR(litShare(), 0.9 / kSubsets, 0.1);
}

TEST_P(ContactRays, WithoutVplsThereIsNoLight) {
  const Eye eye({0.3f, 0.2f, 0});
  RayPassTest test("contact-rays");
  test.param("longer", kLonger);
  test.viewSize(kWidth, kHeight).scene(eye.scene);
  test.image("contacts", VK_FORMAT_R32G32_UINT, kWidth, kHeight, 1, contactsOf(eye.seen, everyThird));
  test.buffer("vpls", std::vector<scene::Vpl>(8), "Vpl");
  test.buffer("history", std::vector<glm::vec2>(8, {100, 50}), "VplTally");
  test.run();
  for (const uint64_t value : test.values<uint64_t>("light"))
    EXPECT_TRUE(value == 0 || glm::unpackHalf4x16(value) == glm::vec4(0, 0, 0, kLonger));
  for (const glm::vec2 tally : test.values<glm::vec2>("tallies")) EXPECT_EQ(tally, glm::vec2(75, 37.5f));
}

}  // namespace
}  // namespace fovea::test
