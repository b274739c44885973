// The scene as descriptor set 1 holds it (common/scene.glsl): blocks of a frame and of a view, lights, and the entries
// of the texel buffers of objects and materials.
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::scene)

struct FrameBlock {
  uint index SHARED_ZERO;  // frame number in the sequence
  uint seed SHARED_ZERO;
  uint lightCount SHARED_ZERO;
  uint triangleCount SHARED_ZERO;
  uint staticTriangleCount SHARED_ZERO;
  uint vertexCount SHARED_ZERO;
  float time SHARED_ZERO;  // s
  float exposure SHARED_ZERO;
  vec3 boundsMin SHARED_ZERO;  // world space, m
  float unused0 SHARED_ZERO;
  vec3 boundsMax SHARED_ZERO;
  float unused1 SHARED_ZERO;
  vec3 environment SHARED_ZERO;       // radiance where nothing is hit, without an environment map
  float environmentTurn SHARED_ZERO;  // radians by which the map is turned about +Y
  uint firstMovingVertex SHARED_ZERO;    // vertices below it never move
  uint firstMovingTriangle SHARED_ZERO;  // of the triangles used for voxels and VPL maps
  uint unused3 SHARED_ZERO;
  uint unused4 SHARED_ZERO;
};
SHARED_SIZE(FrameBlock, 96)
SHARED_OFFSET(FrameBlock, boundsMin, 32)
SHARED_OFFSET(FrameBlock, firstMovingVertex, 80)

struct ViewBlock {
  mat4 worldToView SHARED_ZERO;
  mat4 viewToClip SHARED_ZERO;
  mat4 worldToClip SHARED_ZERO;
  mat4 clipToWorld SHARED_ZERO;
  mat4 previousWorldToClip SHARED_ZERO;
  vec3 eye SHARED_ZERO;  // world space
  float unused0 SHARED_ZERO;
  vec2 gaze SHARED_ZERO;         // normalised, origin top-left
  vec2 jitterStep SHARED_ZERO;   // pixels: by how much View::jitter has changed since the last frame
  vec2 size SHARED_ZERO;         // pixels
  vec2 inverseSize SHARED_ZERO;  // 1 / pixels
};
SHARED_SIZE(ViewBlock, 368)
SHARED_OFFSET(ViewBlock, gaze, 336)

SHARED_CONSTANT uint kMaxLights = 64u;

SHARED_CONSTANT uint kLightDirectional = 0u, kLightPoint = 1u, kLightSpot = 2u;  // LightRecord::type

struct LightRecord {
  vec3 position SHARED_ZERO;  // world
  uint type SHARED_ZERO;
  vec3 direction SHARED_ZERO;  // unit, the way light travels
  float range SHARED_ZERO;     // m, 0 unlimited
  vec3 intensity SHARED_ZERO;  // rgb: lux or candela
  uint firstShadowLayer SHARED_ZERO;
  float cosInner SHARED_ZERO;
  float cosOuter SHARED_ZERO;
  float coneScale SHARED_ZERO;  // 1 / (cosInner - cosOuter)
  float unused SHARED_ZERO;
};
SHARED_SIZE(LightRecord, 64)
SHARED_OFFSET(LightRecord, cosInner, 48)

// The rows of a transform of points, four columns each.
struct TransformRows {
  vec4 x SHARED_ZERO;
  vec4 y SHARED_ZERO;
  vec4 z SHARED_ZERO;
};
SHARED_SIZE(TransformRows, 48)

// An object's own space is that of its mesh. Object 0 holds everything that never moves; its own space is the world's.
// The same as scene::ObjectTransform. Ten texels of `sceneObjects`.
struct ObjectRecord {
  TransformRows toWorld;
  TransformRows previousToWorld;  // of the last frame
  TransformRows toObject;         // the inverse of toWorld; zeros if there is none
  float visible SHARED_ZERO;
  float wasVisible SHARED_ZERO;  // in the last frame
  float deforms SHARED_ZERO;     // its vertices move individually (morph targets, joints)
  float unused SHARED_ZERO;
};
SHARED_SIZE(ObjectRecord, 160)
SHARED_OFFSET(ObjectRecord, visible, 144)

// Bits of TextureRecord::flags. Bits 0-1 are the wrap of u, bits 2-3 that of v; 0 repeats.
SHARED_CONSTANT uint kWrapClamp = 1u;
SHARED_CONSTANT uint kWrapMirror = 2u;
SHARED_CONSTANT uint kTextureLinear = 16u;        // not sRGB-encoded
SHARED_CONSTANT uint kMaterialDoubleSided = 32u;  // only in the flags of a material's base colour texture

// Where a texture lies in `sceneTextures`, and how it is laid over the uv of a surface. Three texels of floats.
struct TextureRecord {
  float page SHARED_DEFAULT(-1);  // -1: there is no texture
  float x SHARED_ZERO;            // its corner in the page, texels
  float y SHARED_ZERO;
  float flags SHARED_ZERO;
  vec2 size SHARED_ZERO;    // texels
  vec2 offset SHARED_ZERO;  // of the uv transform
  vec2 axisU SHARED_ZERO;
  vec2 axisV SHARED_ZERO;
};
SHARED_SIZE(TextureRecord, 48)

// Eight texels of `sceneMaterials`.
struct MaterialRecord {
  vec3 baseColor SHARED_ZERO;  // times (1 - metallic): diffuse reflectance where the texture is white
  float alpha SHARED_ZERO;
  vec3 emission SHARED_ZERO;      // W/(sr m^2)
  float alphaCutoff SHARED_ZERO;  // 0: opaque
  TextureRecord colorTexture;
  TextureRecord emissionTexture;
};
SHARED_SIZE(MaterialRecord, 128)
SHARED_OFFSET(MaterialRecord, colorTexture, 32)

SHARED_END
