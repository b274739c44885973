// Full materials at a point of a surface: glTF's metallic-roughness model with normal maps, KHR_materials_specular,
// _ior, _clearcoat, _transmission (thin glass), _unlit and _emissive_strength.
//
// Define: MATERIAL_DETAIL 0/1/2, if materials have less than everything, which is 2.
#ifndef FOVEA_FULL_MATERIAL_GLSL
#define FOVEA_FULL_MATERIAL_GLSL

#include "materials/passage.glsl"
#include "scene/scene.glsl"

// Both sets of texture coordinates at a point.
struct TextureCoordinates {
  vec2 first, second;
};

// MATERIAL_DETAIL says what materials may have: with 0 textures of base colour and emission, with 1 also those of
// metallic and roughness and normal maps, with 2 everything. A CPU device spends time even on what no material has.
#ifndef MATERIAL_DETAIL
#define MATERIAL_DETAIL 2
#endif

// A texture at a point, as linear light. texel: the first of the three that describe it in `sceneMaterials`.
vec4 textureAt(int texel, TextureCoordinates at) {
#if MATERIAL_DETAIL == 2
  bool second = (uint(texelOf(sceneMaterials, texel).w) & kTextureSecondSet) != 0u;
  return sampleSceneTexture(texel, second ? at.second : at.first);
#else
  return sampleSceneTexture(texel, at.first);
#endif
}

// The same for textures that materials have only with MATERIAL_DETAIL 1, and only with 2; white otherwise.
vec4 mapTexture(int texel, TextureCoordinates at) { return MATERIAL_DETAIL >= 1 ? textureAt(texel, at) : vec4(1.0); }
vec4 extensionTexture(int texel, TextureCoordinates at) {
  return MATERIAL_DETAIL == 2 ? textureAt(texel, at) : vec4(1.0);
}

// Both sets at a point of a triangle. weights: barycentric, of all three vertices; uv: the first set there.
TextureCoordinates textureCoordinates(uvec4 triangle, vec3 weights, vec2 uv) {
  vec2 second = uv;
  if (MATERIAL_DETAIL == 2 && frame.firstDetail != 0u) {
    ivec3 texel = int(frame.firstDetail) + 2 * ivec3(triangle) + 1;
    second = mat3x2(vec2(texelOf(sceneMaterials, texel.x)), vec2(texelOf(sceneMaterials, texel.y)),
                    vec2(texelOf(sceneMaterials, texel.z))) * weights;
  }
  return TextureCoordinates(uv, second);
}

// Colour of the vertices at a point of a triangle; white if they have none.
vec3 vertexColor(uvec4 triangle, vec3 weights) {
  vec3 color = vec3(1.0);
  if (MATERIAL_DETAIL == 2 && frame.firstDetail != 0u) {
    ivec3 texel = int(frame.firstDetail) + 2 * ivec3(triangle);
    color = mat3(vec3(texelOf(sceneMaterials, texel.x)), vec3(texelOf(sceneMaterials, texel.y)),
                 vec3(texelOf(sceneMaterials, texel.z))) * weights;
  }
  return color;
}

// The direction of a corner's tangent, wherever the triangle is now. corner: from the TangentRecord; edgeB, edgeC: from
// the first vertex to the others; across: their cross product divided by the square root of its length.
vec3 cornerTangent(vec3 corner, vec3 edgeB, vec3 edgeC, vec3 across) {
  vec3 t = corner.x * edgeB + corner.y * edgeC + corner.z * across;
  float d = length(t);
  return d > 0.0 ? t / d : t;
}

// The normal that the normal map gives a point, world space, unit. surface: texel of the SurfaceRecord; weights: of all
// three vertices; edgeB, edgeC: from the first vertex to the others, m; normal: interpolated, on the side that is seen;
// side: 1 if that is the one whose vertices run counter-clockwise, else -1.
vec3 mappedNormal(int surface, uint triangle, vec3 weights, vec3 edgeB, vec3 edgeC, vec3 normal, float side,
                  TextureCoordinates at) {
  vec3 bent = normal;
  bool mapped = MATERIAL_DETAIL >= 1 && frame.firstTangent != 0u &&
                texelOf(sceneMaterials, surface + kNormalTexture).x >= 0.0;
  if (mapped) {
    int first = int(frame.firstTangent) + 3 * int(triangle);
    vec4 a = texelOf(sceneMaterials, first);
    vec3 b = vec3(texelOf(sceneMaterials, first + 1)), c = vec3(texelOf(sceneMaterials, first + 2));
    vec3 across = cross(edgeB, edgeC);
    float area = length(across);
    across *= area > 0.0 ? inversesqrt(area) : 0.0;
    vec3 t = mat3(cornerTangent(vec3(a), edgeB, edgeC, across), cornerTangent(b, edgeB, edgeC, across),
                  cornerTangent(c, edgeB, edgeC, across)) * weights;
    t -= normal * dot(normal, t);
    float d = length(t);
    vec3 tangent = t / max(d, 1e-6), bitangent = a.w * cross(normal, tangent);
    vec3 m = 2.0 * vec3(mapTexture(surface + kNormalTexture, at)) - 1.0;
    float scale = texelOf(sceneMaterials, surface + 2).y;
    m *= vec3(scale, scale, 1.0);
    vec3 n = side * m.x * tangent + m.y * bitangent + m.z * normal;
    float size = length(n);
    bent = d > 1e-6 && size > 1e-6 ? n / size : normal;
  }
  return bent;
}

