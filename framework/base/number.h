// Numbers as users write them on command lines and in tables.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace fovea {

// A finite decimal number as JSON writes it; `.5` and `5.` are taken, too. No other spelling is: no white space, no
// text behind the number, no `+`, no leading zeros, no hexadecimal digits, and neither `nan` nor `inf`.
inline std::optional<double> parseDecimal(std::string_view text) {
  const std::string_view digits = text.substr(text.starts_with('-') ? 1 : 0);
  const auto isDigit = [&](size_t at) {
    return at < digits.size() && digits[at] >= '0' && digits[at] <= '9';
  };
  // from_chars() also reads the words `nan` and `inf`, and leading zeros.
  const bool begins = isDigit(0) || (digits.starts_with('.') && isDigit(1));
  if (!begins || (digits[0] == '0' && isDigit(1))) return std::nullopt;
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace fovea
