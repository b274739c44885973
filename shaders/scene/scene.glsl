// Descriptor set 1: frame, view, lights and the scene's world-space triangles, the same for every pass of a frame.
#ifndef FOVEA_SCENE_GLSL
#define FOVEA_SCENE_GLSL

#include "device/texels.glsl"
#include "scene/octahedral.glsl"
#include "records/scene.h"

const float kPi = 3.14159265358979;

layout(set = 1, binding = 0) uniform FrameUniform { FrameBlock frame; };
layout(set = 1, binding = 1) uniform ViewUniform { ViewBlock view; };
layout(set = 1, binding = 2) uniform LightUniform { LightRecord lights[kMaxLights]; };

layout(set = 1, binding = 3) LARGE_TEXELS(uvec4, sceneTriangles);     // xyz: vertices, w: material | object << 16
layout(set = 1, binding = 4) LARGE_TEXELS(vec4, scenePositions);      // xyz world
layout(set = 1, binding = 5) LARGE_TEXELS(vec4, sceneAttributes);     // xy: octahedral normal, zw: uv
layout(set = 1, binding = 6) LARGE_TEXELS(vec4, sceneMaterials);      // MaterialRecord
layout(set = 1, binding = 7) uniform sampler2DArray sceneTextures;      // pages of 8-bit texels as stored

layout(set = 1, binding = 8) LARGE_TEXELS(vec4, sceneObjects);        // ObjectRecord

layout(set = 1, binding = 9) LARGE_TEXELS(vec4, scenePrevious);       // xyz world, last frame, vertices that may move
layout(set = 1, binding = 10) uniform sampler2D sceneEnvironment;       // equirectangular map, one texel if there is none

// Diagonal of the scene's bounds, m; above 0.
float diagonal() { return max(distance(frame.boundsMin, frame.boundsMax), 1e-30); }

// ---- Geometry ----------------------------------------------------------------------------------------------------

uvec4 sceneTriangle(uint triangle) { return texelOf(sceneTriangles, int(triangle)); }
vec3 scenePosition(uint vertex) { return texelOf(scenePositions, int(vertex)).xyz; }
vec3 scenePreviousPosition(uint vertex) {  // in the previous frame
  if (vertex < frame.firstMovingVertex) return scenePosition(vertex);
  return texelOf(scenePrevious, int(vertex - frame.firstMovingVertex)).xyz;
}
vec3 sceneNormal(uint vertex) { return octDecode(texelOf(sceneAttributes, int(vertex)).xy); }
vec2 sceneUv(uint vertex) { return texelOf(sceneAttributes, int(vertex)).zw; }
uint materialOf(uvec4 triangle) { return triangle.w & 0xffffu; }
uint objectOf(uvec4 triangle) { return triangle.w >> 16; }

// ---- Objects -----------------------------------------------------------------------------------------------------

// The coordinates of a point in an object's own space (VplState.localPosition) stay valid while the object moves.
const int kObjectTexels = 10;

mat4x3 objectRows(uint object, int row) {
  int i = int(object) * kObjectTexels + row;
  return transpose(mat3x4(texelOf(sceneObjects, i), texelOf(sceneObjects, i + 1), texelOf(sceneObjects, i + 2)));
}
mat4x3 objectTransform(uint object) { return objectRows(object, 0); }
mat4x3 previousObjectTransform(uint object) { return objectRows(object, 3); }
mat4x3 inverseObjectTransform(uint object) { return objectRows(object, 6); }
bool objectVisible(uint object) { return texelOf(sceneObjects, int(object) * kObjectTexels + 9).x > 0.5; }
bool objectWasVisible(uint object) { return texelOf(sceneObjects, int(object) * kObjectTexels + 9).y > 0.5; }

// The vertices of the object move individually (morph targets, joints), so a point keeps its place
// in a triangle instead.
bool objectDeforms(uint object) { return texelOf(sceneObjects, int(object) * kObjectTexels + 9).z > 0.5; }

vec3 fromObject(uint object, vec3 position) { return objectTransform(object) * vec4(position, 1.0); }
vec3 toObject(uint object, vec3 position) { return inverseObjectTransform(object) * vec4(position, 1.0); }
// Unit normals, also for non-uniform scales.
vec3 normalFromObject(uint object, vec3 n) { return normalize(transpose(mat3(inverseObjectTransform(object))) * n); }
vec3 normalToObject(uint object, vec3 n) { return normalize(transpose(mat3(objectTransform(object))) * n); }

// ---- Points of surfaces that deform -------------------------------------------------------------------------------

// A point keeps its place in a triangle of those used for voxels: the triangle's number past frame.firstMovingTriangle
// (exact as a float below 2^24) and the weights of its second and third vertex. A direction keeps its components
// along the triangle's axes.

