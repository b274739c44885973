// The scene as descriptor set 1 holds it (scene/scene.glsl): blocks of a frame and of a view, lights, and the entries
// of the texel buffers of objects and materials.
#pragma once

#include "shared.h"

SHARED_BEGIN(fovea::scene)

// What belongs to a frame: `frame` in shaders.
struct FrameBlock {
  uint index SHARED_ZERO;  // frame number in the sequence
  uint seed SHARED_ZERO;
  uint lightCount SHARED_ZERO;
  uint triangleCount SHARED_ZERO;
  uint staticTriangleCount SHARED_ZERO;
  uint vertexCount SHARED_ZERO;
  float time SHARED_ZERO;      // s
  float exposure SHARED_ZERO;  // factor on stored light before the display curve
  vec3 boundsMin SHARED_ZERO;  // world space, m
  // Factor from light in units of the scene, such as W/(sr m^2), to light as passes store it. What this block, lights,
  // materials, emitters and the environment map hold is multiplied by it already.
  float preExposure SHARED_ZERO;
  vec3 boundsMax SHARED_ZERO;
  float unused1 SHARED_ZERO;
  vec3 environment SHARED_ZERO;          // radiance of the background without an environment map, W/(sr m^2)
  float environmentTurn SHARED_ZERO;     // radians by which the map is turned about +Y
  uint firstMovingVertex SHARED_ZERO;    // vertices below it never move
  uint firstMovingTriangle SHARED_ZERO;  // of the triangles used for voxels and VPL maps
  // Texel of `sceneMaterials` at which the SurfaceRecords start, 0 if there are none; then that of the tables of
  // albedos, of the tangents (0 if no surface has a normal map) and of the VertexDetails (0 if there are none).
  uint firstSurface SHARED_ZERO;
  uint firstAlbedo SHARED_ZERO;
  uint firstTangent SHARED_ZERO;
  uint firstDetail SHARED_ZERO;
  uint transparent SHARED_ZERO;  // 1 if full materials let a part of the light through
  uint unused2 SHARED_ZERO;
};
SHARED_SIZE(FrameBlock, 112)
SHARED_OFFSET(FrameBlock, boundsMin, 32)
SHARED_OFFSET(FrameBlock, firstMovingVertex, 80)

// The rays from an eye through the points of its picture: that through the point (x, y), in pixels from the top left
// corner, has the direction corner + x right + y down, in world space and not normalised.
struct PixelRays {
  vec3 eye SHARED_ZERO;  // world space, m
  float unused0 SHARED_ZERO;
  vec3 corner SHARED_ZERO;
  float unused1 SHARED_ZERO;
  vec3 right SHARED_ZERO;
  float unused2 SHARED_ZERO;
  vec3 down SHARED_ZERO;
  float unused3 SHARED_ZERO;
};
SHARED_SIZE(PixelRays, 64)

// What belongs to the eye: `view` in shaders.
struct ViewBlock {
  mat4 worldToView SHARED_ZERO;
  mat4 viewToClip SHARED_ZERO;
  mat4 worldToClip SHARED_ZERO;
  mat4 clipToWorld SHARED_ZERO;
  mat4 previousWorldToClip SHARED_ZERO;
  vec3 eye SHARED_ZERO;  // world space, m
  float unused0 SHARED_ZERO;
  vec2 gaze SHARED_ZERO;         // in picture sizes from the top left corner, (0.5, 0.5) in the middle
  vec2 jitterStep SHARED_ZERO;   // pixels: by how much View::jitter has changed since the last frame
  vec2 size SHARED_ZERO;         // pixels
  vec2 inverseSize SHARED_ZERO;  // 1 / pixels
  PixelRays rays;
};
SHARED_SIZE(ViewBlock, 432)
SHARED_OFFSET(ViewBlock, gaze, 336)

SHARED_CONSTANT uint kMaxLights = 128u;

SHARED_CONSTANT uint kLightDirectional = 0u, kLightPoint = 1u, kLightSpot = 2u;  // LightRecord::type

