// How a pass registers itself, and how a plug-in declares the version of fovea for which it was compiled. fovea/pass.h
// includes this.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string_view>

namespace fovea {

// The version in CMakeLists.txt; the framework does not compile if the two differ.
constexpr std::string_view kVersion = "0.1.0";

// FOVEA_PASS puts this mark into the section `fovea_abi` of a plug-in. loadPlugin() reads it from the file before any
// code of the plug-in runs, because even static initialisers assume the layout of types that another version may have
// changed. The section holds one mark per pass. For the same reason the layout of the mark itself never changes.
struct alignas(64) Abi {
  char text[64];  // "fovea 0.1.0 0123456789abcdef", then zeros
  constexpr bool operator==(const Abi&) const = default;
};

// `sizes` are those of the types that a plug-in and the framework exchange. They differ if a header was changed without
// a new version, or if the plug-in was compiled with settings that change the types of the standard library.
constexpr Abi makeAbi(std::initializer_list<size_t> sizes) {
  Abi abi{};
  size_t length = 0;
  for (const char c : std::string_view("fovea ")) abi.text[length++] = c;
  for (const char c : kVersion) abi.text[length++] = c;
  abi.text[length++] = ' ';
  uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
  for (const size_t size : sizes) hash = (hash ^ size) * 0x100000001b3;
  for (int shift = 60; shift >= 0; shift -= 4) abi.text[length++] = "0123456789abcdef"[(hash >> shift) & 15];
  return abi;
}

}  // namespace fovea

namespace fovea::graph {

class Pass;
struct PassDeclaration;

// Adds a pass type to those known to the process. A declaration that is invalid, or that throws, is reported when the
// program starts or when the plug-in is loaded. Nothing after `abi` is read if that is the mark of another version.
struct Registration {
  Registration(const Abi& abi, const char* className, PassDeclaration (*declaration)(),
               std::unique_ptr<Pass> (*factory)());
};

}  // namespace fovea::graph

// Use this at namespace scope in the source file of the pass. The class provides `static
// fovea::graph::PassDeclaration declaration()`.
#define FOVEA_PASS(Class)                                                                            \
  [[gnu::used, gnu::section("fovea_abi")]] static constexpr ::fovea::Abi abi_##Class =               \
      ::fovea::graph::passAbi();                                                                     \
  static const ::fovea::graph::Registration registration_##Class(                                    \
      abi_##Class, #Class, []() -> ::fovea::graph::PassDeclaration { return Class::declaration(); }, \
      []() -> std::unique_ptr<::fovea::graph::Pass> { return std::make_unique<Class>(); })
