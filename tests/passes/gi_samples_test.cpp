// Compares samples of indirect light with plain rays and closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/passes/reservoir_reference.h"
#include "tests/passes/where_rays_run.h"
#include "tests/references/blocks.h"
#include "tests/support/sky.h"

namespace fovea::test {
namespace {

class GiSamples : public WhereRaysRun {};
INSTANTIATE_TEST_SUITE_P(Rays, GiSamples, testing::Bool(), nameOfPlace);

constexpr glm::ivec2 kSize(29, 21);  // not whole blocks

struct Samples {
  std::vector<std::vector<Reservoir>> frames;
  double rays = 0, samples = 0;  // of the last frame
};

Samples samplesOf(const scene::Scene& scene, glm::ivec2 size, int depth, int spacing = 1, uint32_t frames = 1,
                  int paths = 1) {
  Samples result;
  RayPassTest test("gi-samples");
  test.viewSize(uint32_t(size.x), uint32_t(size.y)).scene(scene);
  test.param("depth", depth).param("spacing", spacing).param("paths", paths);
  for (uint32_t frame = 0; frame < frames; ++frame) {
    test.run();
    result.frames.push_back(test.values<Reservoir>("reservoirs"));
    result.rays = test.counter("rays");
    result.samples = test.counter("samples");
  }
  return result;
}

// Mean over pixels and frames of the red light that the samples stand for, as a part of what is expected there.
template <class Expected>
double ratio(const Room& room, const Samples& samples, const Expected& expected) {
  double sum = 0, wanted = 0;
  const GBuffer seen = gbufferOf(room);
  for (const auto& frame : samples.frames)
    for (size_t i = 0; i < frame.size(); ++i) {
      if (!room.pixels[i].there) continue;
      const Reservoir& r = frame[i];
      if (r.weight > 0) sum += r.radiance.r * r.weight * cosineAt(seen.pixels[i], r) / glm::pi<double>();
      wanted += expected(room.pixels[i]);
    }
  return sum / wanted;
}

scene::Scene roomWithLamp(glm::vec3 lamp, glm::vec3 candela) {
  scene::Scene s;
  uint32_t walls[6];
  for (uint32_t i = 0; i < 6; ++i)
    walls[i] = addMaterial(s, {0.1f + 0.1f * float(i), 0.5f, 0.9f - 0.1f * float(i)});
  addRoom(s, walls, 2);
  // No ray through the middle of a pixel of kSize meets its edges, at which rounding decides what is seen.
  addBox(s, walls[1], {-1.1f, -2, -1.6f}, {0.23f, -0.4f, -0.7f});
  s.lights = {pointLight(lamp, candela)};
  return s;
}

// Without emissive surfaces, a sample is where a cosine-weighted ray ends, with the direct light that leaves there.
TEST_P(GiSamples, EqualsARayAndDirectLight) {
  const glm::vec3 lamp(1.2f, 1.1f, -0.4f), candela(3, 5, 8);
  const scene::Scene s = roomWithLamp(lamp, candela);
  const Room room = lookInto(s, 8, kSize);
  const GBuffer seen = gbufferOf(room);
  const Samples samples = samplesOf(room.scene, kSize, 3);
  double cosines = 0;
  int lit = 0, dark = 0;
  for (size_t i = 0; i < room.pixels.size(); ++i) {
    SCOPED_TRACE(i);
    const Reservoir& r = samples.frames[0][i];
    EXPECT_EQ(r.count, 1);
    if (r.radiance == glm::vec3(0)) {
      EXPECT_EQ(r.weight, 0);
      ++dark;
      continue;
    }
    const glm::dvec3 x(room.pixels[i].position), n(room.pixels[i].normal), y(r.position);
    const double cosine = glm::dot(glm::normalize(y - x), n);
    cosines += cosine;
    ++lit;
    EXPECT_NEAR(r.weight * cosine / glm::pi<double>(), 1, 1e-3);
    const RayHit hit = castRay(room.scene, room.geometry, x + 1e-4 * n, glm::normalize(y - x));
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit.t, glm::distance(x, y), 2e-3);
    glm::dvec3 face = faceNormal(room.geometry, hit.triangle);
    if (glm::dot(face, x - y) < 0) face = -face;
    EXPECT_LT(glm::distance(face, glm::dvec3(r.normal)), 1e-5);
    const glm::dvec3 to = glm::dvec3(lamp) - y;
    const double d2 = glm::dot(to, to), cosineLamp = glm::dot(face, to) / std::sqrt(d2);
    const glm::dvec3 rho(room.scene.materials[room.geometry.triangles[hit.triangle].material()].baseColor);
    for (int c = 0; c < 3; ++c) {
      const double want = rho[c] * candela[c] * cosineLamp / d2 / glm::pi<double>();
      EXPECT_NEAR(r.radiance[c], want, 2e-3 * want + 1e-6);
    }
  }
  EXPECT_NEAR(cosines / lit, 2.0 / 3, 0.03);  // about five standard errors
  EXPECT_GT(lit, 400);
  EXPECT_GT(dark, 20);
  EXPECT_EQ(samples.samples, kSize.x * kSize.y);
}

// Walls that emit e and reflect half of what they get send e (1 + 1/2 + 1/4 ...), a term for each edge from the second on.
TEST_P(GiSamples, FurnaceOfWallsThatShine) {
  scene::Scene s;
  const uint32_t m = addMaterial(s, glm::vec3(0.5f)), walls[6] = {m, m, m, m, m, m};
  s.materials[m].emission = {2, 2, 2};
  addRoom(s, walls, 2);
  const Room room = lookInto(std::move(s), 8, {48, 48});
  const double series[] = {1.5, 1.75, 1.875};
  for (const int depth : {3, 4, 5}) {
    const Samples samples = samplesOf(room.scene, room.size, depth);
    EXPECT_NEAR(ratio(room, samples, [&](const Seen&) { return 2 * series[depth - 3]; }), 1, 0.02) << depth;
  }
}

// Of a small lamp near the wall, a cosine-weighted ray would make spots, and rays aimed at it alone would at its foot.
TEST_P(GiSamples, LampIsReachedInBothWays) {
  scene::Scene s;
  const uint32_t black = addMaterial(s, glm::vec3(0)), lamp = addMaterial(s, glm::vec3(0));
  const uint32_t walls[6] = {black, black, black, black, black, black};
  s.materials[lamp].emission = {40, 40, 40};
  addRoom(s, walls, 2);
  const glm::vec3 corner(-0.2f, -0.15f, -1.9f), u(0.4f, 0, 0), v(0, 0.3f, 0);
  addQuad(s, lamp, corner, v, u);  // shines at the wall behind it
  const Room room = lookInto(std::move(s), 8, {48, 48});
  const auto expected = [&](const Seen& seen) {  // irradiance / pi
    constexpr int kCells = 24;
    double sum = 0;
    for (int i = 0; i < kCells * kCells; ++i) {
      const glm::dvec3 to = glm::dvec3(corner + u * ((float(i % kCells) + 0.5f) / kCells) +
                                       v * ((float(i / kCells) + 0.5f) / kCells)) -
                            glm::dvec3(seen.position);
      const double d2 = glm::dot(to, to);
      const double cosines = std::max(0.0, glm::dot(to, glm::dvec3(seen.normal))) * std::max(0.0, to.z) / d2;
      sum += 40 * cosines / d2 * 0.4 * 0.3 / (kCells * kCells) / glm::pi<double>();
    }
    return sum;
  };
  const Samples samples = samplesOf(room.scene, room.size, 3, 1, 4);
  EXPECT_NEAR(ratio(room, samples, expected), 1, 0.02);
  EXPECT_NEAR(ratio(room, samplesOf(room.scene, room.size, 3, 1, 1, 4), expected), 1, 0.02);
  const GBuffer seen = gbufferOf(room);
  double most = 0;  // of the light of a sample, in lights that are expected
  for (const auto& frame : samples.frames)
    for (size_t i = 0; i < frame.size(); ++i)
      if (const double want = expected(room.pixels[i]); want > 0.1)
        most =
            std::max(most, frame[i].radiance.r * frame[i].weight * cosineAt(seen.pixels[i], frame[i]) / want);
  EXPECT_LT(most, 30);
}

// The sample chosen among four paths stands for the same light, with less variance.
TEST_P(GiSamples, OneOfSeveralPathsIsChosen) {
  const Room room = lookInto(roomWithLamp({1.2f, 1.1f, -0.4f}, {3, 5, 8}), 8, {48, 48});
  const GBuffer seen = gbufferOf(room);
  const auto light = [&](const Samples& samples) {  // mean and mean of the square
    glm::dvec2 sum(0);
    size_t pixels = 0;
    for (const auto& frame : samples.frames)
      for (size_t i = 0; i < frame.size(); ++i, ++pixels) {
        const double value = frame[i].weight > 0
                                 ? frame[i].radiance.r * frame[i].weight * cosineAt(seen.pixels[i], frame[i])
                                 : 0.0;
        sum += glm::dvec2(value, value * value);
        EXPECT_EQ(frame[i].count, 1);
      }
    return sum / double(pixels);
  };
  const glm::dvec2 one = light(samplesOf(room.scene, room.size, 4, 1, 8)),
                   four = light(samplesOf(room.scene, room.size, 4, 1, 8, 4));
  EXPECT_NEAR(four.x / one.x, 1, 0.02);
  EXPECT_LT(four.y - four.x * four.x, 0.6 * (one.y - one.x * one.x));
}

TEST_P(GiSamples, SkyIsADistantPoint) {
  scene::Scene s;
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 0, {-9, -1, -20}, {0, 0, 19.9f}, {18, 0, 0});  // a floor
  s.environmentMap = skyWithSun();
  const Room room = lookInto(std::move(s), 8, {48, 48});
  const double expected = irradianceFrom(*room.scene.environmentMap, {0, 1, 0}).r / glm::pi<double>();
  const Samples samples = samplesOf(room.scene, room.size, 4, 1, 4);
  EXPECT_NEAR(ratio(room, samples, [&](const Seen&) { return expected; }), 1, 0.03);
  // On the device the map is in half floats, and angles are approximate.
  const float tolerance = GetParam() ? 1e-2f : 6e-2f;
  int found = 0;
  for (size_t i = 0; i < room.pixels.size(); ++i) {
    const Reservoir& r = samples.frames[0][i];
    EXPECT_EQ(r.count, room.pixels[i].there) << i;
    if (!(r.weight > 0)) continue;
    ++found;
    const glm::vec3 direction = glm::normalize(r.position - room.pixels[i].position);
    EXPECT_LT(glm::distance(r.radiance, room.scene.environmentMap->radiance(direction)),
              tolerance * (1 + glm::length(r.radiance)))
        << i;
    EXPECT_LT(glm::distance(r.normal, -direction), 1e-5f) << i;
  }
  EXPECT_GT(found, 500);
}

