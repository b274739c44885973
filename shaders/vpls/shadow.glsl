// Shadow maps of the scene's lights: how a light sees the scene, and whether a point is lit. Pass shadow-map makes
// them.
//
// Define: SHADOW_MAPS, to look up shadows; with it SHADOW_FILTER, 0 for one comparison, 1 (unless it is defined) for
// bilinear filtering between four, 2 for the average of 3 x 3 bilinear ones; and SHADOW_LAYER, if there is only one
// layer, its number. A CPU device loads indexed data lane by lane.
//
// Needs scene/scene.glsl; with SHADOW_MAPS also the port `maps` of bundle `shadow-maps`.
#ifndef FOVEA_SHADOW_GLSL
#define FOVEA_SHADOW_GLSL

#include "records/shadow.h"

// Face of the cube around a point light that a vector from the light meets: +X -X +Y -Y +Z -Z.
uint shadowFace(vec3 fromLight) {
  vec3 a = abs(fromLight);
  if (a.x >= a.y && a.x >= a.z) return fromLight.x >= 0.0 ? 0u : 1u;
  if (a.y >= a.z) return fromLight.y >= 0.0 ? 2u : 3u;
  return fromLight.z >= 0.0 ? 4u : 5u;
}

#ifdef SHADOW_MAPS
#ifndef SHADOW_FILTER
#define SHADOW_FILTER 1
#endif

uniform texture2DArray mapsDepth;
layout(std140) uniform MapsViews { ShadowView view[kMaxShadowLayers]; } mapsViews;
uniform sampler nearestClamp;

const float kSteepest = 32.0;  // slope against the map up to which planes are followed, 88 degrees

// A surface as a shadow map sees it.
struct ShadowReceiver {
  uint layer;
  vec2 size;    // of the map, texels
  vec2 texel;   // position of the receiver
  float depth;  // depth of its plane there,
  vec2 slope;   // and its change per texel
};

// Which of the four texels around `corner` (a whole number of texels) see the receiver's plane at their centres, in
// the order of textureGather: (-, +) (+, +) (+, -) (-, -).
vec4 litTexels(ShadowReceiver r, vec2 corner) {
  vec4 nearest = textureGather(sampler2DArray(mapsDepth, nearestClamp), vec3(corner / r.size, r.layer));
  vec2 o = corner - r.texel;
  vec4 plane = r.depth + r.slope.x * (o.x + vec4(-0.5, 0.5, 0.5, -0.5)) +
               r.slope.y * (o.y + vec4(0.5, 0.5, -0.5, -0.5));
  return vec4(lessThanEqual(nearest, plane));
}

// Share of the light that reaches `position` (world space, m), a point of a surface whose geometric normal `face` is
// unit and on the visible side. firstLayer: light.firstShadowLayer. A face turned away from the light receives nothing.
//
// A texel holds the depth at its centre, so it is compared with the depth of the receiver's plane at that centre,
// not at the receiver. This avoids acne at any angle of the light, without an offset that would detach shadows
// from their casters. Depth is linear over a plane in both projections: with n = face in the axes of the map and
// t the texel's size, a step of one texel along x changes it by   n.x t.x / (n.z range)   or   n.x t.x near / (n
// . (position - eye)).
float lightVisibility(LightRecord light, uint firstLayer, vec3 position, vec3 face) {
  bool directional = light.type == kLightDirectional;
  vec3 fromLight = directional ? light.direction : position - light.position;
  float facing = dot(face, fromLight);
  if (facing >= 0.0) return 0.0;
  ShadowReceiver r;
#ifdef SHADOW_LAYER
  r.layer = SHADOW_LAYER;
#else
  r.layer = firstLayer + (light.type == kLightPoint ? shadowFace(fromLight) : 0u);
#endif
  ShadowView seen = mapsViews.view[r.layer];
  vec4 clip = seen.worldToClip * vec4(position, 1.0);
  if (clip.w <= 0.0) return 1.0;  // behind a spot light
  r.size = vec2(textureSize(mapsDepth, 0).xy);
  r.texel = (0.5 * clip.xy / clip.w + 0.5) * r.size;
  vec2 texel = vec2(dot(face, seen.right) * seen.texelWidth, dot(face, seen.up) * seen.texelHeight);
  r.slope = seen.depthScale * texel / facing;
  // A plane seen edge-on would extend beyond everything in front of it within one texel.
  float steepest = kSteepest * seen.depthScale * max(seen.texelWidth, seen.texelHeight) / clip.w;
  r.slope *= min(1.0, steepest / max(length(r.slope), 1e-30));
  // The third of a texel's slope allows for neighbours of the receiver's face that are tilted against it.
  r.depth = clip.z / clip.w;
  r.depth += seen.bias + seen.relativeBias * r.depth + 0.35 * (abs(r.slope.x) + abs(r.slope.y));
#if SHADOW_FILTER == 0
  vec2 centre = floor(r.texel) + 0.5;
  float nearest = texelFetch(mapsDepth, ivec3(clamp(ivec2(centre), ivec2(0), ivec2(r.size) - 1), r.layer), 0).r;
  return nearest <= r.depth + dot(r.slope, centre - r.texel) ? 1.0 : 0.0;
#else
  vec2 corner = floor(r.texel + 0.5);
  vec2 f = r.texel + 0.5 - corner;
#if SHADOW_FILTER == 1
  vec2 u = vec2(1.0 - f.x, f.x), v = vec2(1.0 - f.y, f.y);
  return dot(litTexels(r, corner), vec4(u.x * v.y, u.y * v.y, u.y * v.x, u.x * v.x));
#else
  float lit = 0.0;  // over 4x4 texels, the outer ones weighted by the fraction
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      vec2 u = x == 0 ? vec2(1.0 - f.x, 1.0) : vec2(1.0, f.x), v = y == 0 ? vec2(1.0 - f.y, 1.0) : vec2(1.0, f.y);
      lit += dot(litTexels(r, corner + 2.0 * vec2(x, y) - 1.0), vec4(u.x * v.y, u.y * v.y, u.y * v.x, u.x * v.x));
    }
  return lit * (1.0 / 9.0);
#endif
#endif
}
#endif  // SHADOW_MAPS

#endif
