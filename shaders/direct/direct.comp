#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// L = emission + rho / pi * sum over the lights of E_l * visibility_l.
#include "common/scene.glsl"
#define SHADOW_BINDING 6
#include "common/shadow.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Images and not textures: on lavapipe a load from a texture costs several times as much.
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D gbufferPosition;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D gbufferNormal;
layout(set = 0, binding = 2, rg16_snorm) uniform readonly image2D gbufferFace;
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D gbufferAlbedo;
layout(set = 0, binding = 4, rgba16f) uniform readonly image2D gbufferEmission;
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D direct;

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(p, imageSize(direct)))) return;
  vec4 position = imageLoad(gbufferPosition, p);
  vec3 normal = imageLoad(gbufferNormal, p).xyz;
  vec3 face = octDecode(imageLoad(gbufferFace, p).xy);
  vec3 irradiance = vec3(0.0);
  uint lightCount = position.w > 0.0 ? frame.lightCount : 0u;  // background: nothing to light
  for (uint i = 0u; i < lightCount; ++i) {
    LightSample light = sampleLight(lights[i], position.xyz);
    float cosine = dot(normal, light.direction);
    if (cosine <= 0.0 || light.irradiance == vec3(0.0)) continue;
    irradiance += light.irradiance * (cosine * lightVisibility(lights[i], firstShadowLayer(lights[i]), position.xyz, face));
  }
  vec3 radiance = imageLoad(gbufferEmission, p).rgb + imageLoad(gbufferAlbedo, p).rgb * irradiance * (1.0 / kPi);
  imageStore(direct, p, vec4(min(radiance, 65504.0), 1.0));
}