// The shading normal, bent until its cosine to the viewer is at least kLeastCosine: a normal map, or interpolation on a
// coarse mesh, may turn it away from a viewer who sees the surface. out_: unit, to the viewer.
CONSTANT float kLeastCosine = 0.01;
vec3 normalTowards(vec3 normal, vec3 out_) {
  float cosine = dot(normal, out_);
  return cosine < kLeastCosine ? normalize(normal + (kLeastCosine - cosine) * out_) : normal;
}

// What the G-buffer keeps of a surface: reflectance, lobe, and radiance in W/(sr m^2).
struct FullSurface {
  vec3 albedo;  // of the diffuse layer, as the eye sees it
  Gloss gloss;
  vec3 emission;
};

// The surface with all light that leaves it scaled by a factor.
FullSurface brighter(FullSurface s, vec3 factor) {
  float mean = dot(factor, vec3(1.0 / 3.0));
  s.albedo *= factor;
  s.gloss.f0 *= factor;
  s.gloss.f90 *= mean;
  s.gloss.dielectricF0 *= mean;
  s.emission *= factor;
  return s;
}

// A material at a point of a triangle. weights: of all three vertices; cosine: between the shading normal and the
// viewer; leastRoughness: the surface and its coat are treated as at least this rough.
FullSurface fullSurface(uint material, uvec4 triangle, vec3 weights, TextureCoordinates at, float cosine,
                        float leastRoughness) {
  int first = int(material) * kMaterialTexels, surface = int(frame.firstSurface) + int(material) * kSurfaceTexels;
  vec4 base = texelOf(sceneMaterials, surface), specular = texelOf(sceneMaterials, surface + 1);
  vec4 factors = texelOf(sceneMaterials, surface + 2), coat = texelOf(sceneMaterials, surface + 3);
  vec3 color = vec3(base) * vec3(textureAt(first + kColorTexture, at)) * vertexColor(triangle, weights);
  color = min(color, 1.0);
  vec4 metallicRoughness = mapTexture(surface + kMetallicRoughnessTexture, at);
  float metallic = base.a * metallicRoughness.b, roughness = max(factors.x * metallicRoughness.g, leastRoughness);
  float f90 = specular.a * extensionTexture(surface + kSpecularTexture, at).a;
  vec3 f0 = min(vec3(specular) * vec3(extensionTexture(surface + kSpecularColorTexture, at)), 1.0) * f90;
  float transmission = factors.z * extensionTexture(surface + kTransmissionTexture, at).r;

  Gloss g = Gloss(mix(f0, color, metallic), mix(f90, 1.0, metallic), roughness, metallic, dot(f0, vec3(1.0 / 3.0)));
  MirrorAlbedo a = mirrorAlbedo(cosine, roughness), mean = meanMirrorAlbedo(roughness);
  Gloss dielectric = Gloss(f0, f90, roughness, 0.0, g.dielectricF0);
  vec3 albedo = color * ((1.0 - metallic) * (1.0 - transmission)) * (1.0 - surfaceAlbedo(dielectric, a, mean));

  // The coat takes light from what is below it, and joins its lobe.
  if (MATERIAL_DETAIL == 2 && coat.x > 0.0) {
    float share = coat.x * extensionTexture(surface + kClearcoatTexture, at).r;
    float coatRoughness =
        max(coat.y * extensionTexture(surface + kClearcoatRoughnessTexture, at).g, leastRoughness);
    MirrorAlbedo c = mirrorAlbedo(cosine, coatRoughness), coatMean = meanMirrorAlbedo(coatRoughness);
    float reflects = share * (0.04 * (c.all - c.dielectricF90) + c.dielectricF90);
    float onAverage = share * (0.04 * (coatMean.all - coatMean.dielectricF90) + coatMean.dielectricF90);
    float passes = (1.0 - reflects) * (1.0 - onAverage);
    float below = passes * dot(surfaceAlbedo(g, a, mean), vec3(1.0 / 3.0));
    albedo *= passes;
    g.f0 = g.f0 * passes + 0.04 * share;
    g.f90 = g.f90 * passes + share;
    g.dielectricF0 = g.dielectricF0 * passes + 0.04 * share;
    g.roughness = mix(roughness, coatRoughness, reflects / max(reflects + below, 1e-6));
  }

  vec3 emission = vec3(texelOf(sceneMaterials, first + 1));
  if (emission != vec3(0.0))
    emission *= vec3(textureAt(first + kEmissionTexture, at));
  if (factors.w > 0.0) return FullSurface(vec3(0.0), Gloss(vec3(0.0), 0.0, 1.0, 0.0, 0.0), factors.w * color);
  return FullSurface(albedo, g, emission);
}

#endif
