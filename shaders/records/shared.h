// What lets one header declare records and constants for C++ and GLSL alike. Such a header writes its declarations
// between SHARED_BEGIN, which names the namespace that they have in C++, and SHARED_END, in the types that GLSL has,
// which C++ takes from glm.
//
// A record pairs every vec3 with a scalar behind it. Then its members have the same offsets in C++, in a storage buffer
// (std430), in a uniform buffer (std140) and in a texel buffer of four components per texel.
#pragma once

#ifdef __cplusplus

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

namespace fovea::glsl {

using glm::mat4;
using glm::uvec2;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;

}  // namespace fovea::glsl

#define SHARED_BEGIN(space) \
  namespace space {         \
  using namespace fovea::glsl;
#define SHARED_END }
#define SHARED_CONSTANT inline constexpr
// The value of a member that nothing else is said about; GLSL has no such defaults.
#define SHARED_DEFAULT(value) \
  { value }
#define SHARED_ZERO SHARED_DEFAULT(0)
// Checks the bytes of a record, and the place of a member in it, in C++.
#define SHARED_SIZE(record, bytes) static_assert(sizeof(record) == (bytes));
#define SHARED_OFFSET(record, member, bytes) static_assert(offsetof(record, member) == (bytes));

#else

// SHARED_BEGIN(fovea::scene) and SHARED_END stand around the declarations, and SHARED_CONSTANT before a constant. The
// others matter to C++ alone: the value of a member that nothing else is said about, the bytes of a record, and the
// place of a member in it.
#define SHARED_BEGIN(space)
#define SHARED_END
#define SHARED_CONSTANT const
#define SHARED_DEFAULT(value)
#define SHARED_ZERO
#define SHARED_SIZE(record, bytes)
#define SHARED_OFFSET(record, member, bytes)

#endif
