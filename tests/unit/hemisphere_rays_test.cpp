// Tests the properties of the six directions over a hemisphere on which every estimate with them relies.
#include <gtest/gtest.h>

#include <cmath>

#include "shaders/records/hemisphere_rays.h"
#include "tests/references/paraboloid.h"

namespace fovea::scene {
namespace {

TEST(HemisphereRays, AreUnitAndAboveTheHorizon) {
  double cosines = 0;
  for (const glm::vec3 d : kHemisphereRay) {
    EXPECT_NEAR(glm::length(glm::dvec3(d)), 1.0, 1e-7);
    EXPECT_GT(d.z, 0.1f);
    cosines += d.z;
  }
  EXPECT_NEAR(cosines, kHemisphereCosines, 1e-7);
}

TEST(HemisphereRays, MeanIsTheNormal) {
  glm::dvec3 sum(0);
  for (const glm::vec3 d : kHemisphereRay) sum += glm::dvec3(d);
  const glm::dvec3 mean = glm::normalize(sum);
  EXPECT_NEAR(mean.x, 0, 1e-7);
  EXPECT_NEAR(mean.y, 0, 1e-7);
  EXPECT_NEAR(mean.z, 1, 1e-7);
}

// Every direction of the hemisphere lies within or near one of the cones of 60 degrees around the six.
TEST(HemisphereRays, CoverTheHemisphere) {
  double farthest = 1;
  for (int i = 0; i < 20000; ++i) {
    const double z = (i + 0.5) / 20000, phi = i * 2.39996323, s = std::sqrt(1 - z * z);
    const glm::dvec3 d(s * std::cos(phi), s * std::sin(phi), z);
    double nearest = -1;
    for (const glm::vec3 r : kHemisphereRay) nearest = std::max(nearest, glm::dot(d, glm::dvec3(r)));
    farthest = std::min(farthest, nearest);
  }
  EXPECT_GT(farthest, std::cos(46.0 * 0.017453293));  // on the horizon between two of the ring: 45.5 degrees
}

// No ray runs within a degree of a plane of the grid that holds the normal, when the normal is an axis.
TEST(HemisphereRays, CrossTheGridOnAxes) {
  for (int axis = 0; axis < 6; ++axis) {
    glm::vec3 n(0);
    n[axis / 2] = axis % 2 == 0 ? 1.0f : -1.0f;
    const glm::mat3 frame = orthonormalFrame(n);
    for (int i = 1; i < kHemisphereRays; ++i) {
      const glm::vec3 d = toWorld(frame, kHemisphereRay[size_t(i)]);
      for (int c = 0; c < 3; ++c) EXPECT_GT(std::abs(d[c]), 0.0175f) << "axis " << axis << " ray " << i;
    }
  }
}

}  // namespace
}  // namespace fovea::scene
