// Compares the light of VPLs where surfaces meet with a plain sum over rays, and checks which pixels get it.
#include <gtest/gtest.h>

#include <cmath>

#include "fovea/error.h"
#include "tests/passes/eye_scene.h"
#include "tests/passes/vpl_scene.h"

namespace fovea::test {
namespace {

constexpr float kArea = 0.5f, kNear = 0.125f;
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

// Whether the box rises over the tangent plane of a pixel within `reach` metres and a 32nd of the picture's width,
// here one pixel, in the four directions along the axes.
bool inContact(const GBuffer& seen, int x, int y, float reach) {
  const SurfacePixel& p = seen.at(x, y);
  for (const auto& [dx, dy] : {std::pair(1, 0), {0, 1}, {-1, 0}, {0, -1}}) {
    const SurfacePixel& q =
        seen.at(std::clamp(x + dx, 0, seen.width - 1), std::clamp(y + dy, 0, seen.height - 1));
    const glm::vec3 to = q.position - p.position;
    if (q.distance > 0 && glm::dot(to, p.normal) > 0.3f * glm::length(to) && glm::length(to) < reach)
      return true;
  }
  return false;
}

struct Result {
  std::vector<uint64_t> before, after;
  std::vector<glm::vec2> tallies;
  double pixels = 0;
};

Result run(const Eye& eye, const std::vector<scene::Vpl>& vpls, double reach, double foveaRadius = 2,
           std::vector<glm::vec2> history = {}) {
  Result result;
  history.resize(vpls.size());
  const auto w = uint32_t(kSize.x), h = uint32_t(kSize.y);
  result.before.assign(size_t(w) * h, glm::packHalf4x16({0.25f, 0.5f, 0.75f, 0}));
  PassTest test("contact-rays");
  test.param("rays", 1024).param("longer", 3.0).param("fovea_radius", foveaRadius);
  test.param("reach", reach / std::sqrt(kArea / glm::pi<double>()));
  eye.seen.wire(test, "gbuffer", 2);
  test.image("irradiance", VK_FORMAT_R16G16B16A16_SFLOAT, w, h, 1, result.before);
  test.image("near_field", VK_FORMAT_R16G16B16A16_SFLOAT, w, h, 1,
             std::vector<uint64_t>(result.before.size(), glm::packHalf4x16(glm::vec4(kNear))));
  test.buffer("vpls", vpls, "Vpl");
  test.buffer("history", history, "VplTally");
  test.buffer("spread", std::vector<glm::vec4>{{kArea, 0, 0, 0}}, "VplSpread");
  test.scene(eye.scene).run();
  result.tallies = test.values<glm::vec2>("tallies");
  result.after = test.values<uint64_t>("irradiance");
  result.pixels = test.counter("pixels");
  EXPECT_EQ(test.counter("rays"), 1024 * result.pixels);
  return result;
}

// Compares all pixels in contact with rays to all VPLs.
void expectLightOfAllVpls(const Eye& eye, const std::vector<scene::Vpl>& vpls, const Result& got) {
  int hidden = 0, contacts = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const size_t i = size_t(y * kSize.x + x);
      const SurfacePixel& p = eye.seen.at(x, y);
      if (!inContact(eye.seen, x, y, 3)) {
        EXPECT_EQ(got.after[i], got.before[i]) << x << ", " << y;
        continue;
      }
      ++contacts;
      DeferredReference reference;
      reference.disc = true;
      glm::dvec3 want(kNear), open(kNear);
      for (const scene::Vpl& v : vpls) {
        const glm::dvec3 light = reference.shade(p, {v}, 0, 1),
                         from = glm::dvec3(p.position) + 1e-4 * glm::dvec3(p.normal);
        RayOptions options;
        options.tMax = 0.999;
        open += light;
        if (!castRay(eye.scene, eye.geometry, from, glm::dvec3(v.position) - from, options)) want += light;
      }
      hidden += want.g < 0.9 * open.g;
      const glm::vec4 light = glm::unpackHalf4x16(got.after[i]);
      EXPECT_EQ(light.a, 3);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[c], want[c], 0.01 * open[c] + 1e-3) << x << ", " << y;
    }
  EXPECT_EQ(got.pixels, contacts);
  EXPECT_GT(contacts, 30);
  EXPECT_GT(hidden, 5);
}

