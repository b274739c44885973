// Radiosity of every VPL (Eq. 3): B_l = rho_l (E_direct + E_cones). Define: CONES, 0: only the direct term.
#include "device/texels.glsl"
#include "scene/scene.glsl"
#include "vpls/vpl.glsl"
#if CONES
#include "sampling/random.glsl"
#define CONE_GATHER
#include "voxels/cone.glsl"
#else
LARGE_TEXELS(vec4, radiance);
#endif

layout(local_size_x = 8) in;

uniform usamplerBuffer vpls;
layout(std430) writeonly buffer Radiosity { vec4 radiosity[]; };

layout(push_constant) uniform Constants {
  uint count;
  int terms;  // 0 both, 1 direct, 2 cones
};

const uint kRadiance = 0x4adu;  // random stream

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= count) return;
  VplState vpl = loadVplState(vpls, slot);
  vec3 result = vec3(0.0);
  if (vpl.life > 0.0) {
    int side = int(vpl.side);
    // Reflected direct light and emission of the voxel are known from light-inject: rho E_direct = pi L.
    if (terms != 2 && side >= 0 && side < texelsIn(radiance)) result += kPi * texelOf(radiance, side).rgb;
#if CONES
    if (terms != 1) {
      // A slot keeps its cones as long as its VPL lives.
      float turn = 2.0 * kPi * uniformFloat(randomStream(frame.seed, 0u, kRadiance, slot));
      result += vpl.reflectance * gatherHemisphere(voxelsGrid(), vpl.position, vpl.normal, turn);
    }
#endif
  }
  radiosity[slot] = vec4(result, dot(result, vec3(0.2126, 0.7152, 0.0722)));
}
