// Reads and changes binding numbers in SPIR-V; decorations are changed in place.
#pragma once

#include <cstdint>
#include <vector>

namespace fovea::gpu {

// The compiler assigns numbers from here on to resources without layout(binding).
inline constexpr uint32_t kAutomaticBinding = 1u << 15;

struct BindingDecoration {
  uint32_t variable = 0;
  uint32_t set = 0, binding = 0;
  size_t word = 0;  // index of the word that holds the binding number
};

std::vector<BindingDecoration> bindingDecorations(const std::vector<uint32_t>& spirv);

}  // namespace fovea::gpu
