// The bindings of descriptor set 1, and how they are read. The host implements the same functions
// (framework/scene/host/host_scene.h), so that what is written on top of them serves both.
#ifndef FOVEA_TABLES_GLSL
#define FOVEA_TABLES_GLSL

#include "device/language.glsl"
#include "device/texels.glsl"
#include "records/scene.h"
#include "scene/octahedral.glsl"

layout(set = 1, binding = 0) uniform FrameUniform { FrameBlock frame; };            // what belongs to the frame
layout(set = 1, binding = 1) uniform ViewUniform { ViewBlock view; };               // what belongs to the eye
layout(set = 1, binding = 2) uniform LightUniform { LightRecord lights[kMaxLights]; };  // frame.lightCount of them

SCENE_TEXELS(3, uvec4, sceneTriangles);     // xyz: vertices, w: material | object << 16
SCENE_TEXELS(4, vec4, scenePositions);      // xyz: world space, m, w: alpha of the vertex colour
SCENE_TEXELS(5, vec4, sceneAttributes);     // xy: octahedral normal, zw: uv
SCENE_TEXELS(6, vec4, sceneMaterials);      // MaterialRecord
layout(set = 1, binding = 7) uniform sampler2DArray sceneTextures;      // pages of 8-bit texels as the files have them
SCENE_TEXELS(8, vec4, sceneObjects);        // ObjectRecord
SCENE_TEXELS(9, vec4, scenePrevious);       // xyz: of the previous frame, of vertices that may move
layout(set = 1, binding = 10) uniform sampler2D sceneEnvironment;       // equirectangular map; one texel: there is none

// ---- Geometry ----------------------------------------------------------------------------------------------------

// A triangle (xyz: vertices, w: material | object << 16), and of a vertex the position in this frame and in the
// previous one (world space, m), the shading normal (world space, unit), the texture coordinates and the alpha of the
// colour, 1 if it has none.
uvec4 sceneTriangle(uint triangle) { return texelOf(sceneTriangles, int(triangle)); }
vec3 scenePosition(uint vertex) { return texelOf(scenePositions, int(vertex)).xyz; }
vec3 scenePreviousPosition(uint vertex) {
  if (vertex < frame.firstMovingVertex) return scenePosition(vertex);
  return texelOf(scenePrevious, int(vertex - frame.firstMovingVertex)).xyz;
}
vec3 sceneNormal(uint vertex) { return octDecode(texelOf(sceneAttributes, int(vertex)).xy); }
vec2 sceneUv(uint vertex) { return texelOf(sceneAttributes, int(vertex)).zw; }
float sceneAlpha(uint vertex) { return texelOf(scenePositions, int(vertex)).w; }

// ---- Textures ----------------------------------------------------------------------------------------------------

// Linear light from an sRGB colour of 8 bits, both from 0 to 1, to within 4e-7: a polynomial in the square root, fitted
// to the 256 codes. The decoders of sRGB image formats may be inaccurate (lavapipe's by 1% in the dark), and a table
// costs one look-up per channel.
vec3 srgbToLinear(vec3 code) {
  vec3 s = sqrt(code);
  vec3 power = ((0.009480046 * s - 0.07493101) * s + 0.79743385) * s + 0.17218539;
  power = (((power * s + 0.06789335) * s + 0.026256947) * s + 0.00088151894) * s + 0.00079976703;
  return mix(power, code * (1.0 / 12.92), lessThanEqual(code, vec3(0.04045)));
}

// A texel of `sceneTextures` as linear light. p: x, y and page; linear: whether it is stored as such, not as sRGB.
vec4 sceneTexel(ivec3 p, bool linear) {
  vec4 texel = texelFetch(sceneTextures, p, 0);
  return vec4(mix(srgbToLinear(texel.rgb), texel.rgb, bvec3(linear)), texel.a);
}

ivec2 environmentSize() { return textureSize(sceneEnvironment, 0); }  // texels; one if there is no map
vec3 environmentTexel(ivec2 p) { return texelFetch(sceneEnvironment, p, 0).rgb; }  // W/(sr m^2)

#endif
