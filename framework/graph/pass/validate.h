// Checks a declaration for consistency when it is registered, so that a graph never contains a contradictory pass.
#pragma once

#include "fovea/pass.h"

namespace fovea::graph {

// Throws Error(Internal) listing every mistake.
void validateDeclaration(const PassDeclaration& declaration);
// Adds every mistake, at its place in the pass's file.
void validateDeclaration(const PassDeclaration& declaration, Diagnostics& diagnostics);

inline constexpr Usage kWriteUsages = Usage::StorageWrite | Usage::ColorAttachment | Usage::DepthAttachment |
                                      Usage::TransferWrite | Usage::HostWrite;
inline constexpr Usage kReadUsages = Usage::Sampled | Usage::StorageRead | Usage::Uniform | Usage::TexelRead |
                                     Usage::Indirect | Usage::TransferRead | Usage::HostRead;
inline constexpr Usage kImageUsages = Usage::Sampled | Usage::StorageRead | Usage::StorageWrite |
                                      Usage::ColorAttachment | Usage::DepthAttachment | Usage::TransferRead |
                                      Usage::TransferWrite | Usage::HostRead | Usage::HostWrite;
inline constexpr Usage kBufferUsages = Usage::StorageRead | Usage::StorageWrite | Usage::Uniform |
                                       Usage::TexelRead | Usage::Indirect | Usage::TransferRead |
                                       Usage::TransferWrite | Usage::HostRead | Usage::HostWrite;
inline constexpr Usage kHostUsages = Usage::HostRead | Usage::HostWrite;

}  // namespace fovea::graph
