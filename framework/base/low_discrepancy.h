// Quasi-random numbers: Owen-scrambled Sobol' points, computed from an index alone, in any order. Any number of
// dimensions is possible by padding: each group of four dimensions is an independently shuffled and scrambled 4-D
// Sobol' sequence (Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020).
#pragma once

#include <array>
#include <cstdint>

namespace fovea {

// Coordinate `dimension` of point `index` as a 32-bit fraction. Every prefix whose length is a power of two is a
// (0,2)-net in the first two dimensions of a group, and every single dimension is stratified. Different seeds give
// independent points, each uniform in the unit cube, so that means over the points are unbiased.
uint32_t sobolBits(uint32_t index, uint32_t dimension, uint32_t seed);

// The same as a number in [0, 1) with 24 bits.
float sobol(uint32_t index, uint32_t dimension, uint32_t seed);

// Two coordinates of the same group, `dimension` and the next one, at less than the cost of two calls.
std::array<float, 2> sobolPair(uint32_t index, uint32_t dimension, uint32_t seed);

}  // namespace fovea
