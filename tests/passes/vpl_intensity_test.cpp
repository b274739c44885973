#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "tests/passes/vpl_intensity_scene.h"

namespace fovea::test {
namespace {

TEST(Weights, PdfEqualsTheReference) {
  const Room room = closedRoom(true);
  for (const uint32_t region : {scene::kRegionFovea, scene::kRegionImage}) {
    WeightSettings settings;
    settings.region = region;
    settings.points = region == scene::kRegionFovea ? 1024 : 100;
    settings.gaze =
        region == scene::kRegionFovea ? glm::vec2(0.4f, 0.8f) : glm::vec2(0.5f);  // a clipped disc
    const auto candidates = candidatesOf(room, 400, settings);
    Inputs in = inputs(room, vplsOf(room, candidates));
    ASSERT_GT(in.vpls.size(), 300u);
    for (size_t i = 0; i < in.vpls.size(); i += 7) in.vpls[i] = {};
    for (size_t i = 0; i < in.radiosity.size(); ++i) in.radiosity[i] = {0.1f * i, 2, 0.5f, 1};
    const auto p = densities(room, in.vpls, screenPoints(room, settings));
    // Rounding may change the result of a visibility test or move a point to another pixel. A ray that loses one of
    // 64 shares to rounding changes an area by a percent or two.
    const double share = escaping(room, screenPoints(room, settings));
    EXPECT_LE(wrongAreas(weigh(in, "pdf", settings), in, pdfAreas(in.vpls, p, 4, share), 3e-4), 8);
  }
}

// The share that escapes belongs to the paths, as in a room of which only two walls are left.
TEST(Weights, PathsThatEscapeCount) {
  scene::Scene s;
  addMaterial(s, glm::vec3(0.5f));
  addQuad(s, 0, {-2, -2, -2}, {4, 0, 0}, {0, 4, 0});  // looked at
  addQuad(s, 0, {-2, -2, 2}, {4, 0, 0}, {0, 0, -4});  // the floor
  const Room room = lookInto(std::move(s), 32, glm::ivec2(64));
  WeightSettings settings;
  const auto candidates = candidatesOf(room, 3000, settings);
  const Inputs in = inputs(room, vplsOf(room, candidates));
  const auto points = screenPoints(room, settings);
  const double share = escaping(room, points);
  EXPECT_GT(share, 2);
  EXPECT_NEAR(share, double(candidates.size()) / double(in.vpls.size()), 0.1 * share);
  const auto want = pdfAreas(in.vpls, densities(room, in.vpls, points), 4, share);
  EXPECT_LE(wrongAreas(weigh(in, "pdf", settings), in, want, 3e-4), int(want.size() / 50));
}

TEST(Weights, PdfSpreadsOverTheSurfaceThatIsReached) {
  const Room room = closedRoom(false, 32);
  WeightSettings settings;
  settings.areaCap = 16;  // few VPLs in edges, between two walls, are hardly seen
  const Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 2000, settings)));
  const auto list = weigh(in, "pdf", settings);
  // The paths start on the wall that is looked at and hardly reach that wall itself, so the areas add up to 5/6
  // of 96 m^2.
  EXPECT_NEAR(sumOfAreas(list), 80, 8);
}

// Light that is the same everywhere in a closed room: irradiance B on every surface, pi L with L = B / pi.
TEST(Weights, FurnaceOfDensities) {
  const Room room = closedRoom(false, 32);
  WeightSettings settings;
  const Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 2000, settings)));
  const auto list = weigh(in, "pdf", settings);
  const scene::Fovea fovea = scene::makeFovea(settings.gaze, room.size, settings.foveaRadius);
  double mean = 0;
  for (uint32_t i = 0; i < 500; ++i) {  // other points than the densities'
    const glm::ivec2 p = scene::regionSample(scene::kRegionFovea, fovea, room.size, randomStream(8, 0, 0, i));
    mean += irradiance(list, room.pixels[size_t(p.y) * room.size.x + p.x]) / 500;
  }
  EXPECT_NEAR(mean, 1, 0.04);
}

// Here paths have to reach every surface; a surface without a VPL gives its area to VPLs elsewhere.
TEST(Weights, FurnaceOfAreas) {
  const Room room = closedRoom(false, 32, glm::ivec2(64), 2.2f);
  WeightSettings settings;
  settings.region = scene::kRegionImage;
  const Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 2000, settings)));
  const auto list = weigh(in, "area", settings);
  double mean = 0;
  for (uint32_t i = 0; i < 500; ++i) {
    const glm::ivec2 p = scene::regionSample(scene::kRegionImage, {}, room.size, randomStream(8, 0, 0, i));
    mean += irradiance(list, room.pixels[size_t(p.y) * room.size.x + p.x]) / 500;
  }
  EXPECT_NEAR(mean, 1, 0.05);
}

