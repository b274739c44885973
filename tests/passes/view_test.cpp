// Tests what the debug views show, pixel by pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "fovea/error.h"
#include "fovea/test.h"
#include "framework/scene/frame.h"
#include "framework/scene/scene.h"
#include "shaders/records/vpl.h"
#include "tests/references/paraboloid.h"
#include "tests/references/voxel_trace.h"
#include "tests/support/pixel_rays.h"
#include "tests/support/voxels.h"

namespace fovea::test {
namespace {

using glm::vec3;

constexpr uint32_t kSize = 48;

vec3 pixel(const PassTest& test, uint32_t x, uint32_t y, uint32_t width = kSize) {
  const std::vector<float> image = test.floats("image");
  const float* p = &image[4 * (y * width + x)];
  return {p[0], p[1], p[2]};
}

// ---- view-voxels ------------------------------------------------------------------------------------------

struct VoxelView {
  scene::Scene scene = scene::builtin("cornellbox");
  VoxelArrays voxels = voxelizeReference(scene, scene::flatten(scene), 32);
};

// The side that the CPU's ray hits, at every pixel of a coarse raster; `color` gives its expected colour.
template <class Color>
void expectView(const VoxelView& v, const PassTest& test, vec3 background, Color color) {
  const scene::View view = *test.lastFrame().findView("main");
  const scene::Voxels voxels{v.voxels.grid, v.voxels.index, v.voxels.surface};
  uint32_t hits = 0, wrong = 0, pixels = 0;
  for (uint32_t y = 1; y < kSize; y += 3)
    for (uint32_t x = 1; x < kSize; x += 3, ++pixels) {
      const vec3 direction = glm::normalize(view.rayDirection(glm::vec2(x, y) + 0.5f));
      const scene::VoxelHit hit = scene::traceVoxels(voxels, view.eye, direction, direction);
      hits += hit.side != scene::kNoSide;
      const vec3 want = hit.side != scene::kNoSide ? color(hit.side) : background;
      wrong += glm::length(pixel(test, x, y) - want) > 0.01f * (1 + glm::length(want));
    }
  EXPECT_GT(hits, pixels / 2);
  EXPECT_LE(wrong, pixels / 32);  // rays along the wall between two cells
}

struct VoxelTest : PassTest {
  VoxelTest(const VoxelView& v, const char* show) : PassTest("view-voxels") {
    scene(v.scene).viewSize(kSize, kSize).param("show", show);
    setVoxels(*this, v.voxels);
  }
};

TEST(ViewVoxels, Albedo) {
  const VoxelView v;
  VoxelTest test(v, "albedo");
  test.run();
  const float exposure = test.lastFrame().exposure;
  expectView(v, test, vec3(0), [&](uint32_t side) { return v.voxels.surface[side].reflectance / exposure; });
}

TEST(ViewVoxels, Normal) {
  const VoxelView v;
  VoxelTest test(v, "normal");
  test.run();
  const float exposure = test.lastFrame().exposure;
  expectView(v, test, vec3(0), [&](uint32_t side) {
    return glm::pow(0.5f + 0.5f * v.voxels.surface[side].normal, vec3(2.2f)) / exposure;
  });
}

TEST(ViewVoxels, RadianceAndWeights) {
  VoxelView v;
  v.scene.environment = vec3(0.1f, 0.2f, 0.3f);
  std::vector<glm::vec4> radiance;
  std::vector<float> weights;
  for (size_t i = 0; i < v.voxels.surface.size(); ++i) {
    radiance.emplace_back(float(i % 7), float(i % 11), float(i % 13), 1);
    weights.push_back(i % 2 ? 1.0f : 0.0f);
  }
  VoxelTest lit(v, "radiance");
  lit.buffer("radiance", radiance, "VoxelRadiance").run();
  expectView(v, lit, v.scene.environment, [&](uint32_t side) { return vec3(radiance[side]); });

  VoxelTest weighed(v, "weight");
  weighed.buffer("weights", weights, "VoxelWeight").run();
  const float exposure = weighed.lastFrame().exposure;
  const vec3 first(0.267f, 0.005f, 0.329f), last(0.993f, 0.906f, 0.144f);
  expectView(v, weighed, vec3(0), [&](uint32_t side) {
    return glm::pow(weights[side] > 0 ? last : first, vec3(2.2f)) / exposure;
  });
}

TEST(ViewVoxels, NoVoxelsAndMissingInputs) {
  PassTest test("view-voxels");
  VoxelArrays none;
  none.resolution = 8;
  none.index.resize(512);
  setVoxels(test, none);
  test.viewSize(kSize, kSize).run();
  EXPECT_EQ(pixel(test, 20, 20), vec3(0));
  PassTest missing("view-voxels");
  setVoxels(missing, none);
  missing.param("show", "radiance");
  EXPECT_THROW(missing.run(), Error);
}

// ---- view-vpls --------------------------------------------------------------------------------------------

// The camera at (0, 0, 5) looks along -z.
scene::VplState vplAt(vec3 position, float importance, float life) {
  scene::VplState s;
  s.position = position;
  s.importance = importance;
  s.normal = {0, 0, 1};
  s.life = life;
  return s;
}

TEST(ViewVpls, DiscsCoverThePictureNearestFirst) {
  const std::vector<scene::VplState> states{vplAt({0, 0, -1}, 0, 1), vplAt({0, 0, 0}, 1, 1),
                                            vplAt({0, 0, -2}, 0, 1), scene::VplState{}};
  std::vector<float> picture;
  for (uint32_t i = 0; i < kSize * kSize; ++i) picture.insert(picture.end(), {0.25f, 0.5f, 0.75f, 1});
  PassTest test("view-vpls");
  test.viewSize(kSize, kSize).param("radius", 4.0).buffer("state", states, "VplState");
  test.image("picture", VK_FORMAT_R32G32B32A32_SFLOAT, kSize, kSize, 1, picture).run();
  const vec3 last = glm::pow(vec3(0.993f, 0.906f, 0.144f), vec3(2.2f)) / test.lastFrame().exposure;
  uint32_t covered = 0;
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize; ++x) {
      const glm::vec2 d = glm::vec2(x, y) + 0.5f - 0.5f * float(kSize);
      const bool disc = glm::dot(d, d) <= 16.0f;
      covered += disc;
      ASSERT_LT(glm::length(pixel(test, x, y) - (disc ? last : vec3(0.25f, 0.5f, 0.75f))), 0.01f)
          << x << ' ' << y;
    }
  EXPECT_NEAR(covered, 3.14159 * 16, 5);
}

TEST(ViewVpls, SurfacesHideVpls) {
  // A wall at z = 0, seen by every pixel; one VPL on it, one behind it.
  const std::vector<scene::VplState> states{vplAt({-1, 0, 0}, 1, 30), vplAt({1, 0, -1}, 1, 60)};
  std::vector<glm::vec4> positions;
  scene::Camera camera;
  camera.position = {0, 0, 5};
  const scene::View view = scene::makeView(camera, glm::uvec2(kSize), scene::Geometry{});
  for (uint32_t y = 0; y < kSize; ++y)
    for (uint32_t x = 0; x < kSize; ++x) {
      const vec3 d = view.rayDirection(glm::vec2(x, y) + 0.5f), p = view.eye + d * (-5.0f / d.z);
      positions.emplace_back(p, 1);
    }
  PassTest test("view-vpls");
  test.viewSize(kSize, kSize).param("show", "age").buffer("state", states, "VplState");
  wireSurfaces(test, "gbuffer", scene::pixelRays(view), kSize, kSize, positions);
  test.run();
  auto at = [&](vec3 p) {
    const glm::vec4 clip = view.worldToClip * glm::vec4(p, 1);
    const glm::vec2 c = (0.5f * glm::vec2(clip) / clip.w + 0.5f) * float(kSize);
    return pixel(test, uint32_t(c.x), uint32_t(c.y));
  };
  const vec3 middle = glm::pow(vec3(0.127f, 0.567f, 0.551f), vec3(2.2f)) / test.lastFrame().exposure;
  EXPECT_LT(glm::length(at(states[0].position) - middle), 0.01f);  // 30 of 60 frames
  EXPECT_EQ(at(states[1].position), vec3(0));
}

TEST(ViewVpls, LuminanceNeedsVpls) {
  const std::vector<scene::VplState> states{vplAt({0, 0, 0}, 0, 1)};
  PassTest test("view-vpls");
  test.viewSize(kSize, kSize).param("show", "luminance").buffer("state", states, "VplState");
  EXPECT_THROW(test.run(), Error);
  scene::Vpl vpl;
  vpl.intensity = vec3(2);
  PassTest lit("view-vpls");
  lit.viewSize(kSize, kSize)
      .param("show", "luminance")
      .param("range", 4.0)
      .buffer("state", states, "VplState");
  lit.buffer("vpls", std::vector<scene::Vpl>{vpl}, "Vpl").run();
  const vec3 middle = glm::pow(vec3(0.127f, 0.567f, 0.551f), vec3(2.2f)) / lit.lastFrame().exposure;
  EXPECT_LT(glm::length(pixel(lit, kSize / 2, kSize / 2) - middle), 0.01f);
}

// ---- view-atlas -------------------------------------------------------------------------------------------

TEST(ViewAtlas, MapsLieSideBySide) {
  // Three maps of 8 x 8 texels, two in a row, with distances 1, 2 and none.
  std::vector<uint32_t> texels;
  for (const float distance : {1.0f, 2.0f, INFINITY})
    for (int i = 0; i < 64; ++i) {
      uint32_t bits;
      std::memcpy(&bits, &distance, 4);
      texels.push_back(bits);
    }
  PassTest test("view-atlas");
  test.param("columns", 2).param("tile", 16).param("range", 1.0);
  test.image("atlas", VK_FORMAT_R32_UINT, 8, 8, 3, texels).run();
  EXPECT_EQ(test.desc("image").width, 32u);
  EXPECT_EQ(test.desc("image").height, 32u);
  const float exposure = test.lastFrame().exposure;
  auto grey = [&](float g) { return vec3(std::pow(g, 2.2f) / exposure); };
  EXPECT_LT(glm::length(pixel(test, 8, 8, 32) - grey(0.5f)), 2e-3f);
  EXPECT_LT(glm::length(pixel(test, 24, 8, 32) - grey(0.25f)), 2e-3f);
  EXPECT_LT(glm::length(pixel(test, 8, 24, 32) - glm::pow(vec3(0.05f, 0.05f, 0.3f), vec3(2.2f)) / exposure),
            2e-3f);
  EXPECT_EQ(pixel(test, 24, 24, 32), vec3(0));  // no fourth map
  EXPECT_EQ(pixel(test, 0, 0, 32), vec3(0));    // corners of a map are unused
}

}  // namespace
}  // namespace fovea::test
