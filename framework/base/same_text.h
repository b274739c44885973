// Compares two short texts. Names in graphs are rarely longer than 16 bytes, and for these a call of memcmp costs
// more than the comparison itself.
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>

namespace fovea {

[[gnu::always_inline]] inline bool sameText(std::string_view a, std::string_view b) {
  const size_t size = b.size();  // of the literal, if one is
  if (size != a.size()) return false;
  const auto differ = [&]<class Word>(Word, size_t at) {
    Word x, y;
    std::memcpy(&x, a.data() + at, sizeof x);
    std::memcpy(&y, b.data() + at, sizeof y);
    return x ^ y;
  };
  // Texts of up to 16 bytes are compared as two words that may overlap in the middle.
  if (size > 16) return std::memcmp(a.data(), b.data(), size) == 0;
  if (size >= 8) return (differ(uint64_t(), 0) | differ(uint64_t(), size - 8)) == 0;
  if (size >= 4) return (differ(uint32_t(), 0) | differ(uint32_t(), size - 4)) == 0;
  return size == 0 || (a[0] == b[0] && a[size / 2] == b[size / 2] && a[size - 1] == b[size - 1]);
}

}  // namespace fovea
