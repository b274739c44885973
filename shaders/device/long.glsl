// Unsigned integers of 64 bits, `Long`: those of the device, or pairs of 32-bit integers where it has none. Both wrap
// around.
#ifndef FOVEA_DEVICE_LONG_GLSL
#define FOVEA_DEVICE_LONG_GLSL

#ifdef WITHOUT_shaderInt64
struct Long { uint low, high; };

// Conversions from and to 32 bits (lowBits() drops the upper half), and a < b.
Long longOf(uint x) { return Long(x, 0u); }
uint lowBits(Long x) { return x.low; }
bool isLess(Long a, Long b) { return a.high == b.high ? a.low < b.low : a.high < b.high; }

// a + b.
Long plus(Long a, Long b) {
  uint carry, low = uaddCarry(a.low, b.low, carry);
  return Long(low, a.high + b.high + carry);
}

// a - b.
Long minus(Long a, Long b) {
  uint borrow, low = usubBorrow(a.low, b.low, borrow);
  return Long(low, a.high - b.high - borrow);
}

// a b.
Long times(Long a, uint b) {
  uint high, low;
  umulExtended(a.low, b, high, low);
  return Long(low, high + a.high * b);
}

// x / 2^bits, rounded down; 0 < bits < 32.
Long shiftedRight(Long x, int bits) { return Long(x.low >> bits | x.high << (32 - bits), x.high >> bits); }

// a / b, rounded down; 0 < b < 2^63.
Long dividedBy(Long a, Long b) {
  Long rest = longOf(0u), quotient = longOf(0u);
  for (int bit = 0; bit < 64; ++bit) {
    rest = Long(rest.low << 1 | a.high >> 31, rest.high << 1 | rest.low >> 31);
    a = Long(a.low << 1, a.high << 1 | a.low >> 31);
    bool fits = !isLess(rest, b);
    if (fits) rest = minus(rest, b);
    quotient = Long(quotient.low << 1 | uint(fits), quotient.high << 1 | quotient.low >> 31);
  }
  return quotient;
}
#else
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#define Long uint64_t

Long longOf(uint x) { return uint64_t(x); }
uint lowBits(Long x) { return uint(x); }
bool isLess(Long a, Long b) { return a < b; }
Long plus(Long a, Long b) { return a + b; }
Long times(Long a, uint b) { return a * b; }
Long shiftedRight(Long x, int bits) { return x >> bits; }
Long dividedBy(Long a, Long b) { return a / b; }
#endif

#endif
