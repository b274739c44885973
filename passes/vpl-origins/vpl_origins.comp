// One slot per invocation: the VPL moved slightly out of the surface that its voxel averages.
#include "scene/scene.glsl"
#include "voxels/voxel_trace.glsl"
#include "device/finite.glsl"

layout(local_size_x = 64) in;

uniform usamplerBuffer vpls;
uniform samplerBuffer radiosity;
layout(std430) writeonly buffer PlacedBlock { Vpl list[]; } placed;

layout(push_constant) uniform Constants {
  uint vplCount;
  float offset;  // cells
  float least;   // W/sr
};

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= vplCount) return;
  VplState state = loadVplState(vpls, slot);
  vec4 light = texelFetch(radiosity, int(slot));
  Vpl vpl = kNoVpl;
  if (state.life > 0.0 && finite(vec4(state.position, 0.0)) && finite(vec4(state.normal, state.life)) &&
      finite(light)) {
    vpl.position = state.position + offset * voxelsGrid().cell * state.normal;
    vpl.area = 1.0;
    vpl.normal = state.normal;
    vpl.intensity = max(light.rgb * (1.0 / kPi), vec3(least));
  }
  placed.list[slot] = vpl;
}