TEST(ContactRays, LightOfAllVplsThatRaysReach) {
  const Eye eye({0.3f, 0.2f, 0});
  const auto vpls = lamps();
  expectLightOfAllVpls(eye, vpls, run(eye, vpls, 3));
}

// What rays of former frames have met changes which VPLs are chosen, but not the light on average.
TEST(ContactRays, AnyHistoryGivesTheSameLight) {
  const Eye eye({0.3f, 0.2f, 0});
  const auto vpls = lamps();
  std::vector<glm::vec2> history;
  for (size_t i = 0; i < vpls.size(); ++i) history.emplace_back(100, i % 3 == 0 ? 0 : 40 * (i % 3));
  const Result got = run(eye, vpls, 3, 2, history);
  expectLightOfAllVpls(eye, vpls, got);
  double rays = 0;
  for (size_t i = 0; i < vpls.size(); ++i) {
    const glm::vec2 added = got.tallies[i] - 0.75f * history[i];
    rays += added.x;
    EXPECT_GE(added.y, 0);
    EXPECT_LE(added.y, added.x);
    if (vpls[i].intensity == glm::vec3(0)) EXPECT_EQ(added, glm::vec2(0));
  }
  EXPECT_EQ(rays, 1024 * got.pixels);
}

TEST(ContactRays, OnlyWhatIsClose) {
  const Eye eye({0.3f, 0.2f, 0});  // the box is at least a metre in front of the wall
  const Result got = run(eye, lamps(), 0.9);
  EXPECT_EQ(got.pixels, 0);
  EXPECT_EQ(got.after, got.before);
}

TEST(ContactRays, OnlyInTheFovea) {
  const Eye eye({0.3f, 0.2f, 0});
  constexpr float kRadius = 0.2f;
  const Result got = run(eye, lamps(), 3, kRadius);
  EXPECT_GT(got.pixels, 0);
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const bool fovea =
          glm::distance(glm::vec2(x, y) + 0.5f, 0.5f * glm::vec2(kSize)) <= kRadius * float(kSize.x);
      const size_t i = size_t(y * kSize.x + x);
      EXPECT_EQ(got.after[i] != got.before[i], fovea && inContact(eye.seen, x, y, 3)) << x << ", " << y;
    }
}

TEST(ContactRays, WithoutVplsOnlyTheNearField) {
  const Eye eye({0.3f, 0.2f, 0});
  const Result got = run(eye, std::vector<scene::Vpl>(8), 3);
  EXPECT_GT(got.pixels, 30);
  for (size_t i = 0; i < got.after.size(); ++i) {
    if (got.after[i] == got.before[i]) continue;
    EXPECT_EQ(glm::unpackHalf4x16(got.after[i]), glm::vec4(kNear, kNear, kNear, 3));
  }
}

// Each frame one subset stands for all; their mean is the light of all VPLs.
TEST(ContactRays, SubsetsTakeTurns) {
  const Eye eye({0.3f, 0.2f, 0});
  std::vector<scene::Vpl> vpls = lamps();
  for (size_t i = 0; i < vpls.size(); ++i)
    if (i % kSubsets != 1) vpls[i].intensity = glm::vec3(0);
  const auto w = uint32_t(kSize.x), h = uint32_t(kSize.y);
  const std::vector<uint64_t> before(size_t(w) * h, glm::packHalf4x16(glm::vec4(0)));
  PassTest test("contact-rays");
  test.param("rays", 256).param("fovea_radius", 2.0).param("reach", 10.0);
  eye.seen.wire(test, "gbuffer", 2);
  test.image("irradiance", VK_FORMAT_R16G16B16A16_SFLOAT, w, h, 1, before);
  test.image("near_field", VK_FORMAT_R16G16B16A16_SFLOAT, w, h, 1, before);
  test.buffer("vpls", vpls, "Vpl");
  test.buffer("history", std::vector<glm::vec2>(vpls.size()), "VplTally");
  test.buffer("spread", std::vector<glm::vec4>{{kArea, 0, 0, 0}}, "VplSpread");
  test.scene(eye.scene);
  test.run();
  int lit = 0;
  for (const uint64_t value : test.values<uint64_t>("irradiance")) lit += glm::unpackHalf4x16(value).g > 0;
  EXPECT_NEAR(lit / test.counter("pixels"), 1.0 / kSubsets, 0.15);
}

}  // namespace
}  // namespace fovea::test
