// The sample passes that consist of files only: outline, bilateral-blur and trail.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "fovea/error.h"
#include "fovea/test.h"
#include "places.h"
#include "tests/support/pixel_rays.h"
#include "tests/support/shapes.h"

namespace fovea::test {
namespace {

constexpr uint32_t kWidth = 12, kHeight = 5;

struct Surfaces {
  scene::PixelRays camera;
  std::vector<glm::vec4> position, normal;
};

// Two planes at right angles, which meet in the middle of the picture.
Surfaces corner() {
  Surfaces s;
  const float half = 0.5f * float(kWidth);
  s.camera = raysOnto({-3, 0, 3}, {-0.05f * (2 * half - 0.5f), 0, 0.025f}, {0.05f, 0, 0.05f}, {0, 0.1f, 0});
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x) {
      const glm::vec3 ray = pointOn(s.camera, int(x), int(y), 1) - s.camera.eye;
      const float toLeft = -s.camera.eye.z / ray.z, toRight = -s.camera.eye.x / ray.x;
      const bool left = toLeft < toRight;
      s.position.emplace_back(pointOn(s.camera, int(x), int(y), std::min(toLeft, toRight)), 1);
      s.normal.push_back(left ? glm::vec4(0, 0, 1, 0) : glm::vec4(1, 0, 0, 0));
    }
  return s;
}

std::vector<glm::vec4> stripes() {
  std::vector<glm::vec4> picture;
  for (uint32_t i = 0; i < kWidth * kHeight; ++i)
    picture.emplace_back(float((i * 7) % 5) / 4, float(i % 3) / 2, float(i) / 64, 1);
  return picture;
}

// The type of a sample pass, whose files are added first.
std::string own(const char* type) {
  graph::addPasses(FOVEA_OWN_PASSES);
  return type;
}

void wire(PassTest& test, const Surfaces& s, const std::vector<glm::vec4>& picture) {
  test.image("picture", VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, 1, picture);
  wireSurfaces(test, "gbuffer", s.camera, kWidth, kHeight, s.position);
  test.image("gbuffer.normal", VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, 1, s.normal);
}

TEST(OwnFiles, OutlineDrawsALineWhereTheSurfaceTurns) {
  PassTest test(own("outline"));
  test.viewSize(kWidth, kHeight);
  wire(test, corner(), std::vector<glm::vec4>(kWidth * kHeight, glm::vec4(1)));
  test.param("strength", 0.75).run();
  const std::vector<float> rgba = test.floats("image");
  for (uint32_t i = 0; i < kWidth * kHeight; ++i)
    EXPECT_NEAR(rgba[4 * i], i % kWidth == kWidth / 2 - 1 ? 0.25f : 1.0f, 0.5f / 255) << "pixel " << i;
}

// Mean along one axis over the pixels of the same plane.
std::vector<glm::vec4> blurred(const std::vector<glm::vec4>& from, int radius, bool columns) {
  std::vector<glm::vec4> result;
  for (int y = 0; y < int(kHeight); ++y)
    for (int x = 0; x < int(kWidth); ++x) {
      glm::vec4 sum(0);
      float count = 0;
      for (int i = -radius; i <= radius; ++i) {
        const int qx = columns ? x : x + i, qy = columns ? y + i : y;
        if (qx < 0 || qy < 0 || qx >= int(kWidth) || qy >= int(kHeight)) continue;
        if ((qx < int(kWidth) / 2) != (x < int(kWidth) / 2)) continue;
        sum += from[size_t(qy) * kWidth + size_t(qx)];
        ++count;
      }
      result.push_back(sum / count);
    }
  return result;
}

TEST(OwnFiles, BilateralBlurStaysOnTheSurface) {
  const std::vector<glm::vec4> picture = stripes(), wanted = blurred(blurred(picture, 2, false), 2, true);
  PassTest test(own("bilateral-blur"));
  test.viewSize(kWidth, kHeight);
  wire(test, corner(), picture);
  test.param("radius", 2).run();
  const std::vector<float> rgba = test.floats("image");
  ASSERT_EQ(rgba.size(), 4u * wanted.size());
  for (size_t i = 0; i < wanted.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgba[4 * i + size_t(c)], wanted[i][c], 2e-3f) << "pixel " << i;
}

TEST(OwnFiles, TrailKeepsTheBrighterAndFades) {
  PassTest test(own("trail"));
  test.viewSize(kWidth, kHeight);
  std::vector<glm::vec4> dark(kWidth * kHeight, glm::vec4(0.25f)), bright(kWidth * kHeight, glm::vec4(1));
  test.image("picture", VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, 1, dark);
  test.image("before", VK_FORMAT_R32G32B32A32_SFLOAT, kWidth, kHeight, 1, bright);
  test.param("fade", 0.5).run();
  EXPECT_EQ(test.floats("image")[0], 0.5f);
  test.set("before", dark);
  test.run();
  EXPECT_EQ(test.floats("image")[0], 0.25f);
}

// A pass of one step that asks at each pixel whether a ray along -z is stopped. The declaration may have `more`.
void writeRays(const std::filesystem::path& folder, const std::string& type, const std::string& more) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / (type + ".pass.json")) << R"({ "doc": "shadows",)" << more << R"(
    "outputs": { "stopped": { "doc": "1 where a ray is stopped", "format": "r32f", "width": 4, "height": 4 } },
    "steps": [{ "shader": "stopped.frag", "colors": ["stopped"] }] })";
  std::ofstream(folder / "stopped.frag") << R"(
#define RAY_PASSAGE 0
#include "rays/trace.glsl"
layout(location = 0) out float stopped;
void main() {
  vec3 origin = vec3(gl_FragCoord.xy - 2.0, 0.0);
  stopped = occluded(Ray(origin, vec3(0.0, 0.0, -1.0), 0.0, 100.0)) ? 1.0 : 0.0;
}
)";
}

TEST(OwnFiles, TraceRaysIfTheySaySo) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "own_rays";
  writeRays(folder, "own-rays", R"("rays": true,)");
  writeRays(folder / "undeclared", "own-undeclared-rays", "");
  graph::addPasses(folder);
  graph::addPasses(folder / "undeclared");
  scene::Scene scene;
  const uint32_t material = addMaterial(scene, glm::vec3(0.5f));
  addQuad(scene, material, {-2, -2, -3}, {2, 0, 0}, {0, 4, 0});  // before the left half of the pixels
  PassTest test("own-rays");
  test.scene(scene).run();
  const std::vector<float> stopped = test.floats("stopped");
  for (uint32_t i = 0; i < 16; ++i) EXPECT_EQ(stopped[i], i % 4 < 2 ? 1 : 0) << "pixel " << i;

  PassTest undeclared("own-undeclared-rays");
  undeclared.scene(scene);
  try {
    undeclared.run();
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::BadInput);
    EXPECT_NE(std::string(e.what()).find("it traces rays, which the pass does not declare"),
              std::string::npos)
        << e.what();
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace fovea::test
