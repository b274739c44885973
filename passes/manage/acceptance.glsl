// Importance in fixed point and the test of Eq. 1, in integers only, so that every device and
// tests/passes/manage_reference.h give the same bits.
#ifndef FOVEA_MANAGE_ACCEPTANCE_GLSL
#define FOVEA_MANAGE_ACCEPTANCE_GLSL

const uint kImportanceMax = 0xffffffu;

// 24 bits: floor(2^24 I), at most 2^24 - 1; NaN counts as 0.
uint quantiseImportance(float importance) {
  return importance > 0.0 ? min(uint(min(importance, 1.0) * 16777216.0), kImportanceMax) : 0u;
}

// Light in 24 bits, up to 64 times what is displayed as white.
uint quantiseLight(float luminance, float exposure) {
  precise float shown = luminance * exposure;
  return quantiseImportance(shown * 0.015625);
}

// floor(2^24 a / b) for a < b < 2^24.
uint ratio24(uint a, uint b) {
  uint quotient = 0u;
  for (int bit = 0; bit < 24; ++bit) {
    a <<= 1;
    quotient <<= 1;
    if (a >= b) {
      a -= b;
      quotient |= 1u;
    }
  }
  return quotient;
}

// floor(a b / 2^24).
uint multiply24(uint a, uint b) {
  uint high, low;
  umulExtended(a, b, high, low);
  return high << 8 | low >> 24;
}

// 2^24 (1 - cos(pi/2 x)) for x in units of 2^-24, x < 1: the first six terms of the power series in x^2, each
// coefficient (pi/2)^2k / (2k)! in units of 2^-24. Off by less than 3 of these units.
uint cosineProbability(uint x) {
  uint y = multiply24(x, x);
  uint p = 423u - multiply24(y, 8u);
  p = 15423u - multiply24(y, p);
  p = 350031u - multiply24(y, p);
  p = 4255868u - multiply24(y, p);
  p = 20698061u - multiply24(y, p);
  return multiply24(y, p);
}

// Eq. 1: accept with probability p(min(C, 1)), C = I / previous I. u: 24 random bits. The linear test u < C is
// multiplied out; if the previous I is 0, it accepts when I > 0.
bool acceptedLinear(uint importance, uint before, uint u) {
  uint high, low;
  umulExtended(u, before, high, low);
  uint limitHigh = importance >> 8, limitLow = importance << 24;
  return high < limitHigh || (high == limitHigh && low < limitLow);
}

bool acceptedCosine(uint importance, uint before, uint u) {
  if (importance >= before) return importance > 0u;
  return u < cosineProbability(ratio24(importance, before));
}

#endif
