// Paths are traced in rounds until the list of VPLs is full.
#include "records/light_paths.h"

// The number of work groups that trace a round.
uvec2 groupsOf(uint paths) {
  uint groups = (paths + kLightPathGroup - 1u) / kLightPathGroup;
  uint rows = (groups + kLightPathColumns - 1u) / kLightPathColumns;
  return uvec2(min(groups, kLightPathColumns), rows);
}
