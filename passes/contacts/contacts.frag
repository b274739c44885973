// Marks the pixels over whose tangent plane a surface close by rises, so that it may hide light from them.
#include "scene/scene.glsl"
#include "sampling/fovea.glsl"
#include "screen/gbuffer.glsl"

SURFACES(gbuffer, surfaceAt)
layout(rgba16f) uniform readonly image2D gbufferNormal;
uniform samplerBuffer spread;  // x: area, m^2
layout(location = 0) out uvec2 contacts;

layout(push_constant) uniform Constants {
  float foveaRadius;  // image widths
  float reach;        // radii of the smallest disc
  float rise;
  float width;        // image widths
};

const float kRounding = 1e-4;  // least height, relative to the distance from the eye
const ivec2 kAround[8] = ivec2[](ivec2(1, 0), ivec2(0, 1), ivec2(-1, 0), ivec2(0, -1),
                                 ivec2(1, 1), ivec2(-1, 1), ivec2(-1, -1), ivec2(1, -1));

bool rises(vec4 there, vec4 here, vec3 normal, float most) {
  vec3 to = there.xyz - here.xyz;
  float height = dot(to, normal), d2 = dot(to, to);
  return there.w > 0.0 && height > kRounding * here.w && height * height > rise * rise * d2 && d2 < most * most;
}

// Looks in four directions, alternately along the axes and between them, at distances that double.
bool inContact(ivec2 p, ivec2 size, vec4 here, vec3 normal) {
  float most = reach * sqrt(texelFetch(spread, 0).x / kPi);
  int widest = int(width * float(size.x));
  bool found = false;
  for (int distance_ = 1, first = 0; distance_ <= widest && !found; distance_ *= 2, first ^= 4)
    for (int k = 0; k < 4; ++k) {
      ivec2 q = clamp(p + distance_ * kAround[first + k], ivec2(0), size - 1);
      found = found || rises(surfaceAt(q), here, normal, most);
    }
  return found;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy), size = imageSize(gbufferDistance);
  Fovea fovea = makeFovea(view.gaze, vec2(size), foveaRadius);
  contacts = uvec2(0);
  if (distance(gl_FragCoord.xy, fovea.centre) > fovea.radius) return;
  vec4 here = surfaceAt(p);
  vec3 normal = normalize(imageLoad(gbufferNormal, p).xyz);
  if (here.w > 0.0 && inContact(p, size, here, normal))
    contacts = uvec2(floatBitsToUint(here.w), packSnorm2x16(octEncode(normal)));
}
