// What the C library does with memory that is freed.
#pragma once

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace fovea {

// Keeps up to 256 MiB of freed memory instead of giving its pages back at once: compiling a graph of some
// hundred passes again and again otherwise spends a quarter of its time on getting them anew. For the start
// of a program.
inline void keepFreedMemory() {
#ifdef __GLIBC__
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
#endif
}

}  // namespace fovea
