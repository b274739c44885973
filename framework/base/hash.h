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
    for (size_t i = 0, size = count * sizeof(T); i < size; i += 8) {
      uint64_t word = 0;
      std::memcpy(&word, bytes + i, size - i < 8 ? size - i : 8);
      add(word);
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
  uint64_t state_ = 0x2545F4914F6CDD1Dull;
};

}  // namespace fovea
