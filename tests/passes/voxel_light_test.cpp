// The light of emissive surfaces that rays through the voxels see.
#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "framework/scene/scene.h"
#include "tests/references/voxel_trace.h"
#include "tests/support/shapes.h"
#include "tests/support/voxels.h"

namespace fovea::test {
namespace {

using glm::vec3;
using scene::Scene;

// Rays in all directions see as much light of a luminous cube as its surface sends, however small or large it is in
// voxels: a side of a small surface can be hit beside it, too.
TEST(VoxelLight, RaysSeeTheLightThatASurfaceSends) {
  constexpr int kResolution = 32, kRays = 40000;
  std::mt19937 bits(5);
  const auto number = [&] { return float(bits() >> 8) * 0x1p-24f; };  // in [0, 1)
  const auto point = [&] { return vec3(number(), number(), number()); };
  for (const float edge : {0.2f, 0.4f, 0.8f, 1.6f, 4.0f}) {  // cells
    double seen = 0, sent = 0;
    for (int place = 0; place < 12; ++place) {
      Scene s;
      s.cameras.emplace_back();
      const uint32_t dark = addMaterial(s, vec3(0.5f)), lamp = addMaterial(s, vec3(0.5f));
      s.materials[lamp].emission = vec3(1);
      for (const float corner : {0.0f, float(kResolution) - 0.001f})  // two specks set the bounds of the grid
        addQuad(s, dark, vec3(corner), vec3(0.001f, 0, 0), vec3(0, 0.001f, 0));
      const vec3 middle = vec3(15) + 2.0f * point();
      const glm::mat3 turn(glm::mat3_cast(glm::normalize(glm::quat(number() - 0.5f, point() - 0.5f))));
      for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f}) {
          const vec3 u = edge * turn[(axis + 1) % 3], v = edge * turn[(axis + 2) % 3];
          const vec3 low = middle + 0.5f * (sign * edge * turn[axis] - u - v);
          sign > 0 ? addQuad(s, lamp, low, u, v) : addQuad(s, lamp, low, v, u);
        }
      const VoxelArrays v = voxelizeReference(s, scene::flatten(s), kResolution);
      const scene::Voxels voxels{v.grid, v.index, v.surface};
      const float radius = 0.9f * edge + 2;  // of a disc through which rays pass around the cube
      for (int ray = 0; ray < kRays / 12; ++ray) {
        vec3 d, p;
        do d = 2.0f * point() - 1.0f;
        while (glm::length(d) > 1 || glm::length(d) < 0.1f);
        d = glm::normalize(d);
        do p = 2.0f * point() - 1.0f;
        while (glm::length(glm::vec2(p)) > 1);
        const vec3 across =
            glm::normalize(glm::cross(d, std::abs(d.x) < 0.5f ? vec3(1, 0, 0) : vec3(0, 1, 0)));
        const vec3 from = middle - 10.0f * d + radius * (p.x * across + p.y * glm::cross(d, across));
        const scene::VoxelHit hit = scene::traceVoxels(voxels, from, d, d);
        if (hit.side != scene::kNoSide) seen += double(v.surface[hit.side].emission.x);
      }
      sent +=
          1.5 * edge * edge / (glm::pi<double>() * radius * radius) * (kRays / 12);  // a quarter of its area
    }
    EXPECT_NEAR(seen / sent, 1, 0.15) << edge << " cells";
  }
}

}  // namespace
}  // namespace fovea::test
