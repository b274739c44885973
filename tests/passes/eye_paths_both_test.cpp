// Compares eye paths whose rays run on the device with those on the host.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "fovea/test.h"
#include "framework/scene/frame.h"
#include "shaders/records/eye_paths.h"
#include "tests/passes/scene_of_everything.h"

namespace fovea::test {
namespace {

using passes::EyePathEnd;
using passes::EyePathStart;

struct Result {
  std::vector<EyePathStart> starts;
  std::vector<EyePathEnd> ends;
  glm::vec4 change{0};
  double rays = 0;
};

Result run(bool onHost, const std::string& materials, bool emission, uint32_t frames) {
  PassTest test("eye-paths");
  test.raysOnHost(onHost);
  test.viewSize(48, 32).scene(sceneOfEverything(materials == "glass"));
  test.view("materials", materials == "diffuse" ? "diffuse" : "full")
      .param("emission", emission)
      .param("region", "mixed");
  test.param("points", 300)
      .param("paths", 1000)
      .param("bounces", 3)
      .param("renew_frames", 4)
      .param("stray", 0.1);
  test.param("trace_frames", 2);
  test.beforeFrame([](PassTest&, scene::Frame& frame) {
    if (frame.index >= 2) frame.views[0].gaze = {0.2f, 0.4f};
    if (frame.index >= 3) frame.lights[0].color *= 0.8f;
  });
  test.run(frames);
  return {test.values<EyePathStart>("paths.starts"), test.values<EyePathEnd>("paths.ends"),
          test.values<glm::vec4>("change")[0], test.counter("rays")};
}

// Both take the same random numbers, so that they differ by rounding alone; where rays meet glass, that decides whether
// one passes.
TEST(LongEyePathsBoth, FindTheSame) {
  for (const std::string materials : {"diffuse", "full", "glass"})
    for (const bool emission : {false, true})
      for (const uint32_t frames : {1u, 4u}) {
        const std::string what = materials + (emission ? " emissive " : " ") + std::to_string(frames);
        const Result host = run(true, materials, emission, frames),
                     device = run(false, materials, emission, frames);
        int starts = 0, ends = 0, lit = 0;
        for (size_t i = 0; i < host.starts.size(); ++i) {
          const EyePathStart &a = host.starts[i], &b = device.starts[i];
          starts += a.there != b.there || glm::distance(a.position, b.position) > 1e-3f ||
                    glm::distance(a.normal, b.normal) > 1e-3f || glm::distance(a.face, b.face) > 1e-3f;
        }
        for (size_t i = 0; i < host.ends.size(); ++i) {
          const EyePathEnd &a = host.ends[i], &b = device.ends[i];
          lit += a.radiance != glm::vec3(0);
          ends += a.kind != b.kind || glm::distance(a.position, b.position) > 1e-3f ||
                  glm::distance(a.normal, b.normal) > 1e-3f ||
                  std::abs(a.weight - b.weight) > 1e-3f * a.weight ||
                  glm::distance(a.radiance, b.radiance) > 2e-3f * glm::length(a.radiance);
          EXPECT_EQ(b.unit, device.ends[0].unit);
        }
        const bool glass = materials == "glass";
        EXPECT_GT(lit, int(host.ends.size()) / 4) << what;
        EXPECT_LE(starts, int(host.starts.size()) / 100) << what;
        EXPECT_LE(ends, int(host.ends.size()) / (glass ? 8 : 50)) << what;
        EXPECT_NEAR(device.ends[0].unit, host.ends[0].unit, 0.02f * host.ends[0].unit) << what;
        EXPECT_NEAR(device.rays, host.rays, 0.05 * host.rays) << what;
        EXPECT_EQ(host.change.x > 0.02f, frames == 4) << what;
        if (glass) continue;  // glass changes what paths find in each frame
        for (int c = 0; c < 4; ++c)
          EXPECT_NEAR(device.change[c], host.change[c], 0.02f * host.change[c] + 1e-6f) << what << " " << c;
      }
}

}  // namespace
}  // namespace fovea::test
