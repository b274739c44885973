// L = emission + rho / pi * sum over the lights of E_l * visibility_l. Defines: SHADOW_FILTER; ONE_LIGHT, 1 if there
// is one light, 2 if that has one map, 0 for any number of lights. A single light is read from a constant place,
// because a CPU device loads indexed data lane by lane. GLOSS 0/1 (receiver.glsl).
#include "direct/receiver.glsl"
#define SHADOW_MAPS 1
#if ONE_LIGHT == 2
#define SHADOW_LAYER 0u
#endif
#include "vpls/shadow.glsl"

layout(location = 0) out vec4 direct;

// doubt: set where the texels of the map disagree.
vec3 lightFrom(LightRecord light, Receiver r, inout bool doubt) {
  LightSample e = sampleLight(light, r.place.xyz);
  if (dot(r.normal, e.direction) <= 0.0 || e.irradiance == vec3(0.0)) return vec3(0.0);
  float visibility = lightVisibility(light, light.firstShadowLayer, r.place.xyz, r.face);
  doubt = doubt || (visibility > 0.0 && visibility < 1.0);
  e.irradiance *= visibility;
  return response(r, e);
}

void main() {
  Receiver receiver = receiverAt(ivec2(gl_FragCoord.xy));
  vec3 sum = vec3(0.0);
  bool doubt = false;
#if ONE_LIGHT
  if (receiver.place.w > 0.0) sum = lightFrom(lights[0], receiver, doubt);
#else
  uint lightCount = receiver.place.w > 0.0 ? frame.lightCount : 0u;  // background: nothing to light
  for (uint i = 0u; i < lightCount; ++i) sum += lightFrom(lights[i], receiver, doubt);
#endif
  direct = vec4(radianceOf(receiver, sum), doubt ? 0.0 : 1.0);
}
