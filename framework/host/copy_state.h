#pragma once

#include <cstddef>

namespace fovea::host {

// memcpy() of the C library, which moves more at a time than what compilers put in the place of a call with a known size.
void copyState(void* to, const void* from, size_t bytes);

}  // namespace fovea::host
