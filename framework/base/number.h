// Numbers as users write them on command lines and in tables.
#pragma once

#include <optional>
#include <string_view>

namespace fovea {

// A finite decimal number as JSON writes it; `.5` and `5.` are taken, too. No other spelling is: no white space, no
// text behind the number, no `+`, no leading zeros, no hexadecimal digits, and neither `nan` nor `inf`.
std::optional<double> parseDecimal(std::string_view text);

}  // namespace fovea
