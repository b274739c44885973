// Text files as editors save them, and text files that are never left half-written.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace fovea {

// Editors and spreadsheets put this character in front of UTF-8. It is no part of the text.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
inline std::string_view withoutByteOrderMark(std::string_view text) {
  return text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text;
}
// By its byte-order mark; it is not read.
inline bool isUtf16(std::string_view text) {
  return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
}

// Writes as an OutputFile (files.h). Throws Error(CannotWrite) naming the file and the reason.
void writeText(const std::filesystem::path& file, const std::string& text);
// Throws Error(CannotWrite) if `file` cannot be created there; leaves nothing behind.
void checkTextWritable(const std::filesystem::path& file);

}  // namespace fovea
