// Descriptor set 1: frame, view, lights and the scene's world-space triangles. The same for every pass of a frame.
// Kept in step with framework/scene/gpu_scene.cpp, which static_asserts the block sizes.
#ifndef FOVEA_SCENE_GLSL
#define FOVEA_SCENE_GLSL

const float kPi = 3.14159265358979;

layout(set = 1, binding = 0) uniform FrameBlock {
  uint index;            // frame number in the sequence
  uint seed;
  uint lightCount;
  uint triangleCount;
  uint staticTriangleCount;
  uint vertexCount;
  float time;            // s
  float exposure;
  vec4 boundsMin;        // world space, m
  vec4 boundsMax;
  vec4 environment;      // radiance where nothing is hit
} frame;

layout(set = 1, binding = 1) uniform ViewBlock {
  mat4 worldToView;
  mat4 viewToClip;
  mat4 worldToClip;
  mat4 clipToWorld;
  mat4 previousWorldToClip;
  vec4 eye;              // world space
  vec4 gaze;             // xy: normalised, origin top-left
  vec4 size;             // xy: pixels, zw: 1 / pixels
} view;

const uint kLightDirectional = 0u;
const uint kLightPoint = 1u;
const uint kLightSpot = 2u;

struct Light {
  vec4 position;         // xyz world, w: type as float
  vec4 direction;        // xyz unit, the way light travels; w: range, 0 unlimited
  vec4 intensity;        // rgb: lux or candela; w unused
  vec4 cone;             // x: cos inner, y: cos outer, z: 1 / (cos inner - cos outer)
};

layout(set = 1, binding = 2) uniform LightBlock { Light lights[64]; };

layout(set = 1, binding = 3) uniform usamplerBuffer sceneTriangles;   // xyz: vertices, w: material | object << 16
layout(set = 1, binding = 4) uniform samplerBuffer scenePositions;    // xyz world
layout(set = 1, binding = 5) uniform samplerBuffer sceneAttributes;   // xy: octahedral normal, zw: uv
layout(set = 1, binding = 6) uniform samplerBuffer sceneMaterials;    // kMaterialTexels texels each
layout(set = 1, binding = 7) uniform texture2DArray sceneTexturesSrgb;  // pages; texelFetch gives linear light

struct Material {
  vec3 baseColor;        // times (1 - metallic): diffuse reflectance
  float alpha;
  vec3 emission;         // W/(sr m^2)
  float alphaCutoff;     // 0: opaque
  bool doubleSided;
};

struct SurfacePoint {    // a material looked up at a point
  vec3 reflectance;
  float alpha;
  vec3 emission;
};

// The rest (materials, textures, lights) is implemented below.
