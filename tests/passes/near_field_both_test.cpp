// Compares the near-field light that rays find on the device with that found on the host.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>
#include <string>

#include "fovea/test.h"
#include "framework/base/random.h"
#include "framework/scene/frame.h"
#include "tests/passes/scene_of_everything.h"

namespace fovea::test {
namespace {

constexpr uint32_t kWidth = 39, kHeight = 29;  // neither fills its last tiles

struct Result {
  std::vector<glm::vec4> samples, gloss;
  float area;
  double rays, shaded, gathered;
};

// After 1, 4 and 6 frames.
std::vector<Result> run(bool onHost, const std::string& what) {
  PassTest test("near-field");
  test.raysOnHost(onHost);
  test.viewSize(kWidth, kHeight).scene(sceneOfEverything(what == "glass"));
  const char* materials = what == "diffuse" ? "diffuse" : "full";
  test.view("materials", materials).param("spacing", 8).param("first_samples", 3).param("saccade_samples", 3);
  test.buffer("change", std::vector<glm::vec4>{glm::vec4(0)}, "LightChange");
  if (what != "diffuse") {  // normals and roughnesses that vary
    std::vector<uint64_t> normal, specular;
    for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
      const auto part = [i](uint32_t k) { return uniformFloat(randomStream(5, i, k, 0)); };
      normal.push_back(glm::packHalf4x16(glm::vec4(part(0) - 0.5f, part(1) - 0.5f, 1, 1)));
      const float f0 = i % 3 == 0 ? 0.0f : i % 3 == 1 ? 0.04f : 0.8f;
      specular.push_back(glm::packHalf4x16(glm::vec4(glm::vec3(f0), part(2))));
    }
    test.image("gbuffer.normal", VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, normal);
    test.image("gbuffer.specular", VK_FORMAT_R16G16B16A16_SFLOAT, kWidth, kHeight, 1, specular);
  }
  test.beforeFrame([](PassTest& t, scene::Frame& frame) {
    if (frame.index == 2) t.buffer("change", std::vector<glm::vec4>{{0.1f, 0.5f, 0.6f, 0}}, "LightChange");
    frame.cameraCut = frame.index == 4;
    frame.views[0].gaze = {0.3f, 0.4f};
  });
  std::vector<Result> results;
  for (const uint32_t frames : {1u, 3u, 2u}) {
    test.run(frames);
    Result& r = results.emplace_back();
    r.area = test.values<glm::vec4>("spread")[0].x;
    r.rays = test.counter("rays");
    r.shaded = test.counter("shaded");
    r.gathered = test.counter("gathered");
    for (const uint64_t texel : test.values<uint64_t>("samples"))
      r.samples.push_back(glm::unpackHalf4x16(texel));
    if (what == "diffuse") continue;
    for (const uint64_t texel : test.values<uint64_t>("gloss")) r.gloss.push_back(glm::unpackHalf4x16(texel));
  }
  return results;
}

// Both take the same random numbers, so that they differ by rounding alone; where rays meet glass, that decides whether
// one passes.
TEST(NearFieldBoth, FindTheSameLight) {
  for (const std::string materials : {"diffuse", "full", "glass"}) {
    const std::vector<Result> onHost = run(true, materials), onDevice = run(false, materials);
    for (size_t frames = 0; frames < onHost.size(); ++frames) {
      const Result &host = onHost[frames], &device = onDevice[frames];
      ASSERT_EQ(host.samples.size(), device.samples.size());
      ASSERT_EQ(host.gloss.size(), materials == "diffuse" ? 0 : host.samples.size());
      ASSERT_EQ(device.gloss.size(), host.gloss.size());
      int different = 0, lit = 0, wide = 0, differentGloss = 0, ofItsOwn = 0;
      for (size_t i = 0; i < host.gloss.size(); ++i) {
        const glm::vec4 a = host.gloss[i], b = device.gloss[i], light = host.samples[i];
        EXPECT_EQ(a.a, light.a) << materials << " " << frames << " texel " << i;
        EXPECT_EQ(b.a, device.samples[i].a) << materials << " " << frames << " texel " << i;
        differentGloss += !(glm::length(glm::vec3(a - b)) <= 0.015f * glm::length(glm::vec3(a)) + 1e-6f);
        ofItsOwn += glm::length(glm::vec3(a - light)) > 0.1f * glm::length(glm::vec3(light));
      }
      const int most = int(host.samples.size()) / (materials == "glass" ? 25 : 50);
      EXPECT_LE(differentGloss, most) << materials << " " << frames;
      EXPECT_GE(ofItsOwn, int(host.gloss.size()) / 4) << materials << " " << frames;
      for (size_t i = 0; i < host.samples.size(); ++i) {
        const glm::vec4 a = host.samples[i], b = device.samples[i];
        EXPECT_EQ(a.a, b.a) << materials << " " << frames << " texel " << i;
        lit += a.r > 0;
        wide += (int(a.a) & 15) == 8;
        different += !(glm::length(glm::vec3(a - b)) <= 0.01f * glm::length(glm::vec3(a)) + 1e-6f);
      }
      EXPECT_GT(lit, int(host.samples.size()) / 2);
      EXPECT_GT(wide, int(host.samples.size()) / 4);
      EXPECT_LT(wide, int(host.samples.size()) * 3 / 4);
      EXPECT_LE(different, most) << materials << " " << frames;
      const double tolerance = materials == "glass" ? 0.06 : 1e-3;
      EXPECT_NEAR(device.area, host.area, tolerance * host.area) << materials << " " << frames;
      EXPECT_NEAR(device.shaded, host.shaded, tolerance * host.shaded + 1);
      EXPECT_NEAR(device.gathered, host.gathered, tolerance * host.gathered + 1);
      EXPECT_NEAR(device.rays, host.rays, (materials == "glass" ? 0.01 : 0.001) * host.rays);
    }
  }
}

}  // namespace
}  // namespace fovea::test