// The point of the triangle that is nearest to `position` (Ericson 2005, 5.1.5).
vec3 attach(uint triangle, vec3 position) {
  uvec4 t = sceneTriangle(frame.firstMovingTriangle + triangle);
  vec3 a = scenePosition(t.x), ab = scenePosition(t.y) - a, ac = scenePosition(t.z) - a, ap = position - a;
  float d1 = dot(ab, ap), d2 = dot(ac, ap), bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac);
  float area = bb * cc - bc * bc;
  float v = area > 0.0 ? (cc * d1 - bc * d2) / area : 0.0, w = area > 0.0 ? (bb * d2 - bc * d1) / area : 0.0;
  if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) return vec3(triangle, v, w);
  // The nearest point is on the nearest edge.
  float onB = clamp(d1 / max(bb, 1e-30), 0.0, 1.0), onC = clamp(d2 / max(cc, 1e-30), 0.0, 1.0);
  vec3 bp = ap - ab, edge = ac - ab;
  float onEdge = clamp(dot(edge, bp) / max(dot(edge, edge), 1e-30), 0.0, 1.0);
  vec3 toB = ap - onB * ab, toC = ap - onC * ac, toEdge = bp - onEdge * edge;
  float b2 = dot(toB, toB), c2 = dot(toC, toC), e2 = dot(toEdge, toEdge);
  if (b2 <= c2 && b2 <= e2) return vec3(triangle, onB, 0.0);
  return c2 <= e2 ? vec3(triangle, 0.0, onC) : vec3(triangle, 1.0 - onEdge, onEdge);
}

vec3 attachedPosition(vec3 place) {
  uvec4 t = sceneTriangle(frame.firstMovingTriangle + uint(place.x));
  vec3 a = scenePosition(t.x);
  return a + place.y * (scenePosition(t.y) - a) + place.z * (scenePosition(t.z) - a);
}

// Unit columns: along the first edge, across it in the plane, and the normal.
mat3 triangleAxes(uint triangle) {
  uvec4 t = sceneTriangle(frame.firstMovingTriangle + triangle);
  vec3 a = scenePosition(t.x), edge = scenePosition(t.y) - a, n = cross(edge, scenePosition(t.z) - a);
  if (!(dot(n, n) > 0.0)) return mat3(1.0);
  edge = normalize(edge);
  n = normalize(n);
  return mat3(edge, cross(n, edge), n);
}

// ---- Materials ---------------------------------------------------------------------------------------------------

// Texels of a material and of its textures in it.
const int kMaterialTexels = 8, kColorTexture = 2, kEmissionTexture = 5;

struct Material {
  vec3 baseColor;        // times (1 - metallic): diffuse reflectance where the texture is white
  float alpha;
  vec3 emission;         // W/(sr m^2)
  float alphaCutoff;     // 0: opaque; below 0: lets light through whatever its alpha
  bool doubleSided;
};

struct SurfacePoint {    // a material looked up at a point
  vec3 reflectance;
  vec3 emission;
};

Material loadMaterial(uint material) {
  int first = int(material) * kMaterialTexels;
  vec4 color = texelOf(sceneMaterials, first);
  vec4 emission = texelOf(sceneMaterials, first + 1);
  uint flags = uint(texelOf(sceneMaterials, first + kColorTexture).w);
  return Material(color.rgb, color.a, emission.rgb, emission.a, (flags & kMaterialDoubleSided) != 0u);
}

// Divides floats, and twice because the first quotient may be rounded. A CPU device divides integers one
// lane at a time.
int wrapTexel(int i, int size, uint wrap) {
  if (wrap == kWrapClamp) return clamp(i, 0, size - 1);
  int period = wrap == kWrapMirror ? 2 * size : size;
  float inverse = 1.0 / float(period);
  int r = i - period * int(floor((float(i) + 0.5) * inverse));
  r -= period * int(floor((float(r) + 0.5) * inverse));
  return r < size ? r : period - 1 - r;
}

// Linear light from an 8-bit sRGB colour, to within 4e-7: a polynomial in the square root, fitted to the
// codes. The decoders of sRGB image formats may be inaccurate (lavapipe's by 1% in the dark), and a table
// costs one look-up per channel.
vec3 srgbToLinear(vec3 code) {
  vec3 s = sqrt(code);
  vec3 power = ((0.009480046 * s - 0.07493101) * s + 0.79743385) * s + 0.17218539;
  power = (((power * s + 0.06789335) * s + 0.026256947) * s + 0.00088151894) * s + 0.00079976703;
  return mix(power, code * (1.0 / 12.92), lessThanEqual(code, vec3(0.04045)));
}

vec4 sceneTexel(ivec3 p, bool linear) {
  vec4 texel = texelFetch(sceneTextures, p, 0);
  return vec4(mix(srgbToLinear(texel.rgb), texel.rgb, bvec3(linear)), texel.a);
}

