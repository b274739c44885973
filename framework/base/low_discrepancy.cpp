#include "framework/base/low_discrepancy.h"

#include <array>

#include "framework/base/random.h"

namespace fovea {
namespace {

constexpr uint32_t reverseBits(uint32_t x) {
  x = ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  return (x << 16) | (x >> 16);
}

// Random flips of each bit that depend on the lower bits only: nested uniform scrambling of a reversed fraction
// (Laine and Karras 2011, with the constants of Vegdahl, 2021).
constexpr uint32_t laineKarras(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

constexpr uint32_t nestedScramble(uint32_t fraction, uint32_t seed) {
  return reverseBits(laineKarras(reverseBits(fraction), seed));
}

using Directions = std::array<std::array<uint32_t, 32>, 4>;

// Direction numbers of the first four dimensions: primitive polynomials and initial values of Joe and Kuo, 2008.
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

// Point from the four bytes of its index: kByteTables[d][b][x] combines the direction numbers of the bits set in byte b.
using ByteTables = std::array<std::array<std::array<uint32_t, 256>, 4>, 4>;

constexpr ByteTables makeByteTables() {
  ByteTables tables{};
  for (uint32_t d = 0; d < 4; ++d)
    for (uint32_t byte = 0; byte < 4; ++byte)
      for (uint32_t x = 1; x < 256; ++x) {
        uint32_t low = 0;  // the lowest bit set; the table knows the rest
        while (!((x >> low) & 1u)) ++low;
        tables[d][byte][x] = tables[d][byte][x & (x - 1)] ^ kDirections[d][8 * byte + low];
      }
  return tables;
}

constexpr ByteTables kByteTables = makeByteTables();

uint32_t unscrambledPoint(uint32_t bits, uint32_t within) {
  const auto& t = kByteTables[within];
  return t[0][bits & 255u] ^ t[1][bits >> 8 & 255u] ^ t[2][bits >> 16 & 255u] ^ t[3][bits >> 24];
}

}  // namespace

uint32_t sobolBits(uint32_t index, uint32_t dimension, uint32_t seed) {
  const uint32_t group = dimension / 4, within = dimension % 4;
  // A nested scramble of the index permutes aligned blocks of every power-of-two length: nets stay nets, and the groups
  // become independent of one another.
  const uint32_t groupSeed = hashCombine(seed, group);
  const uint32_t bits = nestedScramble(index, groupSeed);
  return nestedScramble(unscrambledPoint(bits, within), hashCombine(groupSeed, within + 1));
}

float sobol(uint32_t index, uint32_t dimension, uint32_t seed) {
  return uniformFloat(sobolBits(index, dimension, seed));
}

std::array<float, 2> sobolPair(uint32_t index, uint32_t dimension, uint32_t seed) {
  const uint32_t group = dimension / 4, within = dimension % 4;
  const uint32_t groupSeed = hashCombine(seed, group), bits = nestedScramble(index, groupSeed);
  const auto at = [&](uint32_t d) {
    return uniformFloat(nestedScramble(unscrambledPoint(bits, d), hashCombine(groupSeed, d + 1)));
  };
  return {at(within), at(within + 1)};
}

}  // namespace fovea
