// The light that probes know, for passes on the CPU: the C++ version of passes/probe-sample/probe_sample.frag and
// shaders/probes/, which must be changed together with it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "shaders/records/probes.h"

namespace fovea::passes {

// A grid of cubic cells that covers the bounds, with their common centre. The longest axis has `probes` cells, or fewer
// if they would be narrower than `spacing` metres. No axis has more.
scene::ProbeGrid probeGrid(glm::vec3 boundsMin, glm::vec3 boundsMax, uint32_t probes, float spacing);

// Cell `probe` of the grid.
glm::uvec3 probeCell(const scene::ProbeGrid& grid, uint32_t probe);
uint32_t probesOf(const scene::ProbeGrid& grid);
// Where a probe stands that has this state.
glm::vec3 probePosition(const scene::ProbeGrid& grid, uint32_t probe, const scene::Probe& state);

// The bundle `probes` as arrays.
struct ProbeImages {
  std::span<const glm::vec4> irradiance;
  std::span<const glm::vec2> distance;
  std::span<const scene::Probe> states;
};

class ProbeField {
 public:
  // bias: how far points are moved off their surface, in spacings of the grid.
  ProbeField(const scene::ProbeGrid& grid, const ProbeImages& images, float bias)
      : grid_(grid), images_(images), bias_(bias) {}

  // Irradiance / pi at a point of a surface, W/(sr m^2). normal: unit; towardsEye: unit, from where it is seen.
  glm::vec3 light(glm::vec3 position, glm::vec3 normal, glm::vec3 towardsEye) const;

 private:
  float chanceSeen(uint32_t probe, glm::vec3 direction, float distance) const;

  scene::ProbeGrid grid_;
  ProbeImages images_;
  float bias_;
};

}  // namespace fovea::passes
