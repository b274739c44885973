// One slot per invocation: the VPL moved slightly out of the surface that its voxel averages.
#include "common/scene.glsl"
#include "common/voxel_trace.glsl"
#include "common/finite.glsl"

layout(local_size_x = 64) in;

uniform samplerBuffer vpls;
uniform samplerBuffer radiosity;
layout(std430) writeonly buffer PlacedBlock { Vpl list[]; } placed;

layout(push_constant) uniform Constants {
  uint vplCount;
  float offset;  // cells
  float least;   // W/sr
};

const int kStateTexels = 5;  // of a VplState

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= vplCount) return;
  int first = int(slot) * kStateTexels;
  vec4 normalLife = texelFetch(vpls, first + 1), light = texelFetch(radiosity, int(slot));
  vec3 position = texelFetch(vpls, first).xyz;
  Vpl vpl = Vpl(vec4(0.0), vec4(0.0), vec4(0.0));
  if (normalLife.w > 0.0 && finite(vec4(position, 0.0)) && finite(normalLife) && finite(light)) {
    vpl.positionArea = vec4(position + offset * voxelsGrid().cell * normalLife.xyz, 1.0);
    vpl.normal = vec4(normalLife.xyz, 0.0);
    vpl.intensity = vec4(max(light.rgb * (1.0 / kPi), vec3(least)), 0.0);
  }
  placed.list[slot] = vpl;
}
