// Octahedral encoding of unit vectors (Meyer et al., "On Floating-Point Normal Vectors", EGSR 2010).
#ifndef FOVEA_OCTAHEDRAL_GLSL
#define FOVEA_OCTAHEDRAL_GLSL

// The code of a vector of any length above 0, both components in [-1, 1].
vec2 octEncode(vec3 n) {
  n /= abs(n.x) + abs(n.y) + abs(n.z);
  vec2 s = vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
  return n.z >= 0.0 ? vec2(n) : (1.0 - abs(vec2(n.y, n.x))) * s;
}

// The unit vector of a code.
vec3 octDecode(vec2 e) {
  vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
  float t = max(-n.z, 0.0);
  n += vec3(n.x >= 0.0 ? -t : t, n.y >= 0.0 ? -t : t, 0.0);
  return normalize(n);
}

#endif
