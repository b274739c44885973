// One more bounce on every voxel side: L' = L_direct + rho E_cones / pi.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "sampling/random.glsl"
#define CONE_GATHER
#include "voxels/cone.glsl"

layout(local_size_x = 64) in;

uniform usamplerBuffer voxelsInfo;
#if HAS_DIRECT
LARGE_TEXELS(vec4, direct);
#else
#define direct radiance
#endif
layout(std430) writeonly buffer Bounced { vec4 bounced[]; };

const uint kBounce = 0xb0u;  // random stream

void main() {
  // Handles all sides 0 first and then all sides 1, as light-inject does.
  uint voxels = texelFetch(voxelsInfo, 0).x;
  uint id = gl_GlobalInvocationID.x;
  if (id >= 2u * voxels) return;
  uint number = id < voxels ? 2u * id : 2u * (id - voxels) + 1u;
  VoxelSide side = loadSide(number);
  vec3 result = vec3(0.0);
  if (side.area > 0.0) {
    VoxelGrid grid = voxelsGrid();
    uvec3 cell = uvec3(max(worldToVoxel(grid, side.position), vec3(0.0)));
    uint bits = randomStream(kBounce, cell.x, cell.y, 2u * cell.z + (number & 1u));
    vec3 irradiance = gatherHemisphere(grid, side.position, side.normal, 2.0 * kPi * uniformFloat(bits));
    result = texelOf(direct, int(number)).rgb + side.reflectance * irradiance / kPi;
  }
  bounced[number] = vec4(result, dot(result, vec3(0.2126, 0.7152, 0.0722)));
}
