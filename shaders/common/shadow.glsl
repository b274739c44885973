// Shadow maps of the scene's lights: how a light sees the scene, and whether a point is lit.
// Needs common/scene.glsl. The views are made by shadow-map/views.comp.
#ifndef FOVEA_SHADOW_GLSL
#define FOVEA_SHADOW_GLSL

const uint kMaxShadowLayers = 384u;  // 64 lights, six faces each

// How one layer looks at the scene. Depth is reversed (1: nearest to the light, 0: farthest, and where nothing is hit):
// with near / z a 32-bit float has the same relative precision at every distance, and no far plane is needed.
struct ShadowView {
  mat4 worldToClip;
  vec4 right;  // xyz: unit, image x axis in the world; w: width of a texel where clip.w = 1, m
  vec4 up;     // xyz: unit, image y axis; w: height of a texel where clip.w = 1, m
  vec4 bias;   // x: absolute, y: relative, in units of depth: rounding only, slopes are dealt with in lightVisibility
};

// Face of the cube around a point light: +X -X +Y -Y +Z -Z.
uint shadowFace(vec3 fromLight) {
  vec3 a = abs(fromLight);
  if (a.x >= a.y && a.x >= a.z) return fromLight.x >= 0.0 ? 0u : 1u;
  if (a.y >= a.z) return fromLight.y >= 0.0 ? 2u : 3u;
  return fromLight.z >= 0.0 ? 4u : 5u;
}

// Shaders that look up shadows define SHADOW_BINDING, the first of three free bindings of set 0, and have an input port `maps`
// of bundle `shadow-maps`.
#ifdef SHADOW_BINDING
#ifndef SHADOW_PCF
#define SHADOW_PCF 1
#endif

layout(set = 0, binding = SHADOW_BINDING) uniform texture2DArray mapsDepth;
layout(set = 0, binding = SHADOW_BINDING + 1, std140) uniform MapsViews { ShadowView view[kMaxShadowLayers]; } mapsViews;
layout(set = 0, binding = SHADOW_BINDING + 2) uniform sampler nearestClamp;

// Share of the light that reaches `position` (world space), a point of a surface whose face has the unit normal `face` on
// the side that is looked at. firstLayer: firstShadowLayer(light).
//
// A texel stores the depth at its centre; on a slope that differs from the depth at the receiver, at most by the slope times
// the distance r to the farthest centre looked at. Raised along its normal by
//   h = r (|n.x| texel.x + |n.y| texel.y),   n in the axes of the map,
// the receiver lies in front of its own plane at each of these centres: no acne, however steep, and h never exceeds
// r sqrt(2) texels, so that shadows stay attached to what throws them.
float lightVisibility(Light light, uint firstLayer, vec3 position, vec3 face) {
  uint layer = firstLayer;
  if (uint(light.position.w) == kLightPoint) layer += shadowFace(position - light.position.xyz);
  mat4 worldToClip = mapsViews.view[layer].worldToClip;
  vec4 right = mapsViews.view[layer].right, up = mapsViews.view[layer].up, bias = mapsViews.view[layer].bias;

  const float reach = SHADOW_PCF != 0 ? 2.0 : 0.5;  // texels, along each axis
  float w = (worldToClip * vec4(position, 1.0)).w;
  float raise = reach * w * (abs(dot(face, right.xyz)) * right.w + abs(dot(face, up.xyz)) * up.w);
  vec4 clip = worldToClip * vec4(position + raise * face, 1.0);
  if (clip.w <= 0.0) return 1.0;  // behind a spot light
  float depth = clip.z / clip.w;
  depth += bias.x + bias.y * depth;
  ivec2 size = textureSize(mapsDepth, 0).xy;
  vec2 p = (0.5 * clip.xy / clip.w + 0.5) * vec2(size);
#if SHADOW_PCF
  // 3x3 box over bilinear comparisons: 4x4 texels, the outer ones weighted by the fraction, gathered in four quads.
  vec2 base = floor(p - 0.5);
  vec2 f = p - 0.5 - base;
  vec2 texelSize = 1.0 / vec2(size);
  float lit = 0.0;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      vec2 corner = (base + 2.0 * vec2(x, y)) * texelSize;  // between the four texels
      vec4 nearest = textureGather(sampler2DArray(mapsDepth, nearestClamp), vec3(corner, layer));
      vec2 u = x == 0 ? vec2(1.0 - f.x, 1.0) : vec2(1.0, f.x), v = y == 0 ? vec2(1.0 - f.y, 1.0) : vec2(1.0, f.y);
      lit += dot(vec4(lessThanEqual(nearest, vec4(depth))), vec4(u.x * v.y, u.y * v.y, u.y * v.x, u.x * v.x));
    }
  return lit * (1.0 / 9.0);
#else
  ivec2 texel = clamp(ivec2(floor(p)), ivec2(0), size - 1);
  return depth >= texelFetch(mapsDepth, ivec3(texel, layer), 0).r ? 1.0 : 0.0;
#endif
}
#endif  // SHADOW_BINDING

#endif
