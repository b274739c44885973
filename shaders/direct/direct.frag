// L = emission + rho / pi * sum over the lights of E_l * visibility_l. Defines: SHADOW_FILTER; ONE_LIGHT, 1 if there
// is one light, 2 if that has one map, 0 for any number of lights. A single light is read from a constant place,
// because a CPU device loads indexed data lane by lane. GLOSS 0/1, 1 for full materials: in place of rho / pi stands
// all that a surface reflects.
#if GLOSS
#include "common/materials/gloss.glsl"
#endif
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
#if GLOSS
layout(rgba16f) uniform readonly image2D gbufferSpecular;
#endif
layout(location = 0) out vec4 direct;

struct Receiver {
  vec3 position, normal, face;
#if GLOSS
  Reflector reflector;
  vec3 albedo;
#endif
};

// Irradiance, or with full materials radiance towards the eye. doubt: set where the texels of the map disagree.
vec3 lightFrom(LightRecord light, Receiver r, inout bool doubt) {
  LightSample e = sampleLight(light, r.position);
  float cosine = dot(r.normal, e.direction);
  if (cosine <= 0.0 || e.irradiance == vec3(0.0)) return vec3(0.0);
  float visibility = lightVisibility(light, light.firstShadowLayer, r.position, r.face);
  doubt = doubt || (visibility > 0.0 && visibility < 1.0);
  vec3 irradiance = e.irradiance * (cosine * visibility);
#if GLOSS
  return irradiance * reflected(r.reflector, e.direction, r.albedo);
#else
  return irradiance;
#endif
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec4 position = imageLoad(gbufferPosition, p), normal = imageLoad(gbufferNormal, p);
  Receiver receiver;
  receiver.position = position.xyz;
  receiver.normal = normal.xyz;
  receiver.face = octDecode(imageLoad(gbufferFace, p).xy);
#if GLOSS
  vec4 albedo = imageLoad(gbufferAlbedo, p), emission = imageLoad(gbufferEmission, p);
  Gloss gloss = glossOf(imageLoad(gbufferSpecular, p), normal.a, albedo.a, emission.a);
  receiver.reflector = reflectorOf(gloss, normal.xyz, normalize(view.eye - position.xyz));
  receiver.albedo = albedo.rgb;
#endif
  vec3 sum = vec3(0.0);
  bool doubt = false;
#if ONE_LIGHT
  if (position.w > 0.0) sum = lightFrom(lights[0], receiver, doubt);
#else
  uint lightCount = position.w > 0.0 ? frame.lightCount : 0u;  // background: nothing to light
  for (uint i = 0u; i < lightCount; ++i) sum += lightFrom(lights[i], receiver, doubt);
#endif
#if GLOSS
  vec3 radiance = emission.rgb + sum;
#else
  vec3 radiance = imageLoad(gbufferEmission, p).rgb + imageLoad(gbufferAlbedo, p).rgb * sum * (1.0 / kPi);
#endif
  direct = vec4(min(radiance, 65504.0), doubt ? 0.0 : 1.0);
}
