// Tests light paths: energy against closed forms, distribution, determinism, and scenes that no light reaches.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "fovea/test.h"
#include "framework/scene/scene.h"
#include "shaders/records/vpl.h"
#include "tests/passes/emitted_vpls.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

// ---- Energy -----------------------------------------------------------------------------------------------

// In a closed room of one reflectance every path deposits the same energy, without any statistical error.
TEST(Emit, FirstBounceInAClosedRoomCarriesPowerTimesReflectance) {
  scene::Scene s = room({0.2f, 0.5f, 0.8f});
  s.lights = {pointLight({0.3f, -0.4f, 0.5f}, {10, 20, 30})};
  PassTest test("emit");
  test.param("count", 1000).param("bounces", 1);
  const auto vpls = emitted(test, s);
  EXPECT_EQ(filled(vpls), 1000);
  expectFlux(vpls, 4 * kPi * glm::dvec3(10 * 0.2, 20 * 0.5, 30 * 0.8), 1e-4);
  EXPECT_EQ(test.counter("vpls"), 1000);
  EXPECT_EQ(test.counter("escaped"), 0);
  EXPECT_EQ(test.counter("paths"), 1000);
}

// From the centre of a cube each wall gets a sixth of the light.
TEST(Emit, WallsOfDifferentColourReflectTheirMean) {
  scene::Scene s;
  uint32_t materials[6];
  glm::dvec3 mean(0);
  for (int i = 0; i < 6; ++i) {
    const glm::vec3 rho(0.1f + 0.15f * float(i), 0.9f - 0.1f * float(i), 0.4f);
    materials[i] = addMaterial(s, rho);
    mean += glm::dvec3(rho) / 6.0;
  }
  addRoom(s, materials, 3);
  s.lights = {pointLight(glm::vec3(0), glm::vec3(5))};
  PassTest test("emit");
  test.param("count", 1024).param("bounces", 1);
  expectFlux(emitted(test, s), 4 * kPi * 5 * mean, 0.01);
}

// Furnace: with k bounces the flux is P (rho + rho^2 + ... + rho^k). In a grey room the termination by reflectivity
// makes all VPLs equal (Keller); only the number of VPLs of each bounce varies.
TEST(Emit, BouncesInAFurnaceFormAGeometricSeries) {
  for (const int bounces : {1, 2, 3, 8}) {
    const float rho = 0.6f;
    scene::Scene s = room(glm::vec3(rho));
    s.lights = {pointLight({0.5f, 0, 0}, glm::vec3(1))};
    PassTest test("emit");
    test.param("count", 4096).param("bounces", bounces);
    const auto vpls = emitted(test, s);
    double series = 0;
    for (int k = 1; k <= bounces; ++k) series += std::pow(rho, k);
    expectFlux(vpls, glm::dvec3(4 * kPi * series), 0.02);
    int odd = 0;  // VPLs made by a split to fill the last slots
    for (const Vpl& v : vpls) odd += std::abs(v.intensity.r / vpls[0].intensity.r - 1) > 1e-3f;
    EXPECT_LE(odd, 2 * bounces);
    EXPECT_EQ(filled(vpls), 4096);
  }
}

// Coloured walls: the flux of each bounce is the product of the channel's reflectances, though survival depends on
// the brightest channel.
TEST(Emit, SurvivalByTheBrightestChannelKeepsAllChannelsRight) {
  const glm::dvec3 rho(0.8, 0.4, 0.1);
  scene::Scene s = room(glm::vec3(rho));
  s.lights = {pointLight({0.5f, 0, 0}, glm::vec3(1))};
  PassTest test("emit");
  test.param("count", 4096).param("bounces", 3);
  expectFlux(emitted(test, s), 4 * kPi * (rho + rho * rho + rho * rho * rho), 0.02);
}

// Black as diffuse surfaces; with full materials they reflect their colour.
TEST(Emit, MetalsReflectTheirColourIfMaterialsAreFull) {
  scene::Scene s = room({0.9f, 0.6f, 0.3f});
  for (scene::Material& m : s.materials) m.metallic = 1;
  s.lights = {pointLight({0.5f, 0, 0}, glm::vec3(1))};
  PassTest black("emit"), gold("emit");
  EXPECT_EQ(filled(emitted(black.param("count", 256).param("bounces", 1), s)), 0);
  gold.param("count", 256).param("bounces", 1).view("materials", "full");
  expectFlux(emitted(gold, s), 4 * kPi * glm::dvec3(0.9, 0.6, 0.3), 1e-4);
}

