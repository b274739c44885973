// Random numbers as a hash of (seed, frame, pass, index). The same functions as framework/base/random.h.
#ifndef FOVEA_RANDOM_GLSL
#define FOVEA_RANDOM_GLSL

#include "device/language.glsl"

uint hashPcg(uint v) {
  uint state = v * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

uint hashCombine(uint a, uint b) { return hashPcg(a ^ hashPcg(b)); }

uint randomStream(uint seed, uint frameIndex, uint pass, uint index) {
  return hashCombine(hashCombine(hashCombine(seed, frameIndex), pass), index);
}

// Uniform in [0, 1), with 24 bits.
float uniformFloat(uint bits) { return float(bits >> 8) * (1.0 / 16777216.0); }

// Steps of the R2 sequence (Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018), in 2^-32.
CONSTANT uvec2 kR2 = uvec2(3242174889u, 2447445414u);
vec2 r2Sequence(uvec2 start, uint i) { return vec2(uniformFloat(start.x + i * kR2.x), uniformFloat(start.y + i * kR2.y)); }

// Point `turn_` of the R2 sequence, whose starting point is drawn from `stream`.
vec2 streamSequence(uint stream, uint turn_) {
  return r2Sequence(uvec2(hashCombine(stream, 0u), hashCombine(stream, 1u)), turn_);
}

// A choice among things that are offered one after the other, each in proportion to its weight; the same as
// WeightedChoice of framework/base/weighted_choice.h. random: uniform in [0, 1), rescaled after each decision.
struct WeightedChoice {
  float random, sum, chosen;
};
// Whether what is offered now replaces what was chosen before. weight: above 0.
bool takes(INOUT(WeightedChoice) choice, float weight) {
  choice.sum += weight;
  float chance = weight / choice.sum;
  bool takes_ = choice.random < chance;
  choice.random = takes_ ? choice.random / chance : (choice.random - chance) / (1.0 - chance);
  if (takes_) choice.chosen = weight;
  return takes_;
}
bool isAnyChosen(WeightedChoice choice) { return choice.sum > 0.0; }
// 1 over the probability of what was chosen; only if there is anything.
float inverseProbability(WeightedChoice choice) { return choice.sum / choice.chosen; }

#endif
