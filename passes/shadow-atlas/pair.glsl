// One pair of a VPL and a triangle, as draw.comp, masked.comp and large.comp rasterise it. Defines: MASKED, for
// triangles with an alpha mask; STATIC_MAPS, to draw to the maps of static geometry; MOVER_SLACK, to draw what moves as
// if it were farther away.
#ifndef FOVEA_SHADOW_ATLAS_PAIR_GLSL
#define FOVEA_SHADOW_ATLAS_PAIR_GLSL

#include "vpls/paraboloid.glsl"
#include "materials/passage.glsl"
#include "shadow-atlas/project.glsl"
#include "shadow-atlas/step.glsl"
#include "shadow-atlas/triangles.glsl"

#ifdef MASKED
const bool kMasked = true;
#else
const bool kMasked = false;
#endif

// Those of the round.
layout(std140) uniform ViewsBlock { VplView list[kRound]; } views;
#ifdef STATIC_MAPS
layout(r32ui) uniform uimage2DArray staticMaps;
#define atlas staticMaps
#else
layout(r32ui) uniform uimage2DArray atlas;
#endif

struct Pair {
  TexelBox box;
  RayTest test;
  ivec3 origin;  // origin of the VPL's map in the atlas
  uint material, triangle;
  vec2 uvA, uvB, uvC;
  vec3 alphas;  // of the vertex colours
#ifdef MOVER_SLACK
  float slack;  // m
#endif
};

#ifdef MOVER_SLACK
const float kMostSlack = 0.25;  // relative to the distance, so that objects that jump still cast shadows

float wayOf(uint vertex, vec3 position) { return distance(position, scenePreviousPosition(vertex)); }
#endif

// clipped: the triangle may have any size. The slack is the distance that its fastest corner has moved since the
// previous frame, times moverSlack.
Pair pairOf(VplView view, Triangle triangle, uint index, int size, float planeEpsilon, bool clipped
#ifdef MOVER_SLACK
            , float moverSlack
#endif
) {
  Pair pair;
  vec3 a = seenFrom(view, triangle.a), b = seenFrom(view, triangle.b), c = seenFrom(view, triangle.c);
  bool tight;
  pair.box = projectedBox(a, b, c, float(size), tight);
  if (clipped) {
    TexelBox cut = clippedBox(a, b, c, float(size));
    if (!tight) pair.box = cut;
  }
  pair.test = rayTest(view, triangle, planeEpsilon);
  pair.origin = atlasTexel(view.slot, ivec2(0), atlasLayout(imageSize(atlas)));
  pair.material = triangle.material;
  pair.triangle = index;
#ifdef MOVER_SLACK
  pair.slack = moverSlack * max(max(wayOf(triangle.vertices.x, triangle.a), wayOf(triangle.vertices.y, triangle.b)),
                                wayOf(triangle.vertices.z, triangle.c));
#endif
#ifdef MASKED
  pair.uvA = texelOf(sceneAttributes, int(triangle.vertices.x)).zw;
  pair.uvB = texelOf(sceneAttributes, int(triangle.vertices.y)).zw;
  pair.uvC = texelOf(sceneAttributes, int(triangle.vertices.z)).zw;
  pair.alphas = vec3(sceneAlpha(triangle.vertices.x), sceneAlpha(triangle.vertices.y), sceneAlpha(triangle.vertices.z));
#endif
  return pair;
}

void rasterise(Pair pair, vec2 texel, bool inside, float toMap) {
  vec3 weights;
  float distance_ = hitDistance(pair.test, (texel + 0.5) * toMap - 1.0, weights);
  bool hit = inside && distance_ > 0.0;
#ifdef MASKED
  weights /= weights.x + weights.y + weights.z;
  // What lets a part of the light through does so at some texels, the same ones whenever the map is drawn.
  uvec3 origin = uvec3(pair.origin);
  uint key = hashCombine(hashCombine(origin.x << 16 | origin.y, origin.z), pair.triangle);
  float chance = passageChance(key, uvec2(texel), 0u);
  vec2 uv = weights.x * pair.uvC + weights.y * pair.uvA + weights.z * pair.uvB;
  float alpha = dot(weights, vec3(pair.alphas.z, pair.alphas.x, pair.alphas.y));
  hit = hit && stops(pair.material, uv, alpha, kMeanCosine, chance);
#endif
#ifdef MOVER_SLACK
  distance_ += min(pair.slack, kMostSlack * distance_);
#endif
  if (hit) imageAtomicMin(atlas, pair.origin + ivec3(texel, 0), floatBitsToUint(distance_));
}

// Rasterises all texels of a pair that covers few, one after the other.
void drawBox(Pair pair, int size) {
  float toMap = 2.0 / float(size);
  vec2 texel = pair.box.lo;
  while (texel.y <= pair.box.hi.y) {
    rasterise(pair, texel, true, toMap);
    texel.x += 1.0;
    bool next = texel.x > pair.box.hi.x;
    texel = next ? vec2(pair.box.lo.x, texel.y + 1.0) : texel;
  }
}

#endif
