// Memory of one phase of the compiler: taken piece by piece, given back all at once. A phase needs a dozen
// short arrays, and asking for each of them would cost a small graph as much as the work itself.
#pragma once

#include <cstddef>
#include <memory_resource>
#include <vector>

namespace fovea::graph::detail {

class Scratch {
 public:
  template <class T>
  operator std::pmr::polymorphic_allocator<T>() {  // NOLINT: vectors are made with it: foo_{scratch_}
    return &memory_;
  }

 private:
  // What larger graphs need on top is kept for the next phase: fresh pages cost more than what is put into
  // them.
  static std::pmr::memory_resource* kept() {
    thread_local std::pmr::unsynchronized_pool_resource pool({1, 1 << 20});
    return &pool;
  }

  std::byte here_[16 << 10];  // enough for some 50 passes
  std::pmr::monotonic_buffer_resource memory_{here_, sizeof here_, kept()};
};

template <class T>
using ScratchVector = std::pmr::vector<T>;

}  // namespace fovea::graph::detail
