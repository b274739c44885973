// Random numbers as a hash of (seed, frame, pass, index): no generator has a state, so that the same frame gives the
// same numbers in any order. framework/base/random.h has the same functions in C++.
#ifndef FOVEA_RANDOM_GLSL
#define FOVEA_RANDOM_GLSL

#include "device/language.glsl"

// 32 random bits from a word (PCG-RXS-M-XS: Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 2020).
uint hashPcg(uint v) {
  uint state = v * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

// 32 random bits from two words, whose order matters.
uint hashCombine(uint a, uint b) { return hashPcg(a ^ hashPcg(b)); }

// A stream of random numbers. seed: frame.seed; frameIndex: frame.index; pass: a constant of the pass, which keeps its
// numbers apart from those of others; index: of the pixel, ray or the like. The stream is itself a random number, and
// hashCombine(stream, n) is its number n.
uint randomStream(uint seed, uint frameIndex, uint pass, uint index) {
  return hashCombine(hashCombine(hashCombine(seed, frameIndex), pass), index);
}

// A number that is uniform in [0, 1), from the upper 24 of 32 random bits.
float uniformFloat(uint bits) { return float(bits >> 8) * (1.0 / 16777216.0); }

// Point i of the R2 sequence, in [0, 1) (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
// start: its point 0, in 2^-32; kR2: its steps.
CONSTANT uvec2 kR2 = uvec2(3242174889u, 2447445414u);
vec2 r2Sequence(uvec2 start, uint i) {
  return vec2(uniformFloat(start.x + i * kR2.x), uniformFloat(start.y + i * kR2.y));
}

// Point `turn_` of the R2 sequence that starts at a random point of a stream.
vec2 streamSequence(uint stream, uint turn_) {
  return r2Sequence(uvec2(hashCombine(stream, 0u), hashCombine(stream, 1u)), turn_);
}

// A choice among things that are offered one after the other, each with a probability in proportion to its weight
// (weighted reservoir sampling). It starts as WeightedChoice(random, 0.0, 0.0). random: uniform in [0, 1), rescaled
// after each decision.
struct WeightedChoice {
  float random, sum, chosen;
};
// Whether what is offered replaces what was chosen before. weight: above 0.
bool takes(INOUT(WeightedChoice) choice, float weight) {
  choice.sum += weight;
  float chance = weight / choice.sum;
  bool takes_ = choice.random < chance;
  choice.random = takes_ ? choice.random / chance : (choice.random - chance) / (1.0 - chance);
  if (takes_) choice.chosen = weight;
  return takes_;
}
// Whether anything was offered.
bool isAnyChosen(WeightedChoice choice) { return choice.sum > 0.0; }
// 1 / probability of what was chosen; only if anything was.
float inverseProbability(WeightedChoice choice) { return choice.sum / choice.chosen; }

#endif
