// How the C library treats freed memory.
#pragma once

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace fovea {

// Keeps up to 256 MiB of freed memory instead of returning its pages at once. Otherwise, compiling a graph of several
// hundred passes repeatedly spends a quarter of its time on obtaining them again. Call it at the start of a program.
inline void keepFreedMemory() {
#ifdef __GLIBC__
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
#endif
}

}  // namespace fovea
