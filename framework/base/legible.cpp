#include "framework/base/legible.h"

#include <algorithm>
#include <cstddef>

namespace fovea {
namespace {

constexpr size_t kLongest = 256, kKept = 80;  // bytes; longer than paths usually are

void appendEscaped(std::string& out, std::string_view text) {
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte >= 0x20 && byte != 0x7f) || c == '\n' || c == '\t')
      out += c;
    else
      out += std::string("\\x") + "0123456789abcdef"[byte >> 4] + "0123456789abcdef"[byte & 15];
  }
}

void appendShortened(std::string& out, std::string_view text) {
  if (text.size() <= kLongest) return appendEscaped(out, text);
  size_t end = kKept;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;  // no half of a character
  appendEscaped(out, text.substr(0, end));
  out += "... (" + std::to_string(text.size()) + " bytes)";
}

}  // namespace

std::string legible(std::string_view text) {
  std::string out;
  for (size_t at = 0; at < text.size();) {
    const size_t closing = text[at] == '`' ? text.find('`', at + 1) : text.npos;
    if (closing != text.npos) {
      out += '`';
      appendShortened(out, text.substr(at + 1, closing - at - 1));
      out += '`';
      at = closing + 1;
      continue;
    }
    size_t end = std::min(text.find_first_of(" \n`", at + (text[at] == '`')), text.size());
    if (end == at) ++end;  // the separator itself
    appendShortened(out, text.substr(at, end - at));
    at = end;
  }
  return out;
}

}  // namespace fovea
