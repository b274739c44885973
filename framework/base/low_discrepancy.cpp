#include "framework/base/low_discrepancy.h"

#include <array>

#include "framework/base/random.h"

namespace fovea {
namespace {

constexpr uint32_t reverseBits(uint32_t x) {
  x = ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  return __builtin_bswap32(x);
}

// Flips each bit randomly depending on the lower bits only: nested uniform scrambling of a reversed fraction (Laine
// and Karras 2011, with the constants of Vegdahl, 2021).
constexpr uint32_t laineKarras(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

using Directions = std::array<std::array<uint32_t, 32>, 4>;

// Direction numbers of the first four dimensions, from the primitive polynomials and initial
// values of Joe and Kuo, 2008.
constexpr Directions makeDirections() {
  struct Polynomial {
    uint32_t degree, coefficients, initial[3];
  };
  constexpr Polynomial kPolynomials[3] = {{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}};
  Directions v{};
  for (uint32_t i = 0; i < 32; ++i) v[0][i] = 1u << (31 - i);
  for (uint32_t d = 1; d < 4; ++d) {
    const Polynomial& p = kPolynomials[d - 1];
    for (uint32_t i = 0; i < 32; ++i) {
      if (i < p.degree) {
        v[d][i] = p.initial[i] << (31 - i);
        continue;
      }
      uint32_t x = v[d][i - p.degree] ^ (v[d][i - p.degree] >> p.degree);
      for (uint32_t k = 1; k < p.degree; ++k)
        if ((p.coefficients >> (p.degree - 1 - k)) & 1u) x ^= v[d][i - k];
      v[d][i] = x;
    }
  }
  return v;
}

constexpr Directions kDirections = makeDirections();

// Points are computed with the bits of their fractions reversed, which is the form in which they are scrambled.
// kByteTables[d][b][x] combines the direction numbers of dimension d + 2 for the bits set in byte b of the index.
using ByteTables = std::array<std::array<std::array<uint32_t, 256>, 4>, 2>;

constexpr ByteTables makeByteTables() {
  ByteTables tables{};
  for (uint32_t d = 0; d < 2; ++d)
    for (uint32_t byte = 0; byte < 4; ++byte)
      for (uint32_t x = 1; x < 256; ++x) {
        uint32_t low = 0;  // the lowest bit set; the rest is in the table
        while (!((x >> low) & 1u)) ++low;
        tables[d][byte][x] = tables[d][byte][x & (x - 1)] ^ reverseBits(kDirections[d + 2][8 * byte + low]);
      }
  return tables;
}

constexpr ByteTables kByteTables = makeByteTables();

constexpr uint32_t unscrambledPoint(uint32_t index, uint32_t within) {
  // The direction numbers of the first dimension form the unit matrix. Those of the second form Pascal's triangle
  // modulo 2, which is a product of five nearly empty matrices.
  if (within == 0) return index;
  if (within == 1) {
    uint32_t x = index ^ index >> 16;
    x ^= (x & 0xff00ff00u) >> 8;
    x ^= (x & 0xf0f0f0f0u) >> 4;
    x ^= (x & 0xccccccccu) >> 2;
    return x ^ (x & 0xaaaaaaaau) >> 1;
  }
  const auto& t = kByteTables[within - 2];
  return t[0][index & 255u] ^ t[1][index >> 8 & 255u] ^ t[2][index >> 16 & 255u] ^ t[3][index >> 24];
}

// A nested scramble of the index permutes aligned blocks of every power-of-two length. Nets thus stay nets, and the
// groups become independent of one another.
struct Group {
  uint32_t seed, index;
  Group(uint32_t i, uint32_t group, uint32_t s)
      : seed(hashCombine(s, group)), index(reverseBits(laineKarras(reverseBits(i), seed))) {}
  uint32_t bits(uint32_t within) const {
    return reverseBits(laineKarras(unscrambledPoint(index, within), hashCombine(seed, within + 1)));
  }
};

}  // namespace

uint32_t sobolBits(uint32_t index, uint32_t dimension, uint32_t seed) {
  return Group(index, dimension / 4, seed).bits(dimension % 4);
}

float sobol(uint32_t index, uint32_t dimension, uint32_t seed) {
  return uniformFloat(sobolBits(index, dimension, seed));
}

std::array<float, 2> sobolPair(uint32_t index, uint32_t dimension, uint32_t seed) {
  const Group group(index, dimension / 4, seed);
  const uint32_t within = dimension % 4;
  return {uniformFloat(group.bits(within)), uniformFloat(group.bits(within + 1))};
}

}  // namespace fovea