TEST_P(GiSamples, BlocksTakeTurns) {
  const Room room = closedRoom(true, 8, kSize);
  const Samples samples = samplesOf(room.scene, kSize, 3, 2, 4);
  std::vector<int> turns(room.pixels.size());
  for (uint32_t turn = 0; turn < 4; ++turn)
    for (int i = 0; i < int(turns.size()); ++i) {
      const glm::uvec2 pixel(i % kSize.x, i / kSize.x), block = pixel / 2u;
      const bool due = pixel == 2u * block + passes::samplePixel(turn, 2, block);
      EXPECT_EQ(samples.frames[turn][size_t(i)].count, due) << i;
      turns[size_t(i)] += samples.frames[turn][size_t(i)].count > 0;
    }
  for (const int n : turns) EXPECT_EQ(n, 1);
}

// Inside a fovea of a quarter of the width every pixel gets a sample in every frame, outside one of four in turn.
TEST_P(GiSamples, OutsideOfTheFoveaBlocksTakeTurns) {
  const Room room = closedRoom(true, 8, kSize);
  const glm::vec2 gaze(0.6f, 0.35f);
  std::vector<int> turns(room.pixels.size());
  for (uint32_t n = 1; n <= 4; ++n) {
    RayPassTest test("gi-samples");
    test.viewSize(uint32_t(kSize.x), uint32_t(kSize.y)).scene(room.scene);
    test.param("depth", 3).param("outside_spacing", 2).view("fovea_radius", 0.25);
    test.beforeFrame([&](PassTest&, scene::Frame& frame) { frame.views[0].gaze = gaze; });
    test.run(n);
    const auto frame = test.values<Reservoir>("reservoirs");
    for (size_t i = 0; i < frame.size(); ++i) turns[i] += frame[i].count > 0;
  }
  int inside = 0;
  for (int i = 0; i < int(turns.size()); ++i) {
    const glm::vec2 pixel(float(i % kSize.x) + 0.5f, float(i / kSize.x) + 0.5f);
    const bool seen = glm::distance(pixel, gaze * glm::vec2(kSize)) <= 0.25f * float(kSize.x);
    EXPECT_EQ(turns[size_t(i)], seen ? 4 : 1) << i;
    inside += seen;
  }
  EXPECT_NEAR(inside, glm::pi<double>() * 7.25 * 7.25, 8);
}

TEST_P(GiSamples, EmptySceneHasNone) {
  RayPassTest test("gi-samples");
  test.viewSize(uint32_t(kSize.x), uint32_t(kSize.y));
  test.run();
  for (const Reservoir& r : test.values<Reservoir>("reservoirs")) {
    EXPECT_EQ(r.count, 0);
    EXPECT_EQ(r.weight, 0);
  }
}

}  // namespace
}  // namespace fovea::test
