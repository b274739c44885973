// The light that the sample of each pixel's reservoir stands for.
#include "sampling/reservoir.glsl"
#include "screen/gbuffer.glsl"

SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
LARGE_TEXELS(vec4, reservoirs);
layout(location = 0) out vec4 irradiance;

const float kPi = 3.14159265358979;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec4 position = surfaceAt(p);
  irradiance = vec4(0.0);
  if (!(position.w > 0.0)) return;
  VisiblePoint here = VisiblePoint(position.xyz, normalize(imageLoad(gbufferNormal, p).xyz));
  Reservoir r = loadReservoir(reservoirs, p.y * imageSize(gbufferDistance).x + p.x);
  if (r.weight > 0.0) irradiance.rgb = min(r.radiance * (r.weight * cosineTowards(here, r) / kPi), 65504.0);
}
