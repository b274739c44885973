// Where a diffuse surface sends an eye path. Needs common/paraboloid.glsl.
#ifndef FOVEA_DIFFUSE_BOUNCE_GLSL
#define FOVEA_DIFFUSE_BOUNCE_GLSL

// Cosine-weighted around `normal`. What would go below the surface itself (a shading normal leans) is mirrored up; as both
// normals point to the eye's side, that also stays above the shading normal.
vec3 diffuseBounce(vec3 normal, vec3 face, vec2 u) {
  float r = sqrt(u.x), phi = 6.28318530717959 * u.y;
  vec3 d = normalize(toWorld(orthonormalFrame(normal), vec3(r * cos(phi), r * sin(phi), sqrt(1.0 - u.x))));
  return d - 2.0 * min(dot(d, face), 0.0) * face;
}

#endif
