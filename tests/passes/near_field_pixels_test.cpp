// Compares near-field light at single pixels with plain rays in an emissive room, and with light that is known already.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <string>

#include "fovea/error.h"
#include "tests/passes/vpl_intensity_reference.h"
#include "tests/passes/where_rays_run.h"

namespace fovea::test {
namespace {

constexpr glm::ivec2 kSize(24, 16);
constexpr float kArea = 0.3f;

class NearFieldPixels : public WhereRaysRun {};
INSTANTIATE_TEST_SUITE_P(Rays, NearFieldPixels, testing::Bool(), nameOfPlace);

// Walls that emit {1, 2, 4} and reflect half of what they get: with light of up to two reflections they send 1.75 times
// as much.
Room emissiveRoom() {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0.5f)), walls[6] = {m, m, m, m, m, m};
  s.materials[m].emission = {1, 2, 4};
  addRoom(s, walls, 2);
  return lookInto(std::move(s), 8, kSize);
}

// Mean of A / (pi d^2 + A) over the cosine-weighted hemisphere of a pixel.
double partOf(const Room& room, const Seen& seen) {
  constexpr int kRays = 1000;
  double sum = 0;
  for (int i = 0; i < kRays; ++i) {
    const float u = (float(i) + 0.5f) / float(kRays), v = uniformFloat(uint32_t(i) * 2654435769u);
    const float r = std::sqrt(u), phi = glm::two_pi<float>() * v;
    const glm::dvec3 d(scene::toWorld(scene::orthonormalFrame(seen.normal),
                                      {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)}));
    const RayHit hit =
        castRay(room.scene, room.geometry, glm::dvec3(seen.position) + 1e-5 * glm::dvec3(seen.normal), d);
    sum += kArea / (glm::pi<double>() * hit.t * hit.t + kArea) / kRays;
  }
  return sum;
}

void wire(PassTest& test, const scene::Scene& scene, const std::vector<uint8_t>& mask,
          const std::vector<uint64_t>& before) {
  test.viewSize(uint32_t(kSize.x), uint32_t(kSize.y)).scene(scene);
  test.image("shade.mask", VK_FORMAT_R8_UNORM, kSize.x, kSize.y, 1, mask);
  test.image("near_field", VK_FORMAT_R16G16B16A16_SFLOAT, kSize.x, kSize.y, 1, before);
  test.buffer("spread", std::vector<glm::vec4>{{kArea, 0, 0, 0}}, "VplSpread");
}

TEST_P(NearFieldPixels, OnlyWhereItIsNotKnown) {
  const Room room = emissiveRoom();
  const uint64_t known = glm::packHalf4x16({1, 2, 3, 1}), unknown = glm::packHalf4x16({5, 6, 7, 0});
  std::vector<uint8_t> mask;
  std::vector<uint64_t> before;
  for (uint32_t i = 0; i < room.pixels.size(); ++i) {
    mask.push_back(i % 3 == 0 ? 0 : 255);
    before.push_back(i % 2 == 0 ? known : unknown);
  }
  RayPassTest test("near-field-pixels");
  constexpr int kSamples = 256;
  test.param("samples", kSamples);
  wire(test, room.scene, mask, before);
  test.run();
  const auto after = test.values<uint64_t>("near_field");
  double got = 0, wanted = 0;
  int traced = 0;
  for (uint32_t i = 0; i < after.size(); ++i) {
    if (mask[i] == 0 || before[i] == known) {
      ASSERT_EQ(after[i], before[i]) << "pixel " << i;
      continue;
    }
    ++traced;
    const glm::vec4 light = glm::unpackHalf4x16(after[i]);
    const double part = partOf(room, room.pixels[i]);
    // What the walls emit comes wholly, what they reflect in part. A ray goes on with a probability of at most four
    // times its part.
    const double want = 1 + 0.75 * part;
    const double bound = 0.01 + 4.5 / std::sqrt(4 * part * kSamples);
    EXPECT_EQ(light.a, 1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[c] / ((1 << c) * want), 1, bound) << "pixel " << i;
    got += light.r;
    wanted += want;
  }
  EXPECT_NEAR(got / wanted, 1, 0.01);
  EXPECT_EQ(test.counter("pixels"), traced);
  EXPECT_EQ(traced, 128);
  // Nothing depends on the number of the frame, so that what is seen does not flicker.
  test.set("near_field", before);
  test.run(2);
  EXPECT_EQ(test.values<uint64_t>("near_field"), after);
}

// In a block of 4 x 4 pixels no single ray makes one pixel brighter than all others.
TEST_P(NearFieldPixels, NoFireflies) {
  const size_t count = size_t(kSize.x) * kSize.y;
  RayPassTest test("near-field-pixels");
  wire(test, emissiveRoom().scene, std::vector<uint8_t>(count, 255), std::vector<uint64_t>(count));
  test.run();
  const auto light = test.values<uint64_t>("near_field");
  for (int block = 0; block < kSize.x / 4 * kSize.y / 4; ++block) {
    std::vector<float> red;  // all light of the room has the same colour
    for (int i = 0; i < 16; ++i) {
      const int x = block % (kSize.x / 4) * 4 + i % 4, y = block / (kSize.x / 4) * 4 + i / 4;
      red.push_back(glm::unpackHalf4x16(light[size_t(y * kSize.x + x)]).r);
    }
    std::ranges::sort(red);
    EXPECT_NEAR(red[15], red[14], 2e-3f * red[14]) << "block " << block;
  }
}

TEST_P(NearFieldPixels, BackgroundAndEmptyScenesAreLeftAsTheyAre) {
  scene::Scene wall;
  addMaterial(wall, glm::vec3(0.5f));
  addBox(wall, 0, {-9, -9, 5}, {9, 9, 6});  // behind the eye
  const std::vector<uint8_t> mask(size_t(kSize.x) * kSize.y, 255);
  const std::vector<uint64_t> before(mask.size(), glm::packHalf4x16({1, 2, 3, 0}));
  for (const scene::Scene& scene : {wall, scene::Scene{}}) {
    RayPassTest test("near-field-pixels");
    wire(test, scene, mask, before);
    test.run();
    EXPECT_EQ(test.values<uint64_t>("near_field"), before);
  }
}

TEST_P(NearFieldPixels, SizeIsTheViews) {
  RayPassTest test("near-field-pixels");
  wire(test, emissiveRoom().scene, std::vector<uint8_t>(size_t(kSize.x) * kSize.y),
       std::vector<uint64_t>(size_t(kSize.x) * kSize.y));
  test.viewSize(8, 8);
  try {
    test.run();
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_NE(std::string(e.what()).find("(near_field.width is 24, view.width is 8, near_field.height is 16"),
              std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace fovea::test
