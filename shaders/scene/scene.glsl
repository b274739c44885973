// The scene: `frame`, `view` and `lights` (records/scene.h), geometry, diffuse materials, the environment and lights.
// All of it is descriptor set 1, the same for every pass of a frame (scene/tables.glsl).
#ifndef FOVEA_SCENE_GLSL
#define FOVEA_SCENE_GLSL

#include "device/constants.glsl"
#include "scene/octahedral.glsl"
#include "scene/tables.glsl"

// Diagonal of the scene's bounds, m; above 0.
float diagonal() { return max(distance(frame.boundsMin, frame.boundsMax), 1e-30); }

// ---- Geometry ----------------------------------------------------------------------------------------------------

// Material and object of a triangle, as sceneTriangle() returns it.
uint materialOf(uvec4 triangle) { return triangle.w & 0xffffu; }
uint objectOf(uvec4 triangle) { return triangle.w >> 16; }

// ---- Materials ---------------------------------------------------------------------------------------------------

// Texels of a MaterialRecord in `sceneMaterials`, and at which of them its textures start.
CONSTANT int kMaterialTexels = 8, kColorTexture = 2, kEmissionTexture = 5;

// The factors of a material, without its textures.
struct Material {
  vec3 baseColor;        // times (1 - metallic): diffuse reflectance where the texture is white
  float alpha;
  vec3 emission;         // W/(sr m^2)
  float alphaCutoff;     // 0: opaque; below 0: lets light through whatever its alpha
  bool doubleSided;
};

struct SurfacePoint {    // a material looked up at a point; diffuse reflectance, and radiance in W/(sr m^2)
  vec3 reflectance;
  vec3 emission;
};

// The factors of a material by its number.
Material loadMaterial(uint material) {
  int first = int(material) * kMaterialTexels;
  vec4 color = texelOf(sceneMaterials, first);
  vec4 emission = texelOf(sceneMaterials, first + 1);
  uint flags = uint(texelOf(sceneMaterials, first + kColorTexture).w);
  return Material(vec3(color), color.a, vec3(emission), emission.a, (flags & kMaterialDoubleSided) != 0u);
}

// The number of texels after which a texture repeats along an axis. size: of the texture along it, texels; wrap: 0
// repeats the texture; kWrapClamp and kWrapMirror are the other ways.
int texelPeriod(int size, uint wrap) { return wrap == kWrapMirror ? 2 * size : size; }

// The coordinate `i` of a texel moved by whole periods into [0, period), but unchanged for kWrapClamp. The division is
// one of floats, as CPU devices divide integers lane by lane. A second step corrects the rounding of the first.
int withinPeriod(int i, int size, uint wrap) {
  if (wrap == kWrapClamp) return i;
  int period = texelPeriod(size, wrap);
  float inverse = 1.0 / float(period);
  i -= period * int(floor((float(i) + 0.5) * inverse));
  return i - period * int(floor((float(i) + 0.5) * inverse));
}

// The texel that is read at coordinate `i`, which is a result of withinPeriod() or larger than it by one.
int wrapTexel(int i, int size, uint wrap) {
  if (wrap == kWrapClamp) return clamp(i, 0, size - 1);
  int period = texelPeriod(size, wrap);
  if (i == period) return 0;
  return i < size ? i : period - 1 - i;
}

// The square of texels that a texture is interpolated between, at level 0.
struct TexelSquare {
  ivec2 first, size;   // upper left coordinate, as from withinPeriod(), and size of the texture
  ivec2 corner;        // of the texture in its page
  int page;
  uint wrapU, wrapV;
  vec2 f;              // weights of the right column and the lower row; 0 for the nearest texel
  bool nearest, linear;
};

// Whether there is a texture. texel: the first of the three texels that describe it (TextureRecord).
bool hasTexture(int texel) { return texelOf(sceneMaterials, texel).x >= 0.0; }

// The square around `uv` of a texture that there is.
TexelSquare texelSquare(int texel, vec2 uv) {
  vec4 place = texelOf(sceneMaterials, texel), extent = texelOf(sceneMaterials, texel + 1);
  vec4 axes = texelOf(sceneMaterials, texel + 2);
  vec2 p = (vec2(axes) * uv.x + vec2(axes.z, axes.w) * uv.y + vec2(extent.z, extent.w)) * vec2(extent);
  uint flags = uint(place.w), wrapU = flags & 3u, wrapV = flags >> 2 & 3u;
  bool nearest = (flags & kTextureNearest) != 0u;
  if (!nearest) p -= 0.5;
  p = mix(clamp(p, vec2(-1e9), vec2(1e9)), vec2(0.0), isnan(p));
  vec2 base = floor(p), f = nearest ? vec2(0.0) : p - base;
  ivec2 size = ivec2(extent), i = ivec2(base);
  ivec2 first = ivec2(withinPeriod(i.x, size.x, wrapU), withinPeriod(i.y, size.y, wrapV));
  return TexelSquare(first, size, ivec2(place.y, place.z), int(place.x), wrapU, wrapV, f, nearest,
                     (flags & kTextureLinear) != 0u);
}

