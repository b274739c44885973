// The light of probes at each pixel.
#include "probes/light.glsl"
#include "scene/scene.glsl"
#include "screen/gbuffer.glsl"

SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(std140) uniform RaysGridBlock { ProbeGrid value; } raysGrid;
layout(location = 0) out vec4 irradiance;

layout(push_constant) uniform Constants { float bias; };

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec4 position = surfaceAt(p);
  vec3 normal = imageLoad(gbufferNormal, p).xyz;
  vec3 light = vec3(0.0);
  if (position.w > 0.0)
    light = probeLight(raysGrid.value, bias, position.xyz, normalize(normal), normalize(view.eye - position.xyz));
  irradiance = vec4(min(light, 65504.0), 1.0);
}
