// Compares the reflections of smooth surfaces with the radiance of closed rooms and with mirror images.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "fovea/error.h"
#include "framework/scene/environment/environment_map.h"
#include "shaders/records/mirror.h"
#include "tests/passes/deferred_reference.h"
#include "tests/passes/scene_of_everything.h"
#include "tests/passes/vpl_intensity_reference.h"
#include "tests/passes/where_rays_run.h"
#include "tests/references/blocks.h"

namespace fovea::test {
namespace {

class Reflections : public WhereRaysRun {};
INSTANTIATE_TEST_SUITE_P(Rays, Reflections, testing::Bool(), nameOfPlace);
class LongReflections : public Reflections {};
INSTANTIATE_TEST_SUITE_P(LongRays, LongReflections, testing::Bool(), nameOfPlace);

constexpr int kSide = 16, kTexels = kSide / 2;

// The texels of pass mirrors for what the camera sees.
std::vector<glm::uvec4> mirrorsOf(const std::vector<Seen>& pixels, float roughness) {
  std::vector<glm::uvec4> texels;
  for (uint32_t i = 0; i < kTexels * kTexels; ++i) {
    const glm::uvec2 block(i % kTexels, i / kTexels), inside = passes::samplePixel(0, 2, block);
    const glm::uvec2 p = 2u * block + inside;
    const Seen& seen = pixels[size_t(p.y) * kSide + p.x];
    const uint32_t normal = glm::packSnorm2x16(octEncode(seen.normal));
    const float distance = glm::length(seen.position);  // the eye is at the origin
    const glm::uvec4 texel(std::bit_cast<uint32_t>(distance), normal, normal,
                           passes::sampleCode(2, inside, true) | glm::packUnorm2x16(glm::vec2(0, roughness)));
    texels.push_back(seen.there ? texel : glm::uvec4(0));
  }
  return texels;
}

PassTest& wire(PassTest& test, const Room& room, const std::vector<glm::uvec4>& texels) {
  test.view("materials", "full");  // diffuse surfaces are no mirrors
  test.viewSize(uint32_t(room.size.x), uint32_t(room.size.y)).scene(room.scene);
  test.image("mirrors", VK_FORMAT_R32G32B32A32_UINT, uint32_t(room.size.x) / 2, uint32_t(room.size.y) / 2, 1,
             texels);
  return test;
}

std::vector<glm::vec4> samplesOf(const PassTest& test) {
  std::vector<glm::vec4> samples;
  for (const uint64_t texel : test.values<uint64_t>("samples")) samples.push_back(glm::unpackHalf4x16(texel));
  return samples;
}

// Walls that emit {1, 2, 4} and reflect half of what they get: with light of up to n reflections a wall sends
// (2 - 1 / 2^n) times its own emission. Under any lobe, the mean of it is the same.
TEST_P(LongReflections, TheLightOfAClosedRoomUnderAnyLobe) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0.5f)), walls[6] = {m, m, m, m, m, m};
  s.materials[m].emission = {1, 2, 4};
  addRoom(s, walls, 2);
  const Room room = lookInto(std::move(s), 8, glm::ivec2(kSide), 1.6f);
  for (const float roughness : {0.0f, 0.2f, 0.45f, 0.8f})
    for (const int bounces : {2, 3}) {
      RayPassTest test("reflections");
      test.param("bounces", bounces).param("first_samples", 1024);
      wire(test, room, mirrorsOf(room.pixels, roughness)).run();
      const auto samples = samplesOf(test);
      glm::dvec3 mean(0);
      for (const glm::vec4& sample : samples) mean += glm::dvec3(sample) / double(samples.size());
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean[c] / (1 << c), 2 - std::exp2(-bounces), 0.03)
            << roughness << ", bounces " << bounces;
      EXPECT_EQ(test.counter("mirrors"), kTexels * kTexels);
    }
}

// A camera that looks along -z at a mirror, in which a box and a wall behind it are seen.
Room mirroredBox() {
  scene::Scene s;
  const uint32_t grey = addMaterial(s, glm::vec3(0.5f));
  s.materials[grey].specular = 0;
  addBox(s, grey, {-9, -9, -6}, {9, 9, -5});
  addBox(s, grey, {-9, -9, 3}, {9, 9, 4});
  addBox(s, grey, {-1.6f, -1.1f, 1}, {0.9f, 1.3f, 2});
  s.lights.push_back(pointLight({1.5f, 2, -3}, {30, 20, 10}));
  return lookInto(std::move(s), 8, glm::ivec2(kSide));
}