// The rule that stops when the list is full is unbiased: the mean over many short lists is that of single
// paths. Dividing by the number of paths traced, the unfinished one included, would be off by more than ten
// standard errors here.
TEST(Emit, StoppingWhenTheListIsFullIsUnbiased) {
  const double rho = 0.5;
  scene::Scene s = room(glm::vec3(float(rho)));
  s.lights = {pointLight({0.5f, 0, 0}, glm::vec3(1))};
  for (const int count : {3, 5}) {
    constexpr int kFrames = 1500;
    PassTest test("emit");
    test.param("count", count).viewSize(8, 8).scene(s);
    double sum = 0, squares = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
      test.run();
      const auto vpls = test.values<Vpl>("vpls");
      EXPECT_EQ(filled(vpls), count);
      const double flux = totalFlux(vpls).x / (4 * kPi);
      sum += flux;
      squares += flux * flux;
    }
    const double mean = sum / kFrames, error = std::sqrt((squares / kFrames - mean * mean) / kFrames);
    EXPECT_NEAR(mean, rho + rho * rho, 4 * error);
    EXPECT_LT(error, 0.009);
  }
}

// A beam over a floor with a shelf above it: the floor lacks what the shelf catches.
TEST(Emit, SunDeliversItsIrradianceToWhatItHits) {
  const glm::vec3 direction = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
  scene::Scene s;
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 0, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
  addQuad(s, 0, {-1, 2, 1}, {2, 0, 0}, {0, 0, -2});
  s.lights = {sun(direction, glm::vec3(3))};
  PassTest test("emit");
  test.param("count", 4096).param("bounces", 1);
  const auto vpls = emitted(test, s);
  const double cosine = -direction.y;
  expectFlux(vpls, glm::dvec3(3 * cosine * 100 * 0.5), 0.02);
  double onShelf = 0;
  for (const Vpl& v : vpls) onShelf += v.position.y > 1 ? kPi * v.intensity.x : 0;
  EXPECT_NEAR(onShelf, 3 * cosine * 4 * 0.5, 0.1 * 3 * cosine * 4 * 0.5);
  EXPECT_GT(test.counter("escaped"), 0);  // the beam is as wide as the box, not as the floor
  // The beam's cross-section is that of the bounding box.
  const double beam = 100 * cosine + 20 * (std::abs(direction.x) + std::abs(direction.z));
  EXPECT_NEAR(4096 / test.counter("paths"), 100 * cosine / beam, 0.02);
}

TEST(Emit, SpotSendsItsPowerByItsFalloff) {
  const float inner = 0.3f, outer = 0.6f;
  scene::Scene s;
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 0, {-9, 0, 9}, {18, 0, 0}, {0, 0, -18});
  s.lights = {spotLight({0, 4, 0}, {0, -1, 0}, inner, outer, glm::vec3(7))};
  PassTest test("emit");
  test.param("count", 4096).param("bounces", 1);
  const auto vpls = emitted(test, s);
  const double ci = std::cos(double(inner)), co = std::cos(double(outer));
  const double solid = 2 * kPi * ((1 - ci) + (ci - co) / 3);
  expectFlux(vpls, glm::dvec3(7 * solid * 0.5), 1e-3);
  // Share of the flux within an angle a in the soft edge, from the integral of the falloff.
  for (const double a : {0.15, 0.3, 0.4, 0.5, 0.6}) {
    const double c = std::cos(a), t = a <= inner ? 1 : (c - co) / (ci - co);
    const double expected = a <= inner ? (1 - c) : (1 - ci) + (ci - co) / 3 * (1 - t * t * t);
    int inside = 0;
    for (const Vpl& v : vpls)
      inside += std::atan2(std::hypot(double(v.position.x), double(v.position.z)), 4.0) <= a + 1e-5;
    EXPECT_NEAR(inside / 4096.0, 2 * kPi * expected / solid, 0.01) << "angle " << a;
  }
}

TEST(Emit, EmissiveTrianglesAreVplsAndSendOutPaths) {
  const glm::dvec3 radiance(2, 1, 0.5);
  scene::Scene s = room(glm::vec3(0.5f));
  addMaterial(s, glm::vec3(0));
  s.materials.back().emission = glm::vec3(radiance);
  addQuad(s, 1, {-0.5f, 1.9f, -0.5f}, {1, 0, 0}, {0, 0, 1});  // shines down
  const glm::dvec3 power = kPi * radiance * 1.0;
  for (const bool doubleSided : {false, true}) {
    s.materials[1].doubleSided = doubleSided;
    PassTest test("emit");
    test.param("count", 2048).param("bounces", 1);
    const auto vpls = emitted(test, s);
    const double sides = doubleSided ? 2 : 1;
    // The back of the lamp may catch light again but reflects none, so only the downward light is completely reflected.
    glm::dvec3 onLamp(0), onWalls(0);
    for (const Vpl& v : vpls)
      (std::abs(v.position.y - 1.9f) < 1e-3f ? onLamp : onWalls) += kPi * glm::dvec3(v.intensity);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(onLamp[c], sides * power[c], 1e-3 * power[c]);
      EXPECT_NEAR(onWalls[c], sides * 0.5 * power[c], 0.02 * power[c]);
    }
  }
  PassTest off("emit");
  off.param("emissive", false);
  EXPECT_EQ(filled(emitted(off, s)), 0);
}

