// Rounds to the nearest number that a 16-bit float holds. Drivers may cut off what an image of such has no room for, as
// lavapipe does: a mean that returns to its image in every frame would lose 0.03% of the light each time.
#ifndef FOVEA_HALF_GLSL
#define FOVEA_HALF_GLSL

vec3 nearestHalf(vec3 v) {
  precise vec3 scaled = 8193.0 * v;  // splits off all but 11 bits (Dekker 1971)
  precise vec3 normal = scaled - (scaled - v);
  precise vec3 small = (v + 0.75) - 0.75;  // below 2^-14, multiples of 2^-24
  return mix(normal, small, lessThan(abs(v), vec3(6.103515625e-5)));
}

#endif
