// The surface of each pixel from the triangle visible there: the ray through the pixel's centre is intersected with the
// triangle's plane, so that positions have none of the rasteriser's snapping and interpolation (visibility buffer,
// Burns and Hunt, JCGT 2013). Defines: EMISSION_TEXTURES 0/1; FULL 0/1, 1 for full materials, where alpha of three
// images holds what `specular` has no room for (glossOf() in materials/gloss.glsl), with MATERIAL_DETAIL 0, 1 or
// 2 (materials/full_material.glsl), and TINT 0/1, 1 where something that lets light through may stand before the
// surface (tint.frag).
#if FULL
#include "materials/full_material.glsl"
#endif
#include "screen/pixel_ray.glsl"
#include "scene/scene.glsl"

uniform utexture2D gbufferTriangle;
#if TINT
uniform texture2D tint;
#endif
VALUE(writeonly, PixelRays, gbufferCamera);
layout(location = 0) out float gbufferDistance;
layout(location = 1) out vec4 gbufferNormal;
layout(location = 2) out vec2 gbufferFace;
layout(location = 3) out vec4 gbufferAlbedo;
layout(location = 4) out vec4 gbufferEmission;
layout(location = 5) out uint gbufferId;
#if FULL
layout(location = 6) out vec4 gbufferSpecular;

const float kLeastGrazing = 1e-4;  // so that its sign is kept
const float kSolid = 1.0 - 0.5 / 255.0;  // with this alpha, what is BLEND lets next to nothing through
#endif

const uint kNothing = 0xffffffffu;
const float kMaxHalf = 65504.0;

const float kBeside = 1e-3;  // how much nearer or farther a point just beside a triangle may be, relative

// Barycentric weights of b and c at the point where the ray meets the plane of the triangle a, b, c (Moeller and
// Trumbore 1997).
vec2 barycentrics(vec3 ray, vec3 a, vec3 edgeB, vec3 edgeC) {
  vec3 p = cross(ray, edgeC);
  float determinant = dot(edgeB, p);
  if (determinant == 0.0) return vec2(1.0 / 3.0);
  vec3 s = view.eye - a;
  return vec2(dot(s, p), dot(ray, cross(s, edgeB))) / determinant;
}

// The weights of the nearest point inside the triangle: the rasteriser accepts some pixels whose centre just misses it.
vec2 inside(vec2 weights) {
  weights = max(weights, 0.0);
  return weights / max(weights.x + weights.y, 1.0);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  uint index = texelFetch(gbufferTriangle, p, 0).r;
  bool background = index == kNothing;  // computed as if it were triangle 0: a CPU device runs both sides of a branch
  uvec4 triangle = sceneTriangle(background ? 0u : index);
  vec3 a = scenePosition(triangle.x), edgeB = scenePosition(triangle.y) - a, edgeC = scenePosition(triangle.z) - a;
  vec2 onPlane = barycentrics(pixelRay(p), a, edgeB, edgeC), w = inside(onPlane);
  vec3 weights = vec3(1.0 - w.x - w.y, w);
  vec3 position = a + w.x * edgeB + w.y * edgeC;

  vec3 face = normalize(cross(edgeB, edgeC));
  if (dot(face, view.eye - a) < 0.0) face = -face;
  vec3 normal = mat3(sceneNormal(triangle.x), sceneNormal(triangle.y), sceneNormal(triangle.z)) * weights;
  normal = dot(normal, normal) > 1e-12 ? normalize(normal) : face;
  if (dot(normal, face) < 0.0) normal = -normal;
  vec3 interpolated = normal;
  vec2 uv = mat3x2(sceneUv(triangle.x), sceneUv(triangle.y), sceneUv(triangle.z)) * weights;
  uint material = materialOf(triangle);
#if FULL
  TextureCoordinates at = textureCoordinates(triangle, weights, uv);
  float side = dot(cross(edgeB, edgeC), face) < 0.0 ? -1.0 : 1.0;
  int record = int(frame.firstSurface) + int(material) * kSurfaceTexels;
  normal = mappedNormal(record, index, weights, edgeB, edgeC, normal, side, at);
  vec3 toEye = normalize(view.eye - position);
  normal = normalTowards(normal, toEye);
  FullSurface surface = fullSurface(material, triangle, weights, at, dot(normal, toEye), 0.0);
#if TINT
  uint flags = uint(texelOf(sceneMaterials, int(material) * kMaterialTexels + kColorTexture).w);
#if MATERIAL_DETAIL == 2
  // Glass is seen only where the eye's ray has not passed it (visibility.frag), and has to be brighter there to make up
  // for that.
  if ((flags & kMaterialTransmits) != 0u)
    surface = brighter(surface, vec3(1.0 / (1.0 - passage(material, uv, abs(dot(interpolated, toEye))))));
#endif
  vec4 before = texelFetch(tint, p, 0);
  vec3 seenThrough = exp(before.rgb);
  surface = brighter(surface, seenThrough);
#endif
  vec3 albedo = surface.albedo, emission = surface.emission;
  // Of normal, albedo and emission.
  vec3 alphas = vec3(surface.gloss.f90, surface.gloss.metallic, surface.gloss.dielectricF0);
#if TINT
  float alphaOf = dot(vec3(sceneAlpha(triangle.x), sceneAlpha(triangle.y), sceneAlpha(triangle.z)), weights);
  bool own = (flags & kMaterialTransmits) != 0u ||
             ((flags & kMaterialBlended) != 0u && coverage(material, uv, alphaOf) < kSolid);
  if ((own && !background) || before.a > 0.0) alphas.x = -max(alphas.x, kLeastGrazing);
#endif
#else
  const vec3 alphas = vec3(0.0);
  vec3 albedo = materialReflectance(material, uv).rgb;
#if EMISSION_TEXTURES
  vec3 emission = materialEmission(material, uv);
#else
  vec3 emission = loadMaterial(material).emission;
#endif
#endif
  if (background) emission = frame.environment;
  if (background && hasEnvironmentMap())
    emission = environmentRadiance(normalize(pixelRay(p)));

#if TINT
  if (background) emission *= seenThrough;
#endif
  if (p == ivec2(0)) gbufferCamera.value = view.rays;
  // The distance at which the ray meets the plane, as positions are reconstructed on the ray.
  float nearest = distance(position, view.eye), met = distance(a + onPlane.x * edgeB + onPlane.y * edgeC, view.eye);
  gbufferDistance = background ? 0.0 : clamp(met, (1.0 - kBeside) * nearest, (1.0 + kBeside) * nearest);
  gbufferNormal = background ? vec4(vec3(0.0), min(alphas.x, 0.0)) : vec4(normal, alphas.x);
  gbufferFace = background ? vec2(0.0) : octEncode(face);
#ifdef WITHOUT_VK_FORMAT_R16G16_SNORM
  gbufferFace = unpackSnorm2x16(packSnorm2x16(gbufferFace));
#endif
  gbufferAlbedo = background ? vec4(0.0) : vec4(albedo, alphas.y);
  gbufferEmission = vec4(min(emission, kMaxHalf), alphas.z);
  gbufferId = background ? kNothing : triangle.w;
#if FULL
  gbufferSpecular = background ? vec4(0.0) : vec4(surface.gloss.f0, surface.gloss.roughness);
#endif
}