TEST(Emit, LightsAreChosenByPower) {
  scene::Scene s = room(glm::vec3(0.5f));
  s.lights = {pointLight({1, 0, 0}, {9, 0, 0}), pointLight({-1, 0, 0}, {0, 3, 0}),
              pointLight({0, 1, 0}, glm::vec3(0))};
  PassTest test("emit");
  test.param("count", 1000).param("bounces", 1);
  const auto vpls = emitted(test, s);
  int red = 0;
  for (const Vpl& v : vpls) red += v.intensity.r > 0;
  EXPECT_NEAR(red, 750, 3);
  expectFlux(vpls, 4 * kPi * 0.5 * glm::dvec3(9, 3, 0), 5e-3);
}

// ---- Distribution and order -------------------------------------------------------------------------------

// Share of a point light's rays through a centred square of half side a at height h: its solid angle divided by 4 pi.
TEST(Emit, PointLightIsUniformOverTheSphere) {
  scene::Scene s = room(glm::vec3(0.5f), 2);
  s.lights = {pointLight(glm::vec3(0), glm::vec3(1))};
  PassTest test("emit");
  test.param("count", 4096).param("bounces", 1);
  const auto vpls = emitted(test, s);
  for (const double a : {0.5, 1.0, 1.5, 2.0}) {
    const double share = 4 * std::asin(a * a / (a * a + 4)) / (4 * kPi);
    int inside = 0;
    for (const Vpl& v : vpls)
      inside += v.position.y < -1.999f && std::abs(v.position.x) <= a && std::abs(v.position.z) <= a;
    EXPECT_NEAR(inside / 4096.0, share, 0.005) << "half side " << a;
  }
}

// Uniformly lit floor: 1000 VPLs on 100 m^2 stand for 0.1 m^2 each. Along the rim, where the disc of the neighbours
// extends over the edge, the estimate is up to twice as large; here this is a fifth of the floor.
TEST(Emit, AreasAddUpToTheLitSurface) {
  scene::Scene s;
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 0, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
  s.lights = {sun({0, -1, 0}, glm::vec3(1))};
  PassTest test("emit");
  test.param("count", 1000).param("bounces", 1);
  const auto vpls = emitted(test, s);
  double sum = 0;
  for (const Vpl& v : vpls) {
    sum += v.area;
    EXPECT_GT(v.area, 0.02f);
    EXPECT_LT(v.area, 0.5f);
  }
  EXPECT_GT(sum, 95);
  EXPECT_LT(sum, 125);
  // The mean of four frames has four times as many VPLs.
  PassTest sharing("emit");
  sharing.param("count", 1000).param("bounces", 1).param("averaged_frames", 4);
  const auto shared = emitted(sharing, s);
  for (size_t i = 0; i < vpls.size(); ++i) {
    ASSERT_EQ(shared[i].position, vpls[i].position);
    ASSERT_FLOAT_EQ(shared[i].area, vpls[i].area / 4);
  }
}

// Each interleave subset must be a sample of the whole scene: its flux and its centre are those of all.
TEST(Emit, EverySubsetSamplesTheWholeScene) {
  scene::Scene s = room(glm::vec3(0.5f));
  s.lights = {pointLight({0.7f, 0.2f, -0.4f}, glm::vec3(1))};
  PassTest test("emit");
  test.param("count", 1024);
  const auto vpls = emitted(test, s);
  glm::dvec3 mean(0);
  for (const Vpl& v : vpls) mean += glm::dvec3(v.position) / 1024.0;
  for (uint32_t subset = 0; subset < 16; ++subset) {
    glm::dvec3 centre(0);
    for (uint32_t i = subset; i < 1024; i += 16) centre += glm::dvec3(vpls[i].position) / 64.0;
    EXPECT_LT(glm::length(centre - mean), 0.2)
        << "subset " << subset;  // random subsets: 0.25 each axis, one sigma 0.24
  }
}

TEST(Emit, NormalsPointToWhereTheLightCameFrom) {
  scene::Scene s;
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 0, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});  // front: up
  for (const float y : {3.0f, -3.0f}) {
    s.lights = {pointLight({0, y, 0}, glm::vec3(1))};
    PassTest test("emit");
    test.param("count", 100);
    for (const Vpl& v : emitted(test, s)) {
      EXPECT_EQ(v.normal, glm::vec3(0, y > 0 ? 1 : -1, 0));
      EXPECT_NEAR(v.position.y, 0, 1e-5f);
    }
  }
}