// A lamp, as KHR_lights_punctual has it: an element of `lights`.
struct LightRecord {
  vec3 position SHARED_ZERO;  // world space, m
  uint type SHARED_ZERO;
  vec3 direction SHARED_ZERO;  // unit, the way light travels
  float range SHARED_ZERO;     // m, 0 unlimited
  vec3 intensity SHARED_ZERO;  // candela, taken as W/sr; directional: lux, taken as W/m^2
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

// An object (scene/objects.glsl). Its own space is that of its mesh. Object 0 holds everything that never moves; its
// own space is the world's. Ten texels of `sceneObjects`.
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
SHARED_CONSTANT uint kTextureSecondSet = 64u;     // full materials take the second texture coordinates
SHARED_CONSTANT uint kTextureNearest = 512u;      // shows the nearest texel; otherwise four are interpolated
// Also there, and only if materials are full (materials/passage.glsl).
SHARED_CONSTANT uint kMaterialBlended = 128u;    // alpha is the share of light that the surface stops
SHARED_CONSTANT uint kMaterialTransmits = 256u;  // thin glass

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
  float alphaCutoff SHARED_ZERO;  // 0: opaque; below 0: lets light through whatever its alpha
  TextureRecord colorTexture;
  TextureRecord emissionTexture;
};
SHARED_SIZE(MaterialRecord, 128)
SHARED_OFFSET(MaterialRecord, colorTexture, 32)

// ---- Full materials ----

// Keeps the random numbers with which the eye's rays pass surfaces apart from others.
SHARED_CONSTANT uint kPassageStream = 0x70617373u;
// The greatest share of light that passes glass, that of clear glass. What does not pass meets its reflection, which is
// divided by the rest.
SHARED_CONSTANT float kMostPassed = 0.96f;
SHARED_CONSTANT float kDarkestGlass = 1e-4f;  // least channel of its colour
// Steps of passageChance(), in 2^-32: from pixel to pixel, with which each square of 3 x 3 or 5 x 5 pixels has values
// that are spread out evenly, and from turn to turn, the golden ratio and what one sequence differs from the next by.
SHARED_CONSTANT uint kPassageAcross = 1357209665u, kPassageAlong = 1803886265u;
SHARED_CONSTANT uint kPassageTurn = 2654435769u, kPassageTurns = 149464861u;

// What only they need follows the MaterialRecords in `sceneMaterials`, if any pass asks for it.

// The factors and textures of a full material beside those of MaterialRecord, whose textures for base colour and
// emission it shares. 25 texels.
struct SurfaceRecord {
  vec3 baseColor SHARED_ZERO;
  float metallic SHARED_ZERO;
  vec3 specularF0 SHARED_ZERO;  // of the dielectric part, where `specular` is 1
  float specular SHARED_ZERO;
  float roughness SHARED_ZERO;  // perceptual
  float normalScale SHARED_ZERO;
  float transmission SHARED_ZERO;
  float unlit SHARED_ZERO;  // above 0: shows its base colour, times this
  float clearcoat SHARED_ZERO;
  float clearcoatRoughness SHARED_ZERO;
  float unused0 SHARED_ZERO;
  float unused1 SHARED_ZERO;
  TextureRecord metallicRoughnessTexture;
  TextureRecord normalTexture;
  TextureRecord specularTexture;
  TextureRecord specularColorTexture;
  TextureRecord transmissionTexture;
  TextureRecord clearcoatTexture;
  TextureRecord clearcoatRoughnessTexture;
};
SHARED_SIZE(SurfaceRecord, 400)
SHARED_OFFSET(SurfaceRecord, roughness, 32)
SHARED_OFFSET(SurfaceRecord, metallicRoughnessTexture, 64)

// Tables of albedos by the square root of the cosine (columns) and the roughness (rows): kAlbedoSide rows of as many
// texels, which are the albedo of a perfect mirror and the part of it that Fresnel's curve gives to F90 for metals and
// for dielectrics with an index of refraction of 1.5; then a row of its means over the directions.
SHARED_CONSTANT uint kAlbedoSide = 48u;
SHARED_CONSTANT float kAlbedoLeastRoot = 0.02f;  // square root of the cosine of the first column

// The tangents at the corners of a triangle, by its edges and its normal (cornerTangent() in
// materials/full_material.glsl). Three texels.
struct TangentRecord {
  vec3 corner0 SHARED_ZERO;
  float bitangentSign SHARED_ZERO;
  vec3 corner1 SHARED_ZERO;
  float unused0 SHARED_ZERO;
  vec3 corner2 SHARED_ZERO;
  float unused1 SHARED_ZERO;
};
SHARED_SIZE(TangentRecord, 48)

// What few models give their vertices. Two texels.
struct VertexDetail {
  vec4 color SHARED_DEFAULT(1);
  vec2 uv SHARED_ZERO;  // second texture coordinates
  vec2 unused SHARED_ZERO;
};
SHARED_SIZE(VertexDetail, 32)
SHARED_OFFSET(VertexDetail, uv, 16)

SHARED_END
