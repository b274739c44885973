// A plain CPU version of pass `importance` with method `rays`.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "framework/base/random.h"
#include "shaders/records/hemisphere_rays.h"
#include "tests/references/paraboloid.h"
#include "tests/references/voxel_trace.h"

namespace fovea::test {

// A ray that grazes the border of a voxel hits one side or the other depending on rounding, so what it may see is a
// range. All other rays are exact.
struct ImportanceReference {
  scene::Voxels voxels;
  const std::vector<float>& weights;
  size_t rays = 0, grazing = 0;

  struct Range {
    double low = 0, high = 0;
  };
  Range importance(glm::vec3 position, glm::vec3 normal) {
    const glm::mat3 frame = scene::orthonormalFrame(normal);
    Range sum;
    double cosines = 0;
    for (const glm::vec3 local : scene::kHemisphereRay) {
      const glm::vec3 direction = scene::toWorld(frame, local);
      const uint32_t side = scene::traceVoxels(voxels, position, direction, normal).side;
      const auto weight = [&](uint32_t s) { return s == scene::kNoSide ? 0.0 : double(weights[s]); };
      double low = weight(side), high = low;
      bool grazes = false;
      for (uint32_t k = 0; k < 8; ++k) {  // the same ray, a hair beside
        const glm::vec3 origin = position + 1e-5f * voxels.grid.cell * hair(40, k);
        const glm::vec3 turned = glm::normalize(direction + 1e-6f * hair(43, k));
        const uint32_t other = scene::traceVoxels(voxels, origin, turned, normal).side;
        grazes |= other != side;
        low = std::min(low, weight(other));
        high = std::max(high, weight(other));
      }
      ++rays;
      grazing += grazes;
      sum.low += low * local.z;
      sum.high += high * local.z;
      cosines += local.z;
    }
    return {sum.low / cosines, sum.high / cosines};
  }

 private:
  // A fixed random vector with components from -1 to 1.
  static glm::vec3 hair(uint32_t what, uint32_t i) {
    const auto random = [i](uint32_t axis) { return uniformFloat(randomStream(31, 0, axis, i)); };
    return glm::vec3(random(what), random(what + 1), random(what + 2)) * 2.0f - 1.0f;
  }
};

}  // namespace fovea::test
