#include "passes/probe-rays-host/probe_field.h"

#include <algorithm>
#include <cmath>

#include "framework/shader_twins/octahedral.h"

namespace fovea::passes {

namespace {

using namespace scene;

glm::vec2 octEncode(glm::vec3 n) {
  n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  const glm::vec2 s(n.x >= 0 ? 1 : -1, n.y >= 0 ? 1 : -1);
  return n.z >= 0 ? glm::vec2(n) : (1.0f - glm::abs(glm::vec2(n.y, n.x))) * s;
}

// Between the four texels around a direction in a probe's tile.
template <class Texel>
Texel between(std::span<const Texel> image, uint32_t probe, int side, glm::vec3 direction) {
  const int width = kProbeTilesInARow * (side + 2);
  const glm::ivec2 tile(int(probe) % kProbeTilesInARow, int(probe) / kProbeTilesInARow);
  const glm::vec2 place = 0.5f + (0.5f * octEncode(direction) + 0.5f) * float(side),
                  corner = glm::floor(place), f = place - corner;
  const glm::ivec2 p = (side + 2) * tile + glm::ivec2(corner);
  const Texel* texels = image.data() + size_t(p.y) * size_t(width) + size_t(p.x);
  return glm::mix(glm::mix(texels[0], texels[1], f.x), glm::mix(texels[width], texels[width + 1], f.x), f.y);
}

}  // namespace

ProbeGrid probeGrid(glm::vec3 boundsMin, glm::vec3 boundsMax, uint32_t probes, float spacing) {
  constexpr float kRounding = 1e-3f;  // of a cell
  const glm::vec3 extent = boundsMax - boundsMin;
  ProbeGrid grid;
  grid.spacing = std::max({std::max({extent.x, extent.y, extent.z}) / float(probes), spacing, 1e-6f});
  const glm::uvec3 cells(
      glm::clamp(glm::ceil(extent / grid.spacing - kRounding), glm::vec3(1), glm::vec3(float(probes))));
  grid.columns = cells.x;
  grid.rows = cells.y;
  grid.layers = cells.z;
  grid.origin = 0.5f * (boundsMin + boundsMax) - 0.5f * grid.spacing * glm::vec3(cells - 1u);
  return grid;
}

uint32_t probesOf(const ProbeGrid& grid) { return grid.columns * grid.rows * grid.layers; }

glm::uvec3 probeCell(const ProbeGrid& grid, uint32_t probe) {
  return {probe % grid.columns, probe / grid.columns % grid.rows, probe / grid.columns / grid.rows};
}

glm::vec3 probePosition(const ProbeGrid& grid, uint32_t probe, const Probe& state) {
  return grid.origin + grid.spacing * glm::vec3(probeCell(grid, probe)) + state.offset;
}

float ProbeField::chanceSeen(uint32_t probe, glm::vec3 direction, float distance) const {
  const glm::vec2 seen = between(images_.distance, probe, kDistanceSide, direction);
  const float variance = std::abs(seen.y - seen.x * seen.x), behind = distance - seen.x;
  if (!(behind > 0)) return 1;
  const float chance = variance / (variance + behind * behind);
  return std::max(chance * chance * chance, 0.05f);
}

glm::vec3 ProbeField::light(glm::vec3 position, glm::vec3 normal, glm::vec3 towardsEye) const {
  const glm::vec3 moved = position + bias_ * grid_.spacing * (0.2f * normal + 0.8f * towardsEye);
  const glm::ivec3 last = glm::ivec3(grid_.columns, grid_.rows, grid_.layers) - 1;
  const glm::vec3 place = glm::clamp((moved - grid_.origin) / grid_.spacing, glm::vec3(0), glm::vec3(last));
  const glm::ivec3 first = glm::min(glm::ivec3(place), glm::max(last - 1, 0));
  const glm::vec3 between_ = place - glm::vec3(first);
  glm::vec4 sum(0);
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2);
    const glm::uvec3 cell(glm::min(first + corner, last));
    const uint32_t probe = cell.x + grid_.columns * (cell.y + grid_.rows * cell.z);
    const Probe& state = images_.states[probe];
    if (state.inside > 0) continue;
    const glm::vec3 stands = probePosition(grid_, probe, state), to = moved - stands;
    const float facing = 0.5f * glm::dot(glm::normalize(stands - position), normal) + 0.5f,
                distance = glm::length(to);
    float weight = (facing * facing + 0.2f) * chanceSeen(probe, to / std::max(distance, 1e-6f), distance);
    if (weight < 0.2f) weight *= weight * weight / (0.2f * 0.2f);
    const glm::vec3 linear = glm::mix(1.0f - between_, between_, glm::vec3(corner));
    weight *= std::max(linear.x * linear.y * linear.z, 1e-6f);
    sum += weight * glm::vec4(glm::vec3(between(images_.irradiance, probe, kIrradianceSide, normal)), 1);
  }
  return sum.a > 0 ? glm::vec3(sum) / sum.a : glm::vec3(0);
}

}  // namespace fovea::passes
