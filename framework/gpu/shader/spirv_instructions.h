// The instructions of a SPIR-V module, one after another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fovea::gpu {

inline constexpr size_t kSpirvHeaderWords = 5;
inline constexpr size_t kSpirvIdBound = 3;  // index of the word that all ids lie below

// Calls `visit(opcode, words, index of the first word)`. The first of the words holds their number and the opcode.
template <class Visit>
void eachInstruction(const std::vector<uint32_t>& spirv, const Visit& visit) {
  for (size_t i = kSpirvHeaderWords; i < spirv.size();) {
    const uint32_t count = spirv[i] >> 16;
    if (count == 0 || count > spirv.size() - i) return;
    visit(spirv[i] & 0xffffu, std::span(spirv).subspan(i, count), i);
    i += count;
  }
}

}  // namespace fovea::gpu
