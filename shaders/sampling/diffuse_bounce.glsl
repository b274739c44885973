// The direction in which a diffuse surface continues an eye path.
//
// Needs vpls/paraboloid.glsl.
#ifndef FOVEA_DIFFUSE_BOUNCE_GLSL
#define FOVEA_DIFFUSE_BOUNCE_GLSL

// A direction around the shading normal, with a density in proportion to the cosine. u: uniform in [0, 1). A direction
// below the surface itself (possible because the shading normal is tilted) is mirrored up. As both normals point to the
// eye's side, it is then also above the shading plane.
vec3 diffuseBounce(vec3 normal, vec3 face, vec2 u) {
  float r = sqrt(u.x), phi = 6.28318530717959 * u.y;
  vec3 d = normalize(toWorld(orthonormalFrame(normal), vec3(r * cos(phi), r * sin(phi), sqrt(1.0 - u.x))));
  return d - 2.0 * min(dot(d, face), 0.0) * face;
}

#endif