TEST(Emit, LightPassesThroughMaskedHoles) {
  scene::Scene s;
  addMaterial(s, glm::vec3(0.5f));
  scene::Material masked;
  masked.masked = true;
  masked.baseColor = {0.5f, 0.5f, 0.5f, 1};
  masked.baseColorTexture.texture = 0;
  masked.baseColorTexture.wrapU = scene::Wrap::Clamp;
  s.materials.push_back(masked);
  scene::Texture t;
  t.width = 2;
  t.height = 1;
  t.rgba = {255, 255, 255, 255, 255, 255, 255, 0};  // left half solid, right half a hole
  s.textures.push_back(t);
  addQuad(s, 0, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
  addQuad(s, 1, {-5, 1, 5}, {10, 0, 0}, {0, 0, -10});
  s.lights = {sun({0, -1, 0}, glm::vec3(1))};
  PassTest test("emit");
  test.param("count", 1000).param("bounces", 1);
  int below = 0;
  for (const Vpl& v : emitted(test, s)) {
    const bool hole = v.position.x > 0.01f, solid = v.position.x < -0.01f;
    if (hole) {
      EXPECT_NEAR(v.position.y, 0, 1e-4f);
    }
    if (solid) {
      EXPECT_NEAR(v.position.y, 1, 1e-4f);
    }
    below += v.position.y < 0.5f;
  }
  EXPECT_NEAR(below, 500, 10);
}

// ---- Determinism and special cases ------------------------------------------------------------------------

TEST(Emit, RepeatsForSeedAndFrame) {
  scene::Scene s = room(glm::vec3(0.5f));
  s.lights = {pointLight({0.5f, 0, 0}, glm::vec3(1))};
  const auto bytes = [&](uint32_t seed, bool perFrame, uint32_t frames) {
    PassTest test("emit");
    test.param("per_frame", perFrame).seed(seed).viewSize(8, 8).scene(s);
    test.run(frames);
    return test.bytes("vpls");
  };
  const auto first = bytes(1, true, 1);
  EXPECT_EQ(first, bytes(1, true, 1));
  EXPECT_NE(first, bytes(2, true, 1));
  EXPECT_NE(first, bytes(1, true, 2));
  EXPECT_EQ(first, bytes(1, false, 2));
}

void expectEmpty(const scene::Scene& s, const char* what) {
  PassTest test("emit");
  test.param("count", 100);
  for (const Vpl& v : emitted(test, s)) {
    EXPECT_EQ(v.intensity, glm::vec3(0)) << what;
    EXPECT_EQ(v.position, glm::vec3(0)) << what;
  }
  EXPECT_EQ(test.counter("vpls"), 0) << what;
}

TEST(Emit, NothingToLightLeavesAllSlotsEmpty) {
  scene::Scene dark = room(glm::vec3(0.5f));
  expectEmpty(dark, "no light");
  dark.lights = {pointLight(glm::vec3(0), glm::vec3(0))};
  expectEmpty(dark, "a light that is off");
  scene::Scene black = room(glm::vec3(0));
  black.lights = {pointLight(glm::vec3(0), glm::vec3(1))};
  expectEmpty(black, "nothing reflects");
  scene::Scene away = room(glm::vec3(0.5f));
  away.lights = {spotLight({0, 9, 0}, {0, 1, 0}, 0.1f, 0.2f, glm::vec3(1))};
  expectEmpty(away, "a light that shines away from everything");
  scene::Scene near = room(glm::vec3(0.5f), 4);
  near.lights = {pointLight(glm::vec3(0), glm::vec3(1))};
  near.lights[0].range = 3;
  expectEmpty(near, "a light whose range ends before the walls");
  scene::Scene none;
  none.lights = {pointLight(glm::vec3(0), glm::vec3(1)), sun({0, -1, 0}, glm::vec3(1))};
  none.materials.emplace_back();
  expectEmpty(none, "no surface");
}

TEST(Emit, NoBouncesNoVpls) {
  scene::Scene s = room(glm::vec3(0.5f));
  s.lights = {pointLight({0.5f, 0, 0}, glm::vec3(1))};
  PassTest test("emit");
  test.param("count", 100).param("bounces", 0);
  EXPECT_EQ(filled(emitted(test, s)), 0);
}

TEST(Emit, OneSlotHoldsAllTheLight) {
  scene::Scene s = room(glm::vec3(0.5f));
  s.lights = {pointLight({0.5f, 0, 0}, glm::vec3(1))};
  PassTest test("emit");
  test.param("count", 1);
  const auto vpls = emitted(test, s);
  ASSERT_EQ(vpls.size(), 1u);
  expectFlux(vpls, glm::dvec3(4 * kPi * 0.5), 1e-4);
}

}  // namespace
}  // namespace fovea::test
