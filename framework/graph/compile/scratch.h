// Memory of one compiler phase, which is taken piece by piece and given back all at once. A phase needs a dozen short
// arrays; allocating each of them would cost a small graph as much as the work itself.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <memory_resource>
#include <span>
#include <type_traits>
#include <vector>

namespace fovea::graph::detail {

class Scratch {
 public:
  Scratch() = default;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    for (const auto& [memory, bytes] : more_) kept().deallocate(memory, bytes);
  }

  void* take(size_t bytes) {
    bytes = (bytes + kAlignment - 1) & ~(kAlignment - 1);
    if (bytes > static_cast<size_t>(end_ - next_)) [[unlikely]]
      takeMore(bytes);
    std::byte* taken = next_;
    next_ += bytes;
    return taken;
  }

  // An array of `count` equal elements. Arrays that grow are ScratchVectors.
  template <class T>
  std::span<T> array(size_t count, const T& value = T()) {
    static_assert(alignof(T) <= kAlignment && std::is_trivially_destructible_v<T>);
    T* const first = static_cast<T*>(take(count * sizeof(T)));  // NOLINT(bugprone-sizeof-expression)
    std::uninitialized_fill_n(first, count, value);
    return {first, count};
  }

  static constexpr size_t kAlignment = 16;

 private:
  struct Block {
    void* memory;
    size_t bytes;
  };

  // Memory that larger graphs need in addition is kept for the next phase, because obtaining fresh pages costs more
  // than filling them.
  static std::pmr::memory_resource& kept() {
    thread_local std::pmr::unsynchronized_pool_resource pool({1, 1 << 20});
    return pool;
  }
  [[gnu::noinline]] void takeMore(size_t bytes) {
    const size_t size = std::max(bytes, (more_.empty() ? sizeof here_ : more_.back().bytes) * 2);
    more_.push_back({kept().allocate(size), size});
    next_ = static_cast<std::byte*>(more_.back().memory);
    end_ = next_ + size;
  }

  alignas(kAlignment) std::byte here_[16 << 10];  // enough for some 50 passes
  std::byte *next_ = here_, *end_ = here_ + sizeof here_;
  std::vector<Block> more_;
};

template <class T>
struct ScratchAllocator {
  using value_type = T;
  ScratchAllocator(Scratch& from) : scratch(&from) {}  // NOLINT: implicit, for members foo_{scratch_}
  template <class U>
  ScratchAllocator(const ScratchAllocator<U>& other) : scratch(other.scratch) {}  // NOLINT
  T* allocate(size_t count) {
    static_assert(alignof(T) <= Scratch::kAlignment);
    return static_cast<T*>(scratch->take(count * sizeof(T)));  // NOLINT(bugprone-sizeof-expression)
  }
  void deallocate(T*, size_t) {}
  template <class U>
  bool operator==(const ScratchAllocator<U>& other) const {
    return scratch == other.scratch;
  }

  Scratch* scratch;
};

template <class T>
using ScratchVector = std::vector<T, ScratchAllocator<T>>;

}  // namespace fovea::graph::detail
