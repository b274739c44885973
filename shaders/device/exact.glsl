// Quotients and square roots that are the same on every device. Vulkan rounds sums, differences and products as IEEE
// 754 does, but a quotient may be off by 2.5 units in the last place. Whether a surface ends in a cell or beside it
// would then depend on the device. DEVICE_QUOTIENT and DEVICE_ROOT are the device's own operations; a test puts less
// accurate ones in their place.
#ifndef FOVEA_EXACT_GLSL
#define FOVEA_EXACT_GLSL

#ifndef DEVICE_QUOTIENT
#define DEVICE_QUOTIENT(a, b) ((a) / (b))
#define DEVICE_ROOT(x) sqrt(x)
#endif

// c - a b, for a product near c (T. J. Dekker, "A Floating-Point Technique for Extending the Available Precision",
// Numerische Mathematik 18, 1971). Exact for numbers from 1e-15 to 1e15.
float restOf(float c, float a, float b) {
  precise float product = a * b;
  precise float scaledA = 4097.0 * a;
  precise float scaledB = 4097.0 * b;
  precise float highA = scaledA - (scaledA - a);
  precise float highB = scaledB - (scaledB - b);
  precise float lowA = a - highA;
  precise float lowB = b - highB;
  precise float lost = ((highA * highB - product) + highA * lowB + lowA * highB) + lowA * lowB;
  precise float rest = (c - product) - lost;
  return rest;
}

// The estimate with its correction, which is NaN where the estimate is 0 or infinite.
float corrected(float estimate, float correction) {
  precise float sum = estimate + correction;
  return abs(correction) < abs(estimate) ? sum : estimate;
}

// a / b, rounded to the nearest float.
float quotient(float a, float b) {
  float estimate = DEVICE_QUOTIENT(a, b);
  float near = corrected(estimate, DEVICE_QUOTIENT(restOf(a, estimate, b), b));
  // The correction is itself a little off, which may leave the second nearest number.
  float rest = restOf(a, near, b);
  bool outwards = ((rest < 0.0) != (b < 0.0)) == (near < 0.0);
  float other = intBitsToFloat(floatBitsToInt(near) + (outwards ? 1 : -1));
  return abs(restOf(a, other, b)) < abs(rest) ? other : near;
}

// The square root of x >= 0, rounded to the nearest float. If DEVICE_ROOT is off by two units in the last place, one
// result in some millions is off by one.
float root(float x) {
  float estimate = DEVICE_ROOT(x);
  return corrected(estimate, DEVICE_QUOTIENT(0.5 * restOf(x, estimate, estimate), estimate));
}

#endif
