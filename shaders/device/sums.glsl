// Sums that many invocations add to. They are kept as whole multiples of 2^-32, whose sum is the same in any order, in
// two words each, as devices need not have atomic 64-bit integers.
#ifndef FOVEA_DEVICE_SUMS_GLSL
#define FOVEA_DEVICE_SUMS_GLSL

// The number as a multiple of 2^-32; x: low word, y: high word. It is clamped to [0, 2^31]; sums must stay below 2^32.
uvec2 wholeNumber(float number) {
  float x = clamp(number, 0.0, 2147483648.0), whole = floor(x);
  return uvec2(uint(min((x - whole) * 4294967296.0, 4294967040.0)), uint(whole));
}

// Adds a float to a sum. low, high: its words in a buffer. (A low word that has become smaller than what was added has
// overflowed.)
#define ADD_TO_SUM(low, high, number)                              \
  {                                                                \
    uvec2 n_ = wholeNumber(number);                                \
    atomicAdd(high, n_.y + uint(atomicAdd(low, n_.x) + n_.x < n_.x)); \
  }

// The value of a sum.
float sumOf(uint low, uint high) { return float(high) + float(low) * (1.0 / 4294967296.0); }

#endif