// One of the four texels of a square times its weight, as linear light. tap: bit 0 chooses the column, bit 1 the row.
vec4 weightedTexel(TexelSquare s, int tap) {
  ivec2 offset = ivec2(tap & 1, tap >> 1), i = s.first + offset;
  ivec2 at = s.corner + ivec2(wrapTexel(i.x, s.size.x, s.wrapU), wrapTexel(i.y, s.size.y, s.wrapV));
  vec2 weight = mix(1.0 - s.f, s.f, vec2(offset));
  return weight.x * weight.y * sceneTexel(ivec3(at, s.page), s.linear);
}

// A texture at `uv`, as linear light: at level 0, the nearest texel or four, decoded and then interpolated. White if
// there is none. A loop keeps shaders small, as drivers copy this function to every place that calls it.
vec4 sampleSceneTexture(int texel, vec2 uv) {
  if (!hasTexture(texel)) return vec4(1.0);
  TexelSquare s = texelSquare(texel, uv);
  vec4 sum = vec4(0.0);
  for (int tap = 0; tap < (s.nearest ? 1 : 4); ++tap) sum += weightedTexel(s, tap);
  return sum;
}

// Alpha of a texture, as in sampleSceneTexture(), but without a loop: rays ask for it at every triangle, and CPU
// devices limit the iterations of an invocation.
float sampleSceneAlpha(int texel, vec2 uv) {
  if (!hasTexture(texel)) return 1.0;
  TexelSquare s = texelSquare(texel, uv);
  return weightedTexel(s, 0).a + weightedTexel(s, 1).a + weightedTexel(s, 2).a + weightedTexel(s, 3).a;
}

// A material at `uv`, with its textures. rgb: diffuse reflectance, a: alpha.
vec4 materialReflectance(uint material, vec2 uv) {
  int first = int(material) * kMaterialTexels;
  return texelOf(sceneMaterials, first) * sampleSceneTexture(first + kColorTexture, uv);
}

// Alpha of a material at `uv`, with its texture.
float materialAlpha(uint material, vec2 uv) {
  int first = int(material) * kMaterialTexels;
  return texelOf(sceneMaterials, first).a * sampleSceneAlpha(first + kColorTexture, uv);
}

// The radiance that a material emits at `uv`, W/(sr m^2).
vec3 materialEmission(uint material, vec2 uv) {
  int first = int(material) * kMaterialTexels;
  vec3 emission = vec3(texelOf(sceneMaterials, first + 1));
  // Few surfaces emit.
  if (emission != vec3(0.0))
    emission *= vec3(sampleSceneTexture(first + kEmissionTexture, uv));
  return emission;
}

// Reflectance and emission of a material at `uv`.
SurfacePoint surfaceAt(uint material, vec2 uv) {
  return SurfacePoint(vec3(materialReflectance(material, uv)), materialEmission(material, uv));
}

// ---- Environment -------------------------------------------------------------------------------------------------

// Whether an environment map lights the scene; if not, the background is frame.environment.
bool hasEnvironmentMap() { return environmentSize().x > 1; }

// Radiance that arrives from the environment map, W/(sr m^2), filtered bilinearly. direction: unit, away from the
// scene.
vec3 environmentRadiance(vec3 direction) {
  ivec2 size = environmentSize();
  float around = (atan(direction.x, -direction.z) + frame.environmentTurn) / (2.0 * kPi) + 0.5;
  vec2 p = vec2(fract(around), acos(clamp(direction.y, -1.0, 1.0)) / kPi) * vec2(size) - 0.5;
  vec2 base = floor(p), f = p - base;
  ivec2 first = ivec2(base);
  int left = (first.x + size.x) % size.x, right = (first.x + 1) % size.x;
  int top = clamp(first.y, 0, size.y - 1), bottom = clamp(first.y + 1, 0, size.y - 1);
  vec3 upper = mix(environmentTexel(ivec2(left, top)),
                   environmentTexel(ivec2(right, top)), f.x);
  vec3 lower = mix(environmentTexel(ivec2(left, bottom)),
                   environmentTexel(ivec2(right, bottom)), f.x);
  return mix(upper, lower, f.y);
}

// ---- Lights ------------------------------------------------------------------------------------------------------

// What a light sends to a point.
struct LightSample {
  vec3 irradiance;  // on a surface that faces the light, W/m^2, without occlusion
  vec3 direction;   // unit, to the light
  float distance;   // m; directional: kFarAway
};

CONSTANT float kFarAway = 1e30;

// position: of the point, world space, m. Units and falloff are those of KHR_lights_punctual (passes/README.md, Light
// units and fairness).
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
