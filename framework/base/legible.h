// Texts from files in messages.
#pragma once

#include <string>
#include <string_view>

namespace fovea {

// Control characters as escapes, and words and `quotations` of more than 256 bytes shortened to 80 with their length.
std::string legible(std::string_view text);

}  // namespace fovea
