// Microfacet normals that a direction sees. Directions are unit, in a frame whose z is the normal of the surface, and
// point away from it; alpha is GGX's.
#ifndef FOVEA_VISIBLE_NORMALS_GLSL
#define FOVEA_VISIBLE_NORMALS_GLSL

#include "scene/scene.glsl"

// Smith's Lambda: 1 / (1 + Lambda) of the microfacets that face v are not hidden by others (Heitz 2014, Eq. 72).
float smithLambda(vec3 v, float alpha) {
  return 0.5 * (sqrt(1.0 + alpha * alpha * dot(vec2(v), vec2(v)) / max(v.z * v.z, 1e-14)) - 1.0);
}

// A random microfacet normal among those that `out_` sees (Heitz, "Sampling the GGX Distribution of Visible Normals",
// JCGT 2018). u: uniform in [0, 1).
vec3 sampleVisibleNormal(vec3 out_, float alpha, vec2 u) {
  vec3 stretched = normalize(vec3(alpha * vec2(out_), out_.z));
  float side2 = dot(vec2(stretched), vec2(stretched));
  vec3 a = side2 > 0.0 ? vec3(-stretched.y, stretched.x, 0.0) * inversesqrt(side2) : vec3(1.0, 0.0, 0.0);
  vec3 b = cross(stretched, a);
  float r = sqrt(u.x), phi = 2.0 * kPi * u.y, s = 0.5 * (1.0 + stretched.z), x = r * cos(phi);
  float y = mix(sqrt(max(1.0 - x * x, 0.0)), r * sin(phi), s);
  vec3 n = x * a + y * b + sqrt(max(1.0 - x * x - y * y, 0.0)) * stretched;
  return normalize(vec3(alpha * vec2(n), max(n.z, 1e-7)));
}

#endif
