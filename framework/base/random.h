// Random numbers as a hash of (seed, frame, pass, index): the same everywhere, in any order, on any thread.
// shaders/sampling/random.glsl holds the same functions for shaders; tests/unit/random_test.cpp keeps them equal.
#pragma once

#include <cstdint>

namespace fovea {

// PCG-RXS-M-XS 32-bit output function used as an integer hash (Jarzynski and Olano, JCGT 2020, "pcg").
constexpr uint32_t hashPcg(uint32_t v) {
  const uint32_t state = v * 747796405u + 2891336453u;
  const uint32_t word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

constexpr uint32_t hashCombine(uint32_t a, uint32_t b) { return hashPcg(a ^ hashPcg(b)); }

// The key of one random stream. Number k of stream s is uniformFloat(hashCombine(s, k)).
constexpr uint32_t randomStream(uint32_t seed, uint32_t frame, uint32_t pass, uint32_t index) {
  return hashCombine(hashCombine(hashCombine(seed, frame), pass), index);
}

// A number in [0, 1) with 24 bits.
constexpr float uniformFloat(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

}  // namespace fovea
