// L = emission + rho / pi * sum over the lights of E_l * visibility_l. Defines: SHADOW_FILTER; ONE_LIGHT, 1 if there
// is one light, 2 if that has one map, 0 for any number of lights. A single light is read from a constant place,
// because a CPU device loads indexed data lane by lane.
#include "common/scene.glsl"
#define SHADOW_MAPS 1
#if ONE_LIGHT == 2
#define SHADOW_LAYER 0u
#endif
#include "common/shadow.glsl"

// Images rather than textures, because on lavapipe a load from a texture costs several times as much.
layout(rgba32f) uniform readonly image2D gbufferPosition;
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(rg16_snorm) uniform readonly image2D gbufferFace;
layout(rgba16f) uniform readonly image2D gbufferAlbedo;
layout(rgba16f) uniform readonly image2D gbufferEmission;
layout(location = 0) out vec4 direct;

// doubt: set where the texels of the map disagree.
vec3 irradianceFrom(LightRecord light, vec3 position, vec3 normal, vec3 face, inout bool doubt) {
  LightSample e = sampleLight(light, position);
  float cosine = dot(normal, e.direction);
  if (cosine <= 0.0 || e.irradiance == vec3(0.0)) return vec3(0.0);
  float visibility = lightVisibility(light, light.firstShadowLayer, position, face);
  doubt = doubt || (visibility > 0.0 && visibility < 1.0);
  return e.irradiance * (cosine * visibility);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec4 position = imageLoad(gbufferPosition, p);
  vec3 normal = imageLoad(gbufferNormal, p).xyz;
  vec3 face = octDecode(imageLoad(gbufferFace, p).xy);
  vec3 irradiance = vec3(0.0);
  bool doubt = false;
#if ONE_LIGHT
  if (position.w > 0.0) irradiance = irradianceFrom(lights[0], position.xyz, normal, face, doubt);
#else
  uint lightCount = position.w > 0.0 ? frame.lightCount : 0u;  // background: nothing to light
  for (uint i = 0u; i < lightCount; ++i) irradiance += irradianceFrom(lights[i], position.xyz, normal, face, doubt);
#endif
  vec3 radiance = imageLoad(gbufferEmission, p).rgb + imageLoad(gbufferAlbedo, p).rgb * irradiance * (1.0 / kPi);
  direct = vec4(min(radiance, 65504.0), doubt ? 0.0 : 1.0);
}
