// A texel of pass mirrors. Include after scene/scene.glsl.
#include "materials/gloss.glsl"
#include "scene/octahedral.glsl"
#include "screen/pixel_ray.glsl"
#include "records/mirror.h"

IMAGE(rgba32ui, readonly, uimage2D, mirrors);

struct Mirror {
  bool there;  // if not, nothing is known of it
  uint code;
  float roughness, alpha;
  vec3 normal, face, away, position;  // away: from the eye
  float distance_;                    // from the eye, m
};

Mirror mirrorAt(ivec2 block) {
  uvec4 texel = imageLoad(mirrors, block);
  Mirror m;
  m.there = texel.x != 0u;
  m.code = texel.w & 0xffffu;
  m.roughness = unpackUnorm2x16(texel.w).y;
  m.alpha = ggxAlpha(m.roughness);
  m.normal = octDecode(unpackSnorm2x16(texel.y));
  m.face = octDecode(unpackSnorm2x16(texel.z));
  m.away = normalize(pixelRay(2 * block + ivec2(m.code >> 4 & 7u, m.code >> 7 & 7u)));
  m.distance_ = uintBitsToFloat(texel.x);
  m.position = view.eye + m.distance_ * m.away;
  return m;
}
