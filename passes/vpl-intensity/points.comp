// The fixed screen points of the region from which densities are estimated: screenPoint(). They are the same in every
// frame, so that only changes in the scene change the intensities. TRACED 1: the surfaces that pass eye-paths saw from
// such points, some of them in earlier frames.
#include "scene/scene.glsl"
#include "sampling/fovea.glsl"
#include "vpl-intensity/vpl_intensity.glsl"
#include "screen/gbuffer.glsl"

layout(local_size_x = 64) in;

#if TRACED
uniform samplerBuffer tracedStarts;
#else
SURFACES(gbuffer, surfaceAt)
uniform texture2D gbufferNormal;
uniform texture2D gbufferFace;
#endif
layout(std430) writeonly buffer ScreenBlock { EyePathStart list[]; } screen;

#if TRACED
layout(push_constant) uniform Constants { uint points; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= points) return;
  screen.list[i] = loadStart(tracedStarts, i);
}
#else
layout(push_constant) uniform Constants {
  uint region;
  uint imageShare64ths;
  float foveaRadius;
  uint points;
};

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= points) return;
  ivec2 size = imageSize(gbufferDistance);
  ivec2 pixel = screenPoint(region, imageShare64ths, i, points, makeFovea(view.gaze, vec2(size), foveaRadius), size);
  vec4 position = surfaceAt(pixel);
  bool there = position.w > 0.0;
  vec3 normal = there ? normalize(texelFetch(gbufferNormal, pixel, 0).xyz) : vec3(0.0);
  vec3 face = octDecode(texelFetch(gbufferFace, pixel, 0).xy);
  screen.list[i] = EyePathStart(position.xyz, there ? 1.0 : 0.0, normal, 0.0, face, 0.0);
}
#endif