TEST_P(Reflections, WhatStandsBeforeAMirror) {
  const Room room = mirroredBox();
  RayPassTest test("reflections");
  test.param("bounces", 1).param("first_samples", 256);
  wire(test, room, mirrorsOf(room.pixels, 0)).run();
  const auto samples = samplesOf(test);
  int onBox = 0, hidden = 0;
  for (uint32_t i = 0; i < samples.size(); ++i) {
    const glm::uvec2 block(i % kTexels, i / kTexels), p = 2u * block + passes::samplePixel(0, 2, block);
    const glm::dvec3 at(room.pixels[p.y * kSide + p.x].position);
    const glm::dvec3 direction = glm::normalize(at) * glm::dvec3(1, 1, -1);
    const RayHit hit = castRay(room.scene, room.geometry, at + glm::dvec3(0, 0, 1e-4), direction);
    ASSERT_TRUE(hit);
    const glm::dvec3 there = at + hit.t * direction, to = glm::dvec3(room.scene.lights[0].position) - there;
    RayOptions open;
    open.tMax = 1;
    const bool lit = !castRay(room.scene, room.geometry, there - 1e-4 * direction, to, open);
    onBox += there.z < 2.5;
    hidden += !lit;
    const double d = glm::length(to), cosine = lit ? -to.z / d : 0;
    for (int c = 0; c < 3; ++c) {
      const double want = 0.5 / glm::pi<double>() * double(room.scene.lights[0].color[c]) * cosine / (d * d);
      EXPECT_NEAR(samples[i][c], want, 0.02 * want + 2e-3) << i;
    }
  }
  EXPECT_GT(onBox, 2);
  EXPECT_GT(hidden, 0);
  EXPECT_LT(onBox + hidden, kTexels * kTexels);
}

// The code goes on with the sample, and where nothing reflects there is none.
TEST_P(Reflections, CodesOfTheSamples) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0.5f)), walls[6] = {m, m, m, m, m, m};
  s.materials[m].emission = glm::vec3(1);
  addRoom(s, walls, 2);
  Room room = lookInto(std::move(s), 8, glm::ivec2(kSide));
  for (int i = 0; i < kSide * kSide; ++i) room.pixels[size_t(i)].there = i % kSide < kSide / 2;
  const auto texels = mirrorsOf(room.pixels, 0.1f);
  RayPassTest test("reflections");
  wire(test, room, texels).run(2);
  const auto samples = samplesOf(test);
  for (size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].a, texels[i].x != 0 ? float(texels[i].w & 0xffffu) : passes::kNoMirror);
    EXPECT_EQ(samples[i].r > 0, texels[i].x != 0);
  }
  EXPECT_EQ(test.counter("mirrors"), kTexels * kTexels / 2);
}

// Single rays under a wide lobe are poor estimates, so neighbours whose lobes overlap share theirs; texels that have no
// neighbours cannot.
TEST_P(LongReflections, NeighboursShareTheirLight) {
  constexpr uint32_t kApart = passes::kSharing + 1;
  const Room room = mirroredBox();
  const auto variance = [&](bool alone) {
    auto texels = mirrorsOf(room.pixels, 0.45f);
    for (uint32_t i = 0; i < texels.size(); ++i)
      if (alone && (i % kApart != 0 || i / kTexels % kApart != 0)) texels[i].x = 0;
    RayPassTest many("reflections"), single("reflections");
    many.param("bounces", 1).param("first_samples", 1024);
    single.param("bounces", 1).param("first_samples", 1).seed(2);
    wire(many, room, texels).run();
    const auto want = samplesOf(many);
    wire(single, room, texels);
    double sum = 0;
    for (int frame = 0; frame < 10; ++frame) {
      single.run();
      const auto got = samplesOf(single);
      for (uint32_t y = 0; y < kTexels; y += kApart)
        for (uint32_t x = 0; x < kTexels; x += kApart)
          sum += std::pow(double(got[y * kTexels + x].r - want[y * kTexels + x].r), 2);
    }
    return sum;
  };
  EXPECT_LT(variance(false), 0.3 * variance(true));
}