TEST(Weights, AreasEqualASearchOfAllVpls) {
  const Room room = closedRoom(true);
  for (const bool litOnly : {true, false}) {
    WeightSettings settings;
    settings.litOnly = litOnly;
    settings.region = scene::kRegionImage;
    Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 1500, settings)));
    for (size_t i = 0; i < in.vpls.size(); i += 5) in.vpls[i] = {};
    for (uint32_t i = 0; i < in.vpls.size(); ++i)  // off the lattice, where many are equally near
      if (in.vpls[i].life > 0)
        in.vpls[i].position += 0.1f * (glm::vec3(sobol(i, 0, 1), sobol(i, 1, 1), sobol(i, 2, 1)) - 0.5f);
    double lit = 0;
    for (size_t s = 0; s < in.radiance.size(); ++s) {
      if (room.voxels.surface[s].position.x > 0.3f) in.radiance[s] = glm::vec4(0);
      if (!litOnly || in.radiance[s].w > 0) lit += room.voxels.surface[s].area;
    }
    double doubtful = 0;
    const auto want = voronoiAreas(room, in.vpls, in.radiance, settings, &doubtful);
    const auto got = weigh(in, "area", settings);
    double off = 0;
    for (size_t i = 0; i < want.size(); ++i) off += std::abs(got[i].area - want[i]);
    EXPECT_LE(off, 2 * doubtful + 1e-4 * lit);
    EXPECT_LT(doubtful, 0.01 * lit);  // the test is not vacuous
    wrongAreas(got, in, want, 1);
    EXPECT_NEAR(sumOfAreas(got), lit, 1e-5 * lit);
  }
}

TEST(Weights, AConstantStaysWhatTheFirstFrameMadeIt) {
  const Room room = closedRoom(true);
  WeightSettings settings;
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 200, settings)));
  for (size_t i = 0; i < in.radiosity.size(); ++i) in.radiosity[i] = glm::vec4(float(i % 7));
  const auto points = screenPoints(room, settings);
  const auto areas = pdfAreas(in.vpls, densities(room, in.vpls, points), 4, escaping(room, points));
  double flux = 0, sum = 0;
  for (size_t i = 0; i < areas.size(); ++i) {
    flux += in.radiosity[i].w * areas[i];
    sum += in.radiosity[i].w;
  }
  const double total = double(in.vpls.size()) * flux / sum;

  PassTest test("vpl-intensity-constant");
  wire(test, in, "constant", settings);
  uint32_t frame = 0;
  test.beforeFrame([&](PassTest& t, scene::Frame&) {
    if (frame == 0)
      t.set("radiosity", std::vector<glm::vec4>(in.radiosity.size(), glm::vec4(0)));  // no flux: waits
    if (frame == 1) t.set("radiosity", in.radiosity);
    if (frame == 2) {  // others, and half of them: the total is divided among those
      for (size_t i = 0; i < in.vpls.size(); ++i) in.vpls[i] = i % 2 ? in.vpls[0] : scene::VplState{};
      t.set("vpls", in.vpls);
      t.set("placed", placed(in));
    }
    ++frame;
  });
  for (const uint32_t frames : {1u, 2u, 3u}) {
    test.run(1);
    const auto list = test.values<scene::Vpl>("emitters");
    double alive = 0;
    for (const scene::VplState& vpl : in.vpls) alive += vpl.life > 0;
    for (size_t i = 0; i < list.size(); ++i) {
      const double want = frames > 1 && in.vpls[i].life > 0 ? total / alive : 0;
      ASSERT_NEAR(list[i].area, want, 2e-3 * want) << frames << " " << i;
    }
  }
}

TEST(Weights, AVplOutOfSightHasTheLargestArea) {
  const Room room = closedRoom(true);
  WeightSettings settings;
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 100, settings)));
  in.vpls[3].position = {0, -1.9f, 1.9f};  // turned away from all that is looked at
  in.vpls[3].normal = {0, 0, 1};
  const auto list = weigh(in, "pdf", settings);
  float largest = 0;
  std::vector<float> areas;
  for (const scene::Vpl& v : list) areas.push_back(v.area);
  largest = *std::max_element(areas.begin(), areas.end());
  EXPECT_EQ(list[3].area, largest);
  std::sort(areas.begin(), areas.end());
  EXPECT_NEAR(largest, 4 * areas[areas.size() / 2], 0.15f * largest);
}

TEST(Weights, NothingToWeigh) {
  const Room room = closedRoom(false, 12, glm::ivec2(16));
  const scene::VplState empty;
  for (const char* strategy : {"constant", "pdf", "area", "importance-area"}) {
    SCOPED_TRACE(strategy);
    for (const size_t count : {1, 70}) {
      const auto list = weigh(inputs(room, std::vector<scene::VplState>(count, empty)), strategy);
      ASSERT_EQ(list.size(), count);
      for (const scene::Vpl& v : list) EXPECT_EQ(std::memcmp(&v, &empty, sizeof v), 0);
    }
  }
}

