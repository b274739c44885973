// State shared by the steps of one voxelisation.
#ifndef FOVEA_VOXELIZE_STATE_GLSL
#define FOVEA_VOXELIZE_STATE_GLSL

#include "voxelize/records.h"

uint groupIndex() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

#endif
