// Random numbers as a hash of (seed, frame, pass, index). The same functions as framework/base/random.h.
#ifndef FOVEA_RANDOM_GLSL
#define FOVEA_RANDOM_GLSL

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

#endif
