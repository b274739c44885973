#include "framework/host/copy_state.h"

#include <cstring>

namespace fovea::host {

void copyState(void* to, const void* from, size_t bytes) { std::memcpy(to, from, bytes); }

}  // namespace fovea::host
