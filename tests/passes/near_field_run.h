// Runs pass near-field alone, for its tests.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "fovea/test.h"
#include "framework/scene/frame.h"

namespace fovea::test {

// Looks at a scene. By default the fovea fills the picture. What takes many rays is tested on the host alone, as that
// is fast: near_field_both_test.cpp shows that rays on the device find the same light.
struct NearFieldTest : PassTest {
  NearFieldTest(const scene::Scene& s, glm::uvec2 size, bool onHost = true) : PassTest("near-field") {
    viewSize(size.x, size.y).scene(s).view("fovea_radius", 2.0).raysOnHost(onHost);
  }

  // Of an output of the last frame.
  std::vector<glm::vec4> texels(const std::string& port) const {
    const std::vector<float> channels = floats(port);
    std::vector<glm::vec4> result;
    for (size_t i = 0; i < channels.size(); i += 4)
      result.emplace_back(channels[i], channels[i + 1], channels[i + 2], channels[i + 3]);
    return result;
  }
  std::vector<glm::vec4> samples(uint32_t frames = 1) {
    run(frames);
    return texels("samples");
  }
  // Area of the discs in the last frame, m^2.
  float area() const { return values<glm::vec4>("spread")[0].x; }
};

// Means over so many frames of 16 rays each, as after a jump of the gaze.
struct NearFieldMeans {
  static constexpr uint32_t kRays = 16;
  std::vector<glm::vec4> samples, gloss;
  double area = 0;

  NearFieldMeans(NearFieldTest& test, uint32_t frames) {
    test.param("first_samples", 1).param("saccade_samples", int(kRays));
    test.beforeFrame([](PassTest&, scene::Frame& frame) { frame.saccade = 1; });
    test.run();
    for (uint32_t i = 0; i < frames; ++i) {
      test.run();
      add(samples, test.texels("samples"), float(frames));
      add(gloss, test.texels("gloss"), float(frames));
      area += double(test.area()) / frames;
    }
  }

 private:
  static void add(std::vector<glm::vec4>& sum, const std::vector<glm::vec4>& texels, float frames) {
    sum.resize(texels.size(), glm::vec4(0));
    for (size_t i = 0; i < texels.size(); ++i) sum[i] += texels[i] / frames;
  }
};

}  // namespace fovea::test
