// Binding numbers inside SPIR-V: reading and changing the decorations in place.
#pragma once

#include <cstdint>
#include <vector>

namespace fovea::gpu {

// A resource without layout(binding) leaves the compiler with a number from here on.
inline constexpr uint32_t kAutomaticBinding = 1u << 15;

struct BindingDecoration {
  uint32_t variable = 0;
  uint32_t set = 0, binding = 0;
  size_t word = 0;  // where the binding number stands
};

std::vector<BindingDecoration> bindingDecorations(const std::vector<uint32_t>& spirv);

}  // namespace fovea::gpu