// Bilinear filtering at LOD 0, with texels decoded before they are filtered; the same as scene::sampleTexture.
// `texel` is the first of the three texels that describe the texture.
vec4 sampleSceneTexture(int texel, vec2 uv) {
  vec4 place = texelOf(sceneMaterials, texel);
  if (place.x < 0.0) return vec4(1.0);
  vec4 extent = texelOf(sceneMaterials, texel + 1);
  vec4 axes = texelOf(sceneMaterials, texel + 2);
  vec2 p = (axes.xy * uv.x + axes.zw * uv.y + extent.zw) * extent.xy - 0.5;
  p = mix(clamp(p, vec2(-1e9), vec2(1e9)), vec2(0.0), isnan(p));
  vec2 base = floor(p);
  vec2 f = p - base;
  ivec2 size = ivec2(extent.xy), i = ivec2(base), corner = ivec2(place.yz);
  uint flags = uint(place.w), wrapU = flags & 3u, wrapV = flags >> 2 & 3u;
  bool linear = (flags & kTextureLinear) != 0u;
  ivec2 a = corner + ivec2(wrapTexel(i.x, size.x, wrapU), wrapTexel(i.y, size.y, wrapV));
  ivec2 b = corner + ivec2(wrapTexel(i.x + 1, size.x, wrapU), wrapTexel(i.y + 1, size.y, wrapV));
  int page = int(place.x);
  vec4 top = mix(sceneTexel(ivec3(a, page), linear), sceneTexel(ivec3(b.x, a.y, page), linear), f.x);
  vec4 bottom = mix(sceneTexel(ivec3(a.x, b.y, page), linear), sceneTexel(ivec3(b, page), linear), f.x);
  return mix(top, bottom, f.y);
}

// rgb: diffuse reflectance, a: alpha.
vec4 materialReflectance(uint material, vec2 uv) {
  int first = int(material) * kMaterialTexels;
  return texelOf(sceneMaterials, first) * sampleSceneTexture(first + kColorTexture, uv);
}

vec3 materialEmission(uint material, vec2 uv) {
  int first = int(material) * kMaterialTexels;
  vec3 emission = texelOf(sceneMaterials, first + 1).rgb;
  // Few surfaces emit.
  if (emission != vec3(0.0))
    emission *= sampleSceneTexture(first + kEmissionTexture, uv).rgb;
  return emission;
}

SurfacePoint surfaceAt(uint material, vec2 uv) {
  return SurfacePoint(materialReflectance(material, uv).rgb, materialEmission(material, uv));
}

// ---- Environment -------------------------------------------------------------------------------------------------

bool hasEnvironmentMap() { return textureSize(sceneEnvironment, 0).x > 1; }

// Radiance of the environment map from a direction, which is unit; the same as scene::EnvironmentMap::radiance.
vec3 environmentRadiance(vec3 direction) {
  ivec2 size = textureSize(sceneEnvironment, 0);
  float around = (atan(direction.x, -direction.z) + frame.environmentTurn) / (2.0 * kPi) + 0.5;
  vec2 p = vec2(fract(around), acos(clamp(direction.y, -1.0, 1.0)) / kPi) * vec2(size) - 0.5;
  vec2 base = floor(p), f = p - base;
  ivec2 first = ivec2(base);
  int left = (first.x + size.x) % size.x, right = (first.x + 1) % size.x;
  int top = clamp(first.y, 0, size.y - 1), bottom = clamp(first.y + 1, 0, size.y - 1);
  vec3 upper = mix(texelFetch(sceneEnvironment, ivec2(left, top), 0).rgb,
                   texelFetch(sceneEnvironment, ivec2(right, top), 0).rgb, f.x);
  vec3 lower = mix(texelFetch(sceneEnvironment, ivec2(left, bottom), 0).rgb,
                   texelFetch(sceneEnvironment, ivec2(right, bottom), 0).rgb, f.x);
  return mix(upper, lower, f.y);
}

// ---- Lights ------------------------------------------------------------------------------------------------------

struct LightSample {
  vec3 irradiance;  // on a surface that faces the light, W/m^2, without occlusion
  vec3 direction;   // unit, to the light
  float distance;   // m; directional: kFarAway
};

const float kFarAway = 1e30;

// The same as scene::sampleLight (framework/scene/lights.h).
LightSample sampleLight(LightRecord light, vec3 position) {
  if (light.type == kLightDirectional) return LightSample(light.intensity, -light.direction, kFarAway);
  vec3 d = light.position - position;
  float d2 = max(dot(d, d), 1e-12);
  float distance = sqrt(d2);
  vec3 direction = d / distance;
  float falloff = 1.0 / d2;
  if (light.type == kLightSpot) {
    float s = clamp((dot(-direction, light.direction) - light.cosOuter) * light.coneScale, 0.0, 1.0);
    falloff *= s * s;
  }
  if (light.range > 0.0) {  // the window that KHR_lights_punctual recommends
    float x = distance / light.range;
    falloff *= clamp(1.0 - x * x * x * x, 0.0, 1.0);
  }
  return LightSample(light.intensity * falloff, direction, distance);
}

#endif
