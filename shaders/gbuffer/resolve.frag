// The surface of each pixel from the triangle visible there: the ray through the pixel's centre is intersected with
// the triangle's plane, so that positions have none of the rasteriser's snapping and interpolation (visibility
// buffer, Burns and Hunt, JCGT 2013).
#include "common/pixel_ray.glsl"
#include "common/scene.glsl"

uniform utexture2D seen;
layout(location = 0) out vec4 gbufferPosition;
layout(location = 1) out vec4 gbufferNormal;
layout(location = 2) out vec2 gbufferFace;
layout(location = 3) out vec4 gbufferAlbedo;
layout(location = 4) out vec4 gbufferEmission;
layout(location = 5) out uint gbufferId;

const uint kNothing = 0xffffffffu;
const float kMaxHalf = 65504.0;

// Weights of b and c where the line through the eye meets the plane of a, b, c (Moeller and Trumbore 1997). The
// rasteriser accepts some pixels whose centre just misses the triangle; they get the nearest point inside.
vec2 barycentrics(vec3 ray, vec3 a, vec3 edgeB, vec3 edgeC) {
  vec3 p = cross(ray, edgeC);
  float determinant = dot(edgeB, p);
  if (determinant == 0.0) return vec2(1.0 / 3.0);
  vec3 s = view.eye - a;
  vec2 w = max(vec2(dot(s, p), dot(ray, cross(s, edgeB))) / determinant, 0.0);
  return w / max(w.x + w.y, 1.0);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  uint index = texelFetch(seen, p, 0).r;
  bool background = index == kNothing;  // computed as if it were triangle 0: a CPU device runs both sides of a branch
  uvec4 triangle = sceneTriangle(background ? 0u : index);
  vec3 a = scenePosition(triangle.x), edgeB = scenePosition(triangle.y) - a, edgeC = scenePosition(triangle.z) - a;
  vec2 w = barycentrics(pixelRay(p), a, edgeB, edgeC);
  vec3 weights = vec3(1.0 - w.x - w.y, w);
  vec3 position = a + w.x * edgeB + w.y * edgeC;

  vec3 face = normalize(cross(edgeB, edgeC));
  if (dot(face, view.eye - a) < 0.0) face = -face;
  vec3 normal = mat3(sceneNormal(triangle.x), sceneNormal(triangle.y), sceneNormal(triangle.z)) * weights;
  normal = dot(normal, normal) > 1e-12 ? normalize(normal) : face;
  if (dot(normal, face) < 0.0) normal = -normal;
  vec2 uv = mat3x2(sceneUv(triangle.x), sceneUv(triangle.y), sceneUv(triangle.z)) * weights;
  uint material = materialOf(triangle);
  vec3 albedo = materialReflectance(material, uv).rgb;
#if EMISSION_TEXTURES
  vec3 emission = materialEmission(material, uv);
#else
  vec3 emission = loadMaterial(material).emission;
#endif
#if ENVIRONMENT_MAP
  if (background) emission = environmentRadiance(normalize(pixelRay(p)));
#else
  if (background) emission = frame.environment;
#endif

  gbufferPosition = background ? vec4(0.0) : vec4(position, distance(position, view.eye));
  gbufferNormal = background ? vec4(0.0) : vec4(normal, 0.0);
  gbufferFace = background ? vec2(0.0) : octEncode(face);
  gbufferAlbedo = background ? vec4(0.0) : vec4(albedo, 0.0);
  gbufferEmission = vec4(min(emission, kMaxHalf), 0.0);
  gbufferId = background ? kNothing : triangle.w;
}
