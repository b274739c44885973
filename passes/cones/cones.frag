// Irradiance of every pixel by cones through the voxels, as pass radiance gathers it at VPLs (voxels/cone.glsl). Cones
// that are narrow enough to miss their own wall leave gaps. Pixels and frames therefore turn them differently, so that
// a mean has none.
#include "sampling/random.glsl"
#include "scene/scene.glsl"
#include "screen/gbuffer.glsl"
#define CONE_GATHER
#include "voxels/cone.glsl"

SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(location = 0) out vec4 irradiance;

layout(push_constant) uniform Constants { uint frameIndex; };

const uint kConesStream = 0x636f6e65u;
const uint kGoldenRatio = 2654435769u;  // step of a sequence, in 2^-32

void main() {
  uvec2 p = uvec2(gl_FragCoord.xy);
  vec4 position = surfaceAt(ivec2(p));
  irradiance = vec4(0.0);
  if (position.w <= 0.0) return;
  vec3 normal = normalize(imageLoad(gbufferNormal, ivec2(p)).xyz);
  float turn = 2.0 * kPi * uniformFloat(randomStream(frame.seed, p.x, kConesStream, p.y) + frameIndex * kGoldenRatio);
  irradiance = vec4(min(gatherHemisphere(voxelsGrid(), position.xyz, normal, turn) / kPi, 65504.0), 1.0);
}
