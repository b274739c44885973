// A running 64-bit hash of small values, cheap enough to hash a whole graph whenever it is bound.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "fovea/pass.h"

namespace fovea::graph::detail {

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
  void add(std::string_view text) {
    add(static_cast<uint64_t>(text.size()));
    for (size_t i = 0; i < text.size(); i += 8) {
      uint64_t word = 0;
      std::memcpy(&word, text.data() + i, text.size() - i < 8 ? text.size() - i : 8);
      add(word);
    }
  }
  void addValue(const Value& value) {
    const auto type = static_cast<uint64_t>(value.index());
    if (const bool* b = std::get_if<bool>(&value)) return add(static_cast<uint64_t>(*b), type);
    if (const int64_t* i = std::get_if<int64_t>(&value)) return add(*i, type);
    if (const double* d = std::get_if<double>(&value)) return add(std::bit_cast<uint64_t>(*d), type);
    add(type);
    add(std::string_view(std::get<std::string>(value)));
  }
  uint64_t value() const { return state_; }

 private:
  uint64_t state_ = 0x2545F4914F6CDD1Dull;
};

}  // namespace fovea::graph::detail