TEST(Weights, OneVplStandsForAll) {
  const Room room = closedRoom(false, 12, glm::ivec2(16));
  WeightSettings settings;
  const auto candidates = candidatesOf(room, 1, settings);
  const Inputs in = inputs(room, {vplAt(room, candidates[0].side)});
  double all = 0;
  for (const scene::VoxelSide& s : room.voxels.surface) all += s.area;
  EXPECT_NEAR(weigh(in, "area")[0].area, all, 1e-5 * all);
  const auto p = densities(room, in.vpls, screenPoints(room, settings));
  const double want = 1 / (p[0] * escaping(room, screenPoints(room, settings)));
  EXPECT_NEAR(weigh(in, "pdf", settings)[0].area, want, 1e-3 * want);
  EXPECT_NEAR(weigh(in, "constant", settings)[0].area, want, 1e-3 * want);
  EXPECT_NEAR(weigh(in, "importance-area", settings)[0].area, want, 0.01 * want);
}

TEST(Weights, NothingLit) {
  const Room room = closedRoom(false, 12, glm::ivec2(16));
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 50, {})));
  for (glm::vec4& r : in.radiance) r = glm::vec4(0);
  for (glm::vec4& r : in.radiosity) r = glm::vec4(0);
  for (const char* strategy : {"constant", "pdf", "area", "importance-area"})
    for (const scene::Vpl& v : weigh(in, strategy)) EXPECT_EQ(v.intensity, glm::vec3(0)) << strategy;
}

// When the eye looks elsewhere, the region is the whole image. With no surface on the screen, no path starts.
TEST(Weights, FoveaOutsideAndBackground) {
  Room room = closedRoom(true, 16, glm::ivec2(32));
  WeightSettings settings;
  settings.gaze = {3, -2};
  const Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 100, settings)));
  const auto p = densities(room, in.vpls, screenPoints(room, settings));
  EXPECT_LE(wrongAreas(weigh(in, "pdf", settings), in,
                       pdfAreas(in.vpls, p, 4, escaping(room, screenPoints(room, settings))), 3e-4),
            4);
  for (Seen& s : room.pixels) s.there = false;
  for (const char* strategy : {"constant", "pdf", "importance-area"})
    for (const scene::Vpl& v : weigh(in, strategy)) EXPECT_EQ(v.area, 0) << strategy;
}

TEST(Weights, NoVoxels) {
  scene::Scene s;
  s.materials.emplace_back();
  const Room room = lookInto(s, 8, glm::ivec2(8));
  ASSERT_EQ(room.voxels.info.voxels, 0u);
  scene::VplState vpl;
  vpl.life = 1;
  vpl.normal = {0, 1, 0};
  vpl.side = 7;  // of another scene
  for (const char* strategy : {"constant", "pdf", "area", "importance-area"})
    for (const scene::Vpl& v : weigh(inputs(room, {vpl, {}}), strategy)) EXPECT_EQ(v.area, 0) << strategy;
}

// Whatever the input, the output for the shading is a finite number.
TEST(Weights, OutputsAreFinite) {
  const Room room = closedRoom(true, 16, glm::ivec2(32));
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 60, {})));
  in.radiosity[0] = glm::vec4(nan);
  in.radiosity[1] = glm::vec4(1, inf, 1, inf);
  in.radiosity[2] = glm::vec4(3e38f);
  in.radiosity[3] = glm::vec4(-1);
  in.vpls[4].position.y = nan;
  in.vpls[5].normal.z = inf;
  in.vpls[6].normal = glm::vec3(0);
  in.vpls[7].position = glm::vec3(1e30f);
  in.vpls[8].side = 0xfffffffeu;
  in.vpls[9].position = room.pixels[room.pixels.size() / 2].position;  // on a point of the screen
  in.radiance[room.voxels.surface.size() / 2] = glm::vec4(nan);
  for (const char* strategy : {"constant", "pdf", "area", "importance-area"}) {
    SCOPED_TRACE(strategy);
    const auto list = weigh(in, strategy);
    for (size_t i = 0; i < list.size(); ++i) {
      const scene::Vpl& v = list[i];
      for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(std::isfinite(v.position[c]) && std::isfinite(v.normal[c]) &&
                    std::isfinite(v.intensity[c]))
            << i;
        EXPECT_GE(v.intensity[c], 0) << i;
        EXPECT_LE(v.intensity[c], 1e18f) << i;
      }
      EXPECT_TRUE(std::isfinite(v.area) && v.area >= 0) << i;
    }
    const scene::Vpl none;
    for (const int i : {0, 1, 4, 5}) EXPECT_EQ(std::memcmp(&list[i], &none, sizeof none), 0) << i;
    EXPECT_GT(list[20].area, 0);
  }
}

TEST(Weights, TheSameBitsEveryTime) {
  const Room room = closedRoom(true);
  const Inputs in = inputs(room, vplsOf(room, candidatesOf(room, 300, {})));
  for (const char* strategy : {"constant", "pdf", "area", "importance-area"}) {
    const auto a = weigh(in, strategy), b = weigh(in, strategy);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]), 0) << strategy;
  }
}

}  // namespace
}  // namespace fovea::test
