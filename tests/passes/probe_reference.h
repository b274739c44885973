// What tests of the probe passes share: images of probes as plain arrays, and their layout in double precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "fovea/test.h"
#include "framework/base/random.h"
#include "shaders/records/probes.h"
#include "tests/passes/deferred_reference.h"

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

// Light of every colour, distances of which some hide a point and some do not, and one probe of seven inside geometry.
inline Probes knownProbes(int count, float spacing) {
  Probes probes(count);
  Numbers numbers(3);
  for (glm::vec4& t : probes.irradiance) t = {numbers.next(), 2 * numbers.next(), 4 * numbers.next(), 1};
  for (glm::vec2& t : probes.distance) {
    t.x = spacing * numbers.next(0.2f, 1.8f);
    t.y = t.x * t.x + spacing * spacing * numbers.next(0.004f, 0.2f);
  }
  for (size_t i = 0; i < probes.states.size(); ++i) {
    probes.states[i].offset =
        0.4f * spacing * (glm::vec3(numbers.next(), numbers.next(), numbers.next()) - 0.5f);
    probes.states[i].inside = i % 7 == 3 ? 1.0f : 0.0f;
  }
  return probes;
}

template <class Texel>
glm::dvec4 bilinear(const std::vector<Texel>& image, const ProbeTiles& tiles, int probe,
                    glm::dvec3 direction) {
  const glm::dvec2 e(octEncode(glm::vec3(direction)));
  const glm::dvec2 place = (0.5 * e + 0.5) * double(tiles.side) - 0.5;
  glm::dvec4 sum(0);
  for (int k = 0; k < 4; ++k) {
    const glm::ivec2 p = glm::ivec2(glm::floor(place)) + glm::ivec2(k & 1, k >> 1);
    const glm::dvec2 near = 1.0 - glm::abs(place - glm::dvec2(p));
    const Texel& texel = image[tiles.at(probe, p.x, p.y)];
    for (int c = 0; c < int(Texel::length()); ++c) sum[c] += near.x * near.y * double(texel[c]);
  }
  return sum;
}

// Irradiance / pi at a surface. bias: spacings by which the point is moved off it.
inline glm::dvec3 probeLight(const scene::ProbeGrid& grid, const Probes& probes, glm::dvec3 position,
                             glm::dvec3 normal, glm::dvec3 towardsEye, double bias) {
  const double spacing = grid.spacing;
  const glm::dvec3 moved = position + bias * spacing * (0.2 * normal + 0.8 * towardsEye);
  const int counts[3] = {int(grid.columns), int(grid.rows), int(grid.layers)};
  glm::dvec3 sum(0);
  double weights = 0;
  for (int probe = 0; probe < counts[0] * counts[1] * counts[2]; ++probe) {
    const int cell[3] = {probe % counts[0], probe / counts[0] % counts[1], probe / counts[0] / counts[1]};
    double weight = 1;
    glm::dvec3 centre;
    bool near = true;
    for (int k = 0; k < 3; ++k) {
      centre[k] = double(grid.origin[k]) + spacing * cell[k];
      const double last = counts[k] - 1,
                   place = std::clamp((moved[k] - double(grid.origin[k])) / spacing, 0.0, last);
      const double first = std::min(std::floor(place), std::max(last - 1, 0.0));
      near = near && (cell[k] == first || cell[k] == first + 1);
      weight *= 1 - std::abs(place - cell[k]);
    }
    const scene::Probe& state = probes.states[size_t(probe)];
    if (!near || state.inside > 0) continue;
    const glm::dvec3 stands = centre + glm::dvec3(state.offset);
    const double facing = (glm::dot(glm::normalize(stands - position), normal) + 1) / 2;
    const double distance = glm::distance(moved, stands);
    const glm::dvec4 seen =
        bilinear(probes.distance, probes.distanceTiles, probe, (moved - stands) / distance);
    double chance = 1;
    if (distance > seen.x) {
      const double variance = std::abs(seen.y - seen.x * seen.x);
      chance = std::max(std::pow(variance / (variance + std::pow(distance - seen.x, 2)), 3), 0.05);
    }
    double other = (facing * facing + 0.2) * chance;
    if (other < 0.2) other *= other * other / 0.04;
    weight = std::max(weight, 1e-6) * other;
    sum += weight * glm::dvec3(bilinear(probes.irradiance, probes.irradianceTiles, probe, normal));
    weights += weight;
  }
  return weights > 0 ? sum / weights : glm::dvec3(0);
}

}  // namespace fovea::test
