// A surface that the eye sees, and what it reflects of the light of one of the scene's lights. Define: GLOSS 0/1, 1 for
// full materials: in place of rho / pi stands all that a surface reflects.
#if GLOSS
#include "materials/gloss.glsl"
#endif
#include "scene/scene.glsl"
#include "screen/gbuffer.glsl"

// Images rather than textures, because on lavapipe a load from a texture costs several times as much.
SURFACES(gbuffer, surfaceAt)
IMAGE(rgba16f, readonly, image2D, gbufferNormal);
IMAGE(rg16_snorm, readonly, image2D, gbufferFace);
IMAGE(rgba16f, readonly, image2D, gbufferAlbedo);
IMAGE(rgba16f, readonly, image2D, gbufferEmission);
#if GLOSS
IMAGE(rgba16f, readonly, image2D, gbufferSpecular);
#endif

struct Receiver {
  vec4 place;  // xyz: position; w: distance from the eye, 0 in the background
  vec3 normal, face;
  vec3 albedo, emission;
#if GLOSS
  Reflector reflector;
#endif
};

Receiver receiverAt(ivec2 p) {
  Receiver r;
  vec4 normal = imageLoad(gbufferNormal, p), albedo = imageLoad(gbufferAlbedo, p),
       emission = imageLoad(gbufferEmission, p);
  r.place = surfaceAt(p);
  r.normal = vec3(normal);
  r.face = octDecode(vec2(imageLoad(gbufferFace, p)));
  r.albedo = vec3(albedo);
  r.emission = vec3(emission);
#if GLOSS
  Gloss gloss = glossOf(imageLoad(gbufferSpecular, p), normal.a, albedo.a, emission.a);
  r.reflector = reflectorOf(gloss, vec3(normal), normalize(view.eye - vec3(r.place)));
#endif
  return r;
}

// What the surface makes of light without occlusion: the irradiance or, with full materials, the radiance towards the
// eye.
vec3 response(Receiver r, LightSample e) {
  vec3 irradiance = e.irradiance * max(dot(r.normal, e.direction), 0.0);
#if GLOSS
  return irradiance * reflected(r.reflector, e.direction, r.albedo);
#else
  return irradiance;
#endif
}

// Radiance towards the eye from the sum of the responses.
vec3 radianceOf(Receiver r, vec3 sum) {
#if GLOSS
  return min(r.emission + sum, 65504.0);
#else
  return min(r.emission + r.albedo * sum * (1.0 / kPi), 65504.0);
#endif
}
