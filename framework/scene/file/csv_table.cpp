#include "framework/scene/file/csv_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "framework/base/files.h"
#include "framework/base/number.h"
#include "framework/base/text_file.h"

namespace fovea::scene {
namespace {

std::string_view trimmed(std::string_view s) {
  const size_t first = s.find_first_not_of(" \t"), last = s.find_last_not_of(" \t");
  return first == s.npos ? std::string_view() : s.substr(first, last - first + 1);
}

// Takes a line off the front of `rest`, with its end: CR, LF or both.
std::string_view takenLine(std::string_view& rest) {
  const std::string_view line = rest.substr(0, rest.find_first_of("\r\n"));
  rest.remove_prefix(line.size());
  rest.remove_prefix(rest.starts_with("\r\n") ? 2 : std::min<size_t>(rest.size(), 1));
  return line;
}

// The cells of a line (RFC 4180, with any separator): one in quotes may contain separators, and quotes twice.
std::vector<std::string> cells(std::string_view line, char separator) {
  std::vector<std::string> list(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == separator && !quoted)
      list.emplace_back();
    else
      list.back() += c;
  }
  for (std::string& cell : list) cell = trimmed(cell);
  return list;
}

// What separates the columns of a header: the first comma, semicolon or tab. Without one there is one column.
char separatorOf(std::string_view header) {
  const size_t at = header.find_first_of(",;\t");
  return at == header.npos ? ',' : header[at];
}

std::string lowerCase(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return text;
}

constexpr size_t kMaxMistakes = 20;              // any other table has one on every line
constexpr uintmax_t kMaxTableBytes = 64u << 20;  // a day at 40 Hz

}  // namespace

void CsvTable::read(std::string_view rest, const std::function<void()>& row) {
  if (isUtf16(rest)) {
    mistake("the file is UTF-16", "save it as UTF-8");
    errors_.throwIfErrors();
  }
  rest = withoutByteOrderMark(rest);
  while (!rest.empty()) {
    ++line_;
    const std::string_view text = trimmed(takenLine(rest));
    if (text.empty() || text[0] == '#') continue;
    if (line_ == 1 && text.starts_with("sep=")) continue;  // for spreadsheets; the header says the same
    if (columns_.empty())
      readHeader(text);
    else
      readRow(text, row);
    if (mistakes() >= kMaxMistakes) break;
  }
  if (columns_.empty()) {
    line_ = 1;
    mistake("the file has no header line", "begin it with " + kind_.start);
  }
  errors_.throwIfErrors();
}

bool CsvTable::has(const std::string& column) const {
  return std::ranges::find(columns_, column) != columns_.end();
}

void CsvTable::mistake(const std::string& message, const std::string& remedy) {
  errors_.error({file_, std::max(line_, 1), 1}, "", message, remedy);
}

void CsvTable::readHeader(std::string_view text) {
  separator_ = separatorOf(text);
  for (const std::string& name : cells(text, separator_)) columns_.push_back(lowerCase(name));
  while (columns_.size() > 1 && columns_.back().empty()) columns_.pop_back();
  // The content of a file of another kind must not be shown.
  if (!has("t")) {
    mistake(fmt::format("the file does not begin as {}, with a column `t`", kind_.name),
            "begin it with " + kind_.start);
    errors_.throwIfErrors();
  }
  std::map<std::string, int> seen;
  for (const std::string& name : columns_) {
    if (mistakes() >= kMaxMistakes) errors_.throwIfErrors();
    if (std::ranges::find(kind_.columns, name) == kind_.columns.end()) {
      const std::string nearest = nearestName(name, kind_.columns);
      mistake("no column `" + name + "` is known",
              nearest.empty() ? fmt::format("the columns are {}", fmt::join(kind_.columns, ", "))
                              : "did you mean `" + nearest + "`?");
    } else if (++seen[name] == 2) {
      mistake("the column `" + name + "` is there twice");
    }
  }
  for (const std::string& name : kind_.required)
    if (!seen.count(name)) mistake("the column `" + name + "` is missing", "begin with " + kind_.start);
  errors_.throwIfErrors();
}

std::optional<double> CsvTable::number(const std::string& name, double min, double max) {
  const auto it = row_.find(name);
  if (it == row_.end() || it->second.empty()) return std::nullopt;
  std::string text = it->second;
  const size_t comma = text.find(',');
  (comma == text.npos ? points_ : commas_) |= text.find_first_of(".,") != text.npos;
  if (comma != text.npos) text[comma] = '.';
  const std::optional<double> value = parseDecimal(text);
  if (value && *value >= min && *value <= max) return value;
  mistake(fmt::format("`{}` is `{}`: expected a number from {} to {}", name, it->second, min, max));
  return std::nullopt;
}

void CsvTable::readRow(std::string_view text, const std::function<void()>& row) {
  std::vector<std::string> values = cells(text, separator_);
  // Spreadsheets fill lines up with empty cells.
  while (values.size() > columns_.size() && values.back().empty()) values.pop_back();
  if (std::ranges::all_of(values, &std::string::empty)) return;
  if (values.size() != columns_.size())
    return mistake(fmt::format("{} values in {} columns", values.size(), columns_.size()),
                   separator_ == ',' && values.size() > columns_.size()
                       ? "write numbers with a decimal point, or separate columns by semicolons"
                       : "");
  row_.clear();
  for (size_t i = 0; i < values.size(); ++i) row_[columns_[i]] = values[i];
  row();
  if (points_ && commas_) {
    points_ = false;  // told once
    mistake("the table has decimal commas and decimal points",
            "write all numbers the same way, without separators of thousands");
  }
}

std::string readTableText(const std::filesystem::path& file) {
  const std::string name = file.string();
  if (const std::string reason = whyUnreadable(file); !reason.empty())
    throw Error(ExitCode::BadInput, name + ": cannot be read: " + reason);
  std::error_code ec;
  if (std::filesystem::file_size(file, ec) > kMaxTableBytes)
    throw Error(ExitCode::BadInput, name + ": has more than 64 MiB");
  noteRead(file);
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace fovea::scene
