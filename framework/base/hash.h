// A running 64-bit hash of plain values, for keys of caches: cheap enough to hash a whole graph whenever it is bound,
// and fast enough for the textures of a scene.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <variant>

namespace fovea {

class Hasher {
 public:
  Hasher() = default;
  // Multiply, fold and rotate, as in wyhash: every input bit reaches every output bit within two rounds. Adding two
  // numbers at a time costs no more than adding one.
  template <std::integral T>
  void add(T number, uint64_t other = 0) {
    const auto v = static_cast<uint64_t>(number);
    const unsigned __int128 product =
        static_cast<unsigned __int128>(state_ ^ v) * (other ^ 0x9E3779B97F4A7C15ull);
    state_ = std::rotl(static_cast<uint64_t>(product) ^ static_cast<uint64_t>(product >> 64), 23) +
             0xD6E8FEB86659FD93ull;
  }
  void add(float number) { add(std::bit_cast<uint32_t>(number)); }
  void add(double number) { add(std::bit_cast<uint64_t>(number)); }

  // Texts and arrays are preceded by their length, so that nothing can move from one to its neighbour.
  template <class T>
  void add(const T* values, size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(count);
    const auto* bytes = reinterpret_cast<const char*>(values);
    size_t i = 0, size = count * sizeof(T);
    if (size >= kLarge) {  // four sums at a time, as a step of one waits for the step before
      Hasher sums[4] = {Hasher(1), Hasher(2), Hasher(3), Hasher(4)};
      for (; i + 64 <= size; i += 64)
        for (size_t k = 0; k < 4; ++k) sums[k].add(word(bytes + i + 16 * k), word(bytes + i + 16 * k + 8));
      for (const Hasher& sum : sums) add(sum.state_);
    }
    for (; i < size; i += 8) {
      uint64_t rest = 0;
      std::memcpy(&rest, bytes + i, size - i < 8 ? size - i : 8);
      add(rest);
    }
  }
  template <class List>
  requires requires(const List& list) { list.data(), list.size(); }
  void add(const List& list) { add(list.data(), list.size()); }

  // The kind of value counts as well: 1 and true are different.
  template <class... Types>
  void add(const std::variant<Types...>& value) {
    std::visit(
        [&]<class T>(const T& held) {
          if constexpr (std::is_same_v<T, double>)
            add(std::bit_cast<uint64_t>(held), value.index());
          else if constexpr (std::integral<T>)
            add(held, value.index());
          else
            add(value.index()), add(held);
        },
        value);
  }
  uint64_t value() const { return state_; }

 private:
  static constexpr size_t kLarge = 4096;  // bytes
  explicit Hasher(uint64_t stream) { add(stream); }
  static uint64_t word(const char* bytes) {
    uint64_t value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }

  uint64_t state_ = 0x2545F4914F6CDD1Dull;
};

}  // namespace fovea
