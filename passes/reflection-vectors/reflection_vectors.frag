// Where what a smooth surface reflects was seen in the previous frame. A mirror shows its image behind the surface, in
// the direction of the eye's ray, and as far behind it as the thing is before it if the mirror is flat. A convex one
// brings it nearer, by the mirror equation 1 / image = 1 / thing + 2 * curvature. This point moves on the screen as the
// reflection does (Tokuyoshi, "Fast temporal reprojection without motion vectors", JCGT 2015).
#include "screen/history.glsl"
#include "scene/motion.glsl"
#include "screen/same_surface.glsl"
#include "screen/gbuffer.glsl"

SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
layout(r32ui) uniform readonly uimage2D gbufferId;
layout(r32ui) uniform readonly uimage2D gbufferTriangle;
SURFACES(previous, previousAt)
layout(rgba16f) uniform readonly image2D previousNormal;
layout(r32ui) uniform readonly uimage2D surface;
layout(r32f) uniform readonly image2D distances;
layout(location = 0) out uint origin;

layout(push_constant) uniform Constants {
  uint frameIndex;
  float planeTolerance;  // relative to the distance from the eye
  float leastCosine;
};

const uint kReflectionStream = 0x7265666cu;
const int kApart = 2;  // pixels over which the curvature is measured

// Mean curvature where it is convex, 1/m, by the normals of the surface around the pixel.
float curvatureAt(ivec2 p, vec4 position, vec3 normal, ivec2 size) {
  float turned = 0.0, way = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 d = kApart * (1 - (i & 2)) * ivec2(i & 1, 1 - (i & 1)), q = clamp(p + d, ivec2(0), size - 1);
    vec4 other = surfaceAt(q);
    vec3 its = imageLoad(gbufferNormal, q).xyz, to = other.xyz - position.xyz;
    if (!sameSurface(position.xyz, normal, normal, other, its, planeTolerance * position.w, leastCosine)) continue;
    turned += dot(its - normal, to);
    way += dot(to, to);
  }
  return way > 0.0 ? max(turned / way, 0.0) : 0.0;
}

uint originOf(ivec2 p, float thing, uint otherwise) {
  ivec2 size = imageSize(gbufferDistance);
  vec4 position = surfaceAt(p);
  vec3 normal = imageLoad(gbufferNormal, p).xyz;
  uint id = imageLoad(gbufferId, p).r, triangle = imageLoad(gbufferTriangle, p).r;
  Motion motion = motionOf(position.xyz, id, triangle);
  float behind = thing / (1.0 + 2.0 * curvatureAt(p, position, normal, size) * thing);
  vec3 image = position.xyz + behind * normalize(position.xyz - view.eye);
  vec4 clip = view.previousWorldToClip * vec4(pointBefore(motion, image), 1.0);
  if (!(clip.w > 0.0)) return otherwise;
  vec2 at = (0.5 * clip.xy / clip.w + 0.5) * vec2(size) - 0.5 - view.jitterStep;  // texel centres at whole numbers
  ivec2 q = oneOfFour(at, randomStream(uint(p.x), frameIndex, kReflectionStream, uint(p.y)));
  ivec2 inside = clamp(q, ivec2(0), size - 1);
  bool same = sameSurface(pointBefore(motion, position.xyz), normal, normal, previousAt(inside),
                          imageLoad(previousNormal, inside).xyz, planeTolerance * position.w, leastCosine);
  return q == inside && same ? packPixel(q) : otherwise;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  origin = imageLoad(surface, p).r;
  float thing = imageLoad(distances, p >> 1).r;
  if (origin != kNone && thing > 0.0) origin = originOf(p, thing, origin);
}
