// A list whose first N elements are stored in the object itself, for lists that are nearly always short: a graph has
// thousands of them, and allocating memory would cost more than filling them. Elements are plain data. As in
// std::vector, growing invalidates iterators; so does moving, because it moves the elements in the object as well.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace fovea {

template <class T, uint32_t N>
class SmallVector {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  using value_type = T;
  using iterator = T*;
  using const_iterator = const T*;

  SmallVector() = default;
  SmallVector(const SmallVector& other) { assign(other.begin(), other.end()); }
  SmallVector(SmallVector&& other) noexcept { take(other); }
  SmallVector& operator=(const SmallVector& other) {
    if (this != &other) assign(other.begin(), other.end());
    return *this;
  }
  SmallVector& operator=(SmallVector&& other) noexcept {
    if (this == &other) return *this;
    release();
    take(other);
    return *this;
  }
  ~SmallVector() { release(); }

  T* data() { return data_; }
  const T* data() const { return data_; }
  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }
  T& operator[](size_t i) { return data()[i]; }
  const T& operator[](size_t i) const { return data()[i]; }

  void clear() { size_ = 0; }
  void reserve(size_t count) {
    if (count > capacity_) grow(count);
  }
  [[gnu::always_inline]] void push_back(T value) { emplace_back(value); }
  // Constructs the element in place, because copying one that was just written field by field would have to wait for
  // the writes. No argument may be part of this list.
  template <class... Arguments>
  [[gnu::always_inline]] T& emplace_back(Arguments&&... arguments) {
    if (size_ == capacity_) grow(size_ + 1);
    return *new (data() + size_++) T{std::forward<Arguments>(arguments)...};
  }
  template <class Iterator>
  void assign(Iterator first, Iterator last) {
    clear();
    reserve(last - first);
    for (; first != last; ++first) new (data_ + size_++) T(*first);
  }
  T* insert(const T* where, T value) {
    const size_t at = where - data();
    reserve(size_ + 1);
    T* place = data() + at;
    std::memmove(static_cast<void*>(place + 1), place, (size_++ - at) * sizeof(T));
    return new (place) T(value);
  }
  // [first, last) must not be part of this list.
  template <class Iterator>
  T* insert(const T* where, Iterator first, Iterator last) {
    const size_t at = where - data(), count = last - first;
    reserve(size_ + count);
    T* place = data() + at;
    std::memmove(static_cast<void*>(place + count), place, (size_ - at) * sizeof(T));
    for (T* to = place; first != last; ++first, ++to) new (to) T(*first);
    size_ += static_cast<uint32_t>(count);
    return place;
  }
  T* erase(const T* where) {
    T* place = data() + (where - data());
    std::memmove(static_cast<void*>(place), place + 1, (end() - place - 1) * sizeof(T));
    --size_;
    return place;
  }

 private:
  [[gnu::noinline]] void grow(size_t count) {  // rare; out of line so that callers can be inlined
    const auto capacity = static_cast<uint32_t>(std::max<size_t>(count, size_t(capacity_) * 2));
    T* grown = std::allocator<T>().allocate(capacity);
    std::memcpy(static_cast<void*>(grown), data_, size_ * sizeof(T));
    release();
    data_ = grown;
    capacity_ = capacity;
  }
  void release() {
    if (capacity_ > N) std::allocator<T>().deallocate(data_, capacity_);
  }
  void take(SmallVector& other) {
    const bool elsewhere = other.capacity_ > N;
    data_ = elsewhere ? std::exchange(other.data_, other.here()) : here();
    if (!elsewhere) std::memcpy(here_, other.here_, sizeof here_);
    size_ = std::exchange(other.size_, 0);
    capacity_ = std::exchange(other.capacity_, N);
  }
  T* here() { return reinterpret_cast<T*>(here_); }

  T* data_ = here();
  uint32_t size_ = 0, capacity_ = N;
  alignas(T) std::byte here_[N * sizeof(T)];
};

}  // namespace fovea
