// Plants of the built-in scenes: modelled leaves, which need a double-sided material, on modelled wood.
#pragma once

#include <cstdint>
#include <vector>

#include "samples/scenes/builtin/modelling/model.h"

namespace fovea::scene::model {

struct Leaf {
  float length = 0.10f, width = 0.045f;
  float fold = 0.3f;   // height of the edges above the rib, as a share of half the width
  float droop = 0.2f;  // at the tip, as a share of the length
  int steps = 1;       // 4 triangles each
};
// A leaf from the origin along +z, with its upper side towards +y.
Shape leafBlade(const Leaf& leaf);

struct Plant {
  Shape wood, leaves, fruits;
};

struct TreeForm {
  float trunkHeight = 1.4f, trunkRadius = 0.07f;
  glm::vec3 crown{0.8f, 0.7f, 0.8f};  // half axes of the crown, whose middle is crown.y * 0.9 above the trunk
  int boughs = 7, twigs = 300, leavesPerTwig = 8;
  float twigLength = 0.28f;
  Leaf leaf;
  int fruits = 0;
  float fruitRadius = 0.035f;
  uint32_t seed = 1;
};
Plant tree(const TreeForm& form);

// Blades from one root, for agaves, ferns, palms and irises. `spreadDegrees`: angle of the outermost blades
// from the vertical.
Shape rosette(int blades, const Leaf& leaf, float spreadDegrees, uint32_t seed);

// A low bush without a trunk: stems and leaves in a dome of the given half axes, standing on y = 0.
Plant bush(glm::vec3 dome, int stems, int leavesPerStem, const Leaf& leaf, uint32_t seed);

// Leaves and stems that hang over an edge, from the origin down to about -length; turned upside down, a climber.
Plant trailing(int strands, float length, float spread, const Leaf& leaf, uint32_t seed);

// A climber along `stem`: twigs `reach` long to all sides, most of them along `out` (the normal of the wall). A share
// `bloom` of the twigs ends in flowers of three bracts each, which are returned as `fruits`.
Plant climber(const std::vector<glm::vec3>& stem, glm::vec3 out, float reach, int twigs, int leavesPerTwig,
              const Leaf& leaf, float bloom, uint32_t seed);

// Stems from one root, each with a ball of petals (`fruits`), for geraniums and hydrangeas.
Plant flowers(glm::vec3 dome, int stems, float headRadius, int petals, uint32_t seed);

}  // namespace fovea::scene::model
