// Quasi-random numbers: Owen-scrambled Sobol' points, the same as framework/base/low_discrepancy.h, which explains
// them.
#ifndef FOVEA_SOBOL_GLSL
#define FOVEA_SOBOL_GLSL

#include "sampling/random.glsl"

// Flips each bit depending on a seed and the lower bits (Laine and Karras 2011, with the constants of Vegdahl, 2021).
uint laineKarras(uint x, uint seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16u) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

// The bits of the fraction in reverse. The direction numbers of Joe and Kuo, 2008, follow from the ones before; those
// of the first dimension are the unit matrix.
uint unscrambledSobol(uint index, uint within) {
  if (within == 0u) return index;
  uint x = 0u;
  // The direction numbers of this and the next two bits.
  uint a = 1u, b = 3u, c = within == 1u ? 5u : within == 2u ? 6u : 4u;
  for (uint bit = 0u; bit < 32u; ++bit) {
    if ((index >> bit & 1u) != 0u) x ^= a;
    uint next = within == 1u ? c ^ c << 1u : within == 2u ? c ^ b ^ b << 2u : b ^ a ^ a << 3u;
    a = b;
    b = c;
    c = next;
  }
  return x;
}

// Coordinate `dimension` of point `index`, in [0, 1).
float sobol(uint index, uint dimension, uint seed) {
  uint group = hashCombine(seed, dimension / 4u), within = dimension % 4u;
  uint shuffled = bitfieldReverse(laineKarras(bitfieldReverse(index), group));
  uint point = laineKarras(unscrambledSobol(shuffled, within), hashCombine(group, within + 1u));
  return uniformFloat(bitfieldReverse(point));
}

#endif
