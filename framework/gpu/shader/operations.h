// The floating-point operations of a shader, read off its SPIR-V, and a variant of the shader that counts them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "framework/gpu/shader/shader.h"

namespace fovea::gpu {

// Instructions that run one after another without a branch in between.
struct InstructionBlock {
  size_t begin = 0;         // the word before which instructions can be inserted that run first
  uint32_t operations = 0;  // floating-point operations of one run
};

// The blocks of a module, in its order. The number of operations is the least that a device needs. Vectors and matrices
// count their components; a fused multiply-add counts 2, and a dot product of n components 2n - 1. For each component, a
// root, a sine, a power of two or a logarithm to the base 2 counts 1, pow() and normalize() count 3. Nothing is counted
// for signs, absolute values, clamps, conversions, comparisons, integers, texture samples and ray queries.
std::vector<InstructionBlock> instructionBlocks(const std::vector<uint32_t>& spirv);

// The storage buffer of set 0 in which a counting shader adds up its operations: a number of 64 bits, the low word
// first. It is no name in GLSL, so that it cannot be that of a port.
inline constexpr const char* kOperationsBinding = "operations of shaders";
inline constexpr uint64_t kOperationsBytes = 8;

// The same shader, optimised, so that what compilers leave out is not counted, with an addition to a variable of the
// invocation in each block and one to the buffer at its end. It computes the same, but for rounding.
std::shared_ptr<const CompiledShader> countingShader(const CompiledShader& shader);

}  // namespace fovea::gpu
