// References for the passes of ReSTIR GI: a room, what an eye in its middle sees, and densities of samples in double
// precision.
#pragma once

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "framework/base/random.h"
#include "shaders/records/reservoir.h"
#include "tests/passes/deferred_reference.h"
#include "tests/passes/vpl_intensity_reference.h"

namespace fovea::test {

using passes::Reservoir;

constexpr uint32_t kNoPixel = 0xffffffffu;

inline uint32_t packPixel(int x, int y) { return uint32_t(x) | uint32_t(y) << 16; }

// A number in [0, 1), another one at each call.
struct Numbers {
  uint32_t state = 1;
  float next() { return uniformFloat(state = hashPcg(state)); }
  int below(int count) { return std::min(int(next() * float(count)), count - 1); }
};

inline GBuffer gbufferOf(const Room& room) {
  return {room.size.x, room.size.y, room.camera, [&](int x, int y) {
            const Seen& seen = room.pixels[size_t(y * room.size.x + x)];
            SurfacePixel p;
            p.position = seen.position;
            p.distance = seen.there ? glm::length(seen.position) : 0.0f;
            p.normal = seen.normal;
            return p;
          }};
}

inline double luminance(const Reservoir& r) {
  return 0.2126 * r.radiance.r + 0.7152 * r.radiance.g + 0.0722 * r.radiance.b;
}

inline double cosineAt(const SurfacePixel& v, const Reservoir& r) {
  const glm::dvec3 to = glm::dvec3(r.position) - glm::dvec3(v.position);
  return std::max(0.0, glm::dot(glm::normalize(glm::dvec3(v.normal)), to) / glm::length(to));
}

// Solid angle per area of the sample, as seen from a surface; below 0 if that lies behind the sample.
inline double solidAngle(const SurfacePixel& v, const Reservoir& r) {
  const glm::dvec3 from = glm::dvec3(v.position) - glm::dvec3(r.position);
  return glm::dot(glm::dvec3(r.normal), from) / std::pow(glm::length(from), 3);
}

}  // namespace fovea::test
