// Sums of numbers that many invocations add to, as whole numbers in 2^-32, which have the same sum in any order. They
// take two words, as devices need not have atomic integers of 64 bits.
#ifndef FOVEA_DEVICE_SUMS_GLSL
#define FOVEA_DEVICE_SUMS_GLSL

// x: low word. Numbers are cut off at 0 and 2^31, and sums must stay below 2^32.
uvec2 wholeNumber(float number) {
  float x = clamp(number, 0.0, 2147483648.0), whole = floor(x);
  return uvec2(uint(min((x - whole) * 4294967296.0, 4294967040.0)), uint(whole));
}

// low, high: words of a buffer. A low word that has become smaller than what was added has overflowed.
#define ADD_TO_SUM(low, high, number)                              \
  {                                                                \
    uvec2 n_ = wholeNumber(number);                                \
    atomicAdd(high, n_.y + uint(atomicAdd(low, n_.x) + n_.x < n_.x)); \
  }

float sumOf(uint low, uint high) { return float(high) + float(low) * (1.0 / 4294967296.0); }

#endif