// A wall under a white sky, before whose left half a black one stands so close that it shows hardly anything else.
// Where one ray hits that and its neighbour the sky, neither counts for the other.
TEST_P(LongReflections, TheSkyStaysOutOfGaps) {
  scene::Scene wall;
  addBox(wall, addMaterial(wall, glm::vec3(0)), {-9, -9, -6}, {9, 9, -5});
  wall.environmentMap =
      std::make_shared<scene::EnvironmentMap>(4, 2, std::vector<glm::vec3>(8, glm::vec3(1)));
  Room room = lookInto(wall, 8, glm::ivec2(kSide));
  addBox(room.scene, 0, {-9, -9, -4.9f}, {-0.1f, 9, -4.8f});
  const auto texels = mirrorsOf(room.pixels, 0.45f);
  const auto behind = [](uint32_t i) { return i % kTexels < kTexels / 2; };
  double want = 0;  // each texel alone, so that it shares nothing
  for (uint32_t i = 0; i < texels.size(); ++i) {
    if (!behind(i)) continue;
    std::vector<glm::uvec4> one(texels.size(), glm::uvec4(0));
    one[i] = texels[i];
    RayPassTest many("reflections");
    many.param("first_samples", 1024);
    wire(many, room, one).run();
    want += double(samplesOf(many)[i].r);
  }
  RayPassTest single("reflections");
  single.param("first_samples", 1);
  wire(single, room, texels);
  double light = 0;
  constexpr int kFrames = 40;
  for (int frame = 0; frame < kFrames; ++frame) {
    single.run();
    const auto got = samplesOf(single);
    for (uint32_t i = 0; i < got.size(); ++i) light += behind(i) ? double(got[i].r) / kFrames : 0;
  }
  EXPECT_GT(want, 0.1);
  EXPECT_LT(want, 2);
  EXPECT_NEAR(light / want, 1, 0.3);
}

TEST_P(Reflections, MirrorsOfAnotherViewAreRefused) {
  const Room room = closedRoom(false, 8, glm::ivec2(kSide));
  RayPassTest test("reflections");
  test.viewSize(kSide + 2, kSide).scene(room.scene).view("materials", "full");
  test.image("mirrors", VK_FORMAT_R32G32B32A32_UINT, kTexels, kTexels, 1,
             std::vector<glm::uvec4>(kTexels * kTexels, glm::uvec4(0)));
  EXPECT_THROW(test.run(), Error);
}

TEST_P(Reflections, DiffuseSurfacesAreRefused) {
  const Room room = closedRoom(false, 8, glm::ivec2(kSide));
  RayPassTest test("reflections");
  test.viewSize(kSide, kSide).scene(room.scene).view("materials", "diffuse");
  test.image("mirrors", VK_FORMAT_R32G32B32A32_UINT, kTexels, kTexels, 1,
             std::vector<glm::uvec4>(kTexels * kTexels, glm::uvec4(0)));
  try {
    test.run();
    FAIL() << "diffuse surfaces have mirrors";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("narrow lobe"), std::string::npos) << e.what();
  }
}

// Both take the same random numbers, so that they differ by rounding alone; where rays meet glass, that decides whether
// one passes, and so mirrors are sharp there, whose rays count for one texel alone. A cut of the camera in the third
// frame lets both forget.
TEST(LongReflectionsBoth, SeeTheSame) {
  for (const auto& [glass, roughness] :
       {std::pair(false, 0.25f), std::pair(false, 0.6f), std::pair(true, 0.02f)}) {
    SCOPED_TRACE(testing::Message() << glass << " " << roughness);
    scene::Scene everything = sceneOfEverything(glass);
    for (scene::Material& m : everything.materials)
      m.roughness = std::min(m.roughness, 0.3f);  // smoother than the rougher mirrors
    const Room room = lookInto(std::move(everything), 8, glm::ivec2(kSide));
    const auto mirrors = mirrorsOf(room.pixels, roughness);
    PassTest host("reflections"), device("reflections");
    host.raysOnHost(true);
    device.raysOnHost(false);
    for (PassTest* test : {&host, &device}) {
      test->param("first_samples", 4);
      test->beforeFrame([](PassTest&, scene::Frame& frame) { frame.cameraCut = frame.index == 2; });
      wire(*test, room, mirrors).run(4);
    }
    const auto a = samplesOf(host), b = samplesOf(device);
    int different = 0, lit = 0;
    glm::dvec4 sums[2] = {};
    for (size_t i = 0; i < a.size(); ++i) {
      sums[0] += a[i];
      sums[1] += b[i];
      different += !(glm::length(a[i] - b[i]) <= 0.01f * glm::length(glm::vec3(a[i])));
      lit += a[i].r > 0;
    }
    EXPECT_GT(lit, int(a.size()) / 2);
    EXPECT_LE(different, glass ? int(a.size()) / 4 : 1);
    EXPECT_NEAR(sums[1].g / sums[0].g, 1, glass ? 0.05 : 0.005);
    EXPECT_GT(host.counter("gathered"), 5);
    EXPECT_NEAR(device.counter("gathered"), host.counter("gathered"), 2);
    EXPECT_NEAR(device.counter("rays"), host.counter("rays"), 0.02 * host.counter("rays"));
  }
}

}  // namespace
}  // namespace fovea::test
