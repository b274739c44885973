#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// L = emission + rho / pi * sum over the lights of E_l * visibility_l.
#include "common/scene.glsl"
#define SHADOW_BINDING 6
#include "common/shadow.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform texture2D gbufferPosition;
layout(set = 0, binding = 1) uniform texture2D gbufferNormal;
layout(set = 0, binding = 2) uniform texture2D gbufferFace;
layout(set = 0, binding = 3) uniform texture2D gbufferAlbedo;
layout(set = 0, binding = 4) uniform texture2D gbufferEmission;
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D direct;

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(p, imageSize(direct)))) return;
  vec4 position = texelFetch(gbufferPosition, p, 0);
  vec3 normal = texelFetch(gbufferNormal, p, 0).xyz;
  vec3 face = octDecode(texelFetch(gbufferFace, p, 0).xy);
  vec3 irradiance = vec3(0.0);
  uint lightCount = position.w > 0.0 ? frame.lightCount : 0u;  // background: nothing to light
  for (uint i = 0u; i < lightCount; ++i) {
    LightSample light = sampleLight(lights[i], position.xyz);
    float cosine = dot(normal, light.direction);
    if (cosine <= 0.0 || light.irradiance == vec3(0.0)) continue;
    irradiance += light.irradiance * (cosine * lightVisibility(lights[i], firstShadowLayer(lights[i]), position.xyz, face));
  }
  vec3 radiance = texelFetch(gbufferEmission, p, 0).rgb + texelFetch(gbufferAlbedo, p, 0).rgb * irradiance * (1.0 / kPi);
  imageStore(direct, p, vec4(min(radiance, 65504.0), 1.0));
}
