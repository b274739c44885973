// Chooses pixels around each one that show a similar surface. They are spread over a disc: each has a ring of its own,
// and they turn by the golden section.
#include "screen/history.glsl"
#include "screen/same_surface.glsl"
#include "screen/gbuffer.glsl"

SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(location = 0) out uint sources;

layout(push_constant) uniform Constants {
  uint frameIndex;
  uint seed;
  uint iteration;
  float radius;          // image widths
  float planeTolerance;  // relative to the distance from the eye
  float leastCosine;
};

const uint kNeighbourStream = 0x72656e62u;
const float kTurn = 6.28318531, kGoldenShare = 0.618033989;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), p = ivec2(at.x / NEIGHBOURS, at.y), size = imageSize(gbufferDistance);
  int k = at.x - p.x * NEIGHBOURS;
  uint bits = randomStream(seed, frameIndex, hashCombine(kNeighbourStream, iteration), uint(p.y * size.x + p.x));
  float away = radius * float(size.x) * sqrt((float(k) + uniformFloat(bits)) / float(NEIGHBOURS));
  float angle = kTurn * fract(uniformFloat(hashPcg(bits)) + float(k) * kGoldenShare);
  ivec2 q = p + ivec2(round(away * vec2(cos(angle), sin(angle)))), inside = clamp(q, ivec2(0), size - 1);
  vec4 position = surfaceAt(p);
  vec3 normal = imageLoad(gbufferNormal, p).xyz;
  bool same = q == inside && q != p && position.w > 0.0 &&
              sameSurface(position.xyz, normal, normal, surfaceAt(inside),
                          imageLoad(gbufferNormal, inside).xyz, planeTolerance * position.w, leastCosine);
  sources = same ? packPixel(q) : kNone;
}
