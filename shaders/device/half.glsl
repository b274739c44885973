// Rounding to 16-bit floats. When a shader stores into an image of such floats, drivers may round towards zero, as
// lavapipe does: a running mean that is stored in every frame would lose 0.03% of its light each time.
#ifndef FOVEA_HALF_GLSL
#define FOVEA_HALF_GLSL

// The nearest numbers that 16-bit floats can hold. v: each component below 65520 in magnitude.
vec3 nearestHalf(vec3 v) {
  precise vec3 scaled = 8193.0 * v;  // splits off all but 11 bits (Dekker 1971)
  precise vec3 normal = scaled - (scaled - v);
  precise vec3 small = (v + 0.75) - 0.75;  // below 2^-14, multiples of 2^-24
  return mix(normal, small, lessThan(abs(v), vec3(6.103515625e-5)));
}

#endif
