// What tests of the probe passes share: images of probes as plain arrays, and their layout in double precision.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "fovea/test.h"
#include "framework/base/random.h"
#include "shaders/records/probes.h"

namespace fovea::test {

// Point (x, y) of the square, in [-1, 1], unfolded to the octahedron; the square goes on beyond its edges as its mirror
// image about their middles.
inline glm::dvec3 octahedronAt(glm::dvec2 e) {
  if (std::abs(e.x) > 1) e = {std::copysign(2.0, e.x) - e.x, -e.y};
  if (std::abs(e.y) > 1) e = {-e.x, std::copysign(2.0, e.y) - e.y};
  glm::dvec3 n(e, 1 - std::abs(e.x) - std::abs(e.y));
  if (n.z < 0)
    n = {(1 - std::abs(e.y)) * std::copysign(1.0, e.x), (1 - std::abs(e.x)) * std::copysign(1.0, e.y), n.z};
  return glm::normalize(n);
}

// Tiles of side x side texels and a border of one, 64 in a row.
struct ProbeTiles {
  int side, probes;
  int width() const { return 64 * (side + 2); }
  int height() const { return (probes + 63) / 64 * (side + 2); }
  size_t size() const { return size_t(width()) * size_t(height()); }
  // Texel (x, y) of a tile; -1 and `side` are the border.
  size_t at(int probe, int x, int y) const {
    const int column = probe % 64 * (side + 2) + 1 + x, row = probe / 64 * (side + 2) + 1 + y;
    return size_t(row) * size_t(width()) + size_t(column);
  }
  glm::dvec3 direction(int x, int y) const {
    return octahedronAt((2.0 * glm::dvec2(x, y) + 1.0) / double(side) - 1.0);
  }
};

// Numbers in [0, 1) that are the same in every run.
class Numbers {
 public:
  explicit Numbers(uint32_t seed) : seed_(seed) {}
  float next() { return uniformFloat(randomStream(seed_, 0, 0, count_++)); }
  float next(float low, float high) { return low + (high - low) * next(); }
  glm::vec3 direction() {
    const float z = next(-1, 1), phi = glm::two_pi<float>() * next(), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  uint32_t seed_, count_ = 0;
};

// The bundle `probes`.
struct Probes {
  ProbeTiles irradianceTiles, distanceTiles;
  std::vector<glm::vec4> irradiance;
  std::vector<glm::vec2> distance;
  std::vector<scene::Probe> states;

  explicit Probes(int count)
      : irradianceTiles{6, count},
        distanceTiles{14, count},
        irradiance(irradianceTiles.size()),
        distance(distanceTiles.size()),
        states(size_t(count)) {}

  void wire(PassTest& test, const std::string& port) const {
    test.image(port + ".irradiance", VK_FORMAT_R32G32B32A32_SFLOAT, uint32_t(irradianceTiles.width()),
               uint32_t(irradianceTiles.height()), 1, irradiance);
    test.image(port + ".distance", VK_FORMAT_R32G32_SFLOAT, uint32_t(distanceTiles.width()),
               uint32_t(distanceTiles.height()), 1, distance);
    test.buffer(port + ".states", states, "Probe");
  }
};

}  // namespace fovea::test
