// Reads gaze samples from a scene file, or from a table as written by eye trackers.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>

#include "framework/base/files.h"
#include "framework/base/number.h"
#include "framework/base/text_file.h"
#include "framework/scene/file/reader.h"
#include "framework/scene/motion/motion.h"

namespace fovea::scene {
namespace {

using json::ObjectReader;

std::optional<glm::vec2> readEye(ObjectReader& r, std::string_view key) {
  const auto v = r.numbers(key, 2);
  if (!v) return std::nullopt;
  const glm::vec2 p((*v)[0], (*v)[1]);
  if (!(p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1)) mistake(r, key, "a gaze lies within 0 to 1");
  return p;
}

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

const std::vector<std::string> kColumns = {"t", "x", "y", "valid", "left_x", "left_y", "right_x", "right_y"};
constexpr size_t kMaxMistakes = 20;              // any other table has one on every line
constexpr uintmax_t kMaxTableBytes = 64u << 20;  // a day at 40 Hz

class CsvReader {
 public:
  explicit CsvReader(const std::string& file) : file_(file) {}

  std::vector<GazeSample> read(std::string_view rest) {
    if (isUtf16(rest)) {
      mistakeAt(1, "the file is UTF-16", "save it as UTF-8");
      errors_.throwIfErrors();
    }
    rest = withoutByteOrderMark(rest);
    while (!rest.empty()) {
      ++line_;
      const std::string_view text = trimmed(takenLine(rest));
      if (text.empty() || text[0] == '#') continue;
      if (line_ == 1 && text.starts_with("sep=")) continue;  // for spreadsheets; the header says the same
      if (columns_.empty())
        header(text);
      else
        row(text);
      if (errors_.list().size() >= kMaxMistakes) break;
    }
    if (columns_.empty()) mistakeAt(1, "the file has no header line", "begin it with t,x,y,valid");
    errors_.throwIfErrors();
    const auto valid = [](const GazeSample& g) { return g.valid; };
    if (std::none_of(samples_.begin(), samples_.end(), valid))
      mistakeAt(1, samples_.empty() ? "the table has no samples" : "the table has no valid sample",
                "give at least one sample where the eye is open, or leave the table out");
    errors_.throwIfErrors();
    return std::move(samples_);
  }

 private:
  void mistakeAt(int column, const std::string& message, const std::string& remedy = {}) {
    errors_.error({file_, std::max(line_, 1), column}, "", message, remedy);
  }

  void header(std::string_view text) {
    separator_ = separatorOf(text);
    for (const std::string& name : cells(text, separator_)) columns_.push_back(lowerCase(name));
    while (columns_.size() > 1 && columns_.back().empty()) columns_.pop_back();
    // The content of a file of another kind must not be shown.
    if (std::find(columns_.begin(), columns_.end(), "t") == columns_.end()) {
      mistakeAt(1, "the file does not begin as a table of gazes, with a column `t`",
                "begin it with t,x,y,valid");
      errors_.throwIfErrors();
    }
    std::map<std::string, int> seen;
    for (const std::string& name : columns_) {
      if (errors_.list().size() >= kMaxMistakes) errors_.throwIfErrors();
      if (std::find(kColumns.begin(), kColumns.end(), name) == kColumns.end()) {
        const std::string nearest = nearestName(name, kColumns);
        mistakeAt(1, "no column `" + name + "` is known",
                  nearest.empty() ? "the columns are t, x, y, valid, left_x, left_y, right_x, right_y"
                                  : "did you mean `" + nearest + "`?");
      } else if (++seen[name] == 2) {
        mistakeAt(1, "the column `" + name + "` is there twice");
      }
    }
    for (const char* name : {"t", "x", "y"})
      if (!seen.count(name))
        mistakeAt(1, std::string("the column `") + name + "` is missing", "begin with t,x,y,valid");
    errors_.throwIfErrors();
  }

  // A number of a row; an empty cell is missing.
  std::optional<double> number(const std::map<std::string, std::string>& row, const std::string& name,
                               double min, double max) {
    const auto it = row.find(name);
    if (it == row.end() || it->second.empty()) return std::nullopt;
    std::string text = it->second;
    const size_t comma = text.find(',');
    (comma == text.npos ? points_ : commas_) |= text.find_first_of(".,") != text.npos;
    if (comma != text.npos) text[comma] = '.';
    const std::optional<double> value = parseDecimal(text);
    if (value && *value >= min && *value <= max) return value;
    mistakeAt(1, "`" + name + "` is `" + it->second + "`: expected a number from " +
                     std::to_string(int(min)) + " to " + std::to_string(int(max)));
    return std::nullopt;
  }

  std::optional<glm::vec2> eye(const std::map<std::string, std::string>& row, const std::string& x,
                               const std::string& y) {
    const auto a = number(row, x, 0, 1), b = number(row, y, 0, 1);
    if (!a || !b) return std::nullopt;
    return glm::vec2(*a, *b);
  }

  void row(std::string_view text) {
    std::vector<std::string> values = cells(text, separator_);
    // Spreadsheets fill lines up with empty cells.
    while (values.size() > columns_.size() && values.back().empty()) values.pop_back();
    if (std::all_of(values.begin(), values.end(), [](const std::string& v) { return v.empty(); })) return;
    if (values.size() != columns_.size())
      return mistakeAt(
          1, std::to_string(values.size()) + " values in " + std::to_string(columns_.size()) + " columns",
          separator_ == ',' && values.size() > columns_.size()
              ? "write numbers with a decimal point, or separate columns by semicolons"
              : "");
    std::map<std::string, std::string> row;
    for (size_t i = 0; i < values.size(); ++i) row[columns_[i]] = values[i];
    const size_t before = errors_.list().size();
    GazeSample g;
    const auto t = number(row, "t", 0, 1e6);
    g.valid = number(row, "valid", 0, 1).value_or(1) != 0;
    // Trackers leave the position of an invalid sample empty, or write something outside the image.
    const auto position = g.valid ? eye(row, "x", "y") : glm::vec2(0.5f);
    if (g.valid) g.left = eye(row, "left_x", "left_y"), g.right = eye(row, "right_x", "right_y");
    if (errors_.list().size() > before) return;
    if (points_ && commas_) {
      points_ = false;  // told once
      return mistakeAt(1, "the table has decimal commas and decimal points",
                       "write all numbers the same way, without separators of thousands");
    }
    if (!t || !position) return mistakeAt(1, "a sample needs t, and a valid one x and y");
    g.time = float(*t);
    g.position = *position;
    if (!samples_.empty() && g.time <= samples_.back().time)
      return mistakeAt(1, "the times of the gaze must increase");
    samples_.push_back(g);
  }

  std::string file_;
  std::vector<std::string> columns_;
  std::vector<GazeSample> samples_;
  Diagnostics errors_;
  int line_ = 0;
  char separator_ = ',';
  bool points_ = false, commas_ = false;  // whether numbers had decimal points, and decimal commas
};

}  // namespace

std::vector<GazeSample> readGaze(const json::Value& list, Diagnostics& errors) {
  std::vector<GazeSample> samples;
  for (size_t i = 0; i < list.items.size(); ++i) {
    ObjectReader r(list.items[i], itemPath("gaze", i), errors);
    r.require("t");
    GazeSample g;
    g.time = float(r.number("t", 0, 0, 1e6));
    g.valid = r.boolean("valid", true);
    g.position = {float(r.number("x", 0.5, 0, 1)), float(r.number("y", 0.5, 0, 1))};
    g.left = readEye(r, "left");
    g.right = readEye(r, "right");
    if (!samples.empty() && r.has("t") && g.time <= samples.back().time)
      mistake(r, "t", "the times of the gaze must increase");
    r.finish();
    samples.push_back(g);
  }
  const auto valid = [](const GazeSample& g) { return g.valid; };
  if (!samples.empty() && std::none_of(samples.begin(), samples.end(), valid))
    errors.error(list.where.location(), "gaze", "no sample of the gaze is valid",
                 "give at least one sample where the eye is open, or leave `gaze` out");
  return samples;
}

std::vector<GazeSample> parseGazeCsv(std::string_view text, const std::string& file) {
  return CsvReader(file).read(text);
}

std::vector<GazeSample> readGazeCsv(const std::filesystem::path& file) {
  const std::string name = file.string();
  if (const std::string reason = whyUnreadable(file); !reason.empty())
    throw Error(ExitCode::BadInput, name + ": cannot be read: " + reason);
  std::error_code ec;
  if (std::filesystem::file_size(file, ec) > kMaxTableBytes)
    throw Error(ExitCode::BadInput, name + ": has more than 64 MiB");
  noteRead(file);
  std::ifstream stream(file, std::ios::binary);
  return parseGazeCsv(std::string(std::istreambuf_iterator<char>(stream), {}), name);
}

}  // namespace fovea::scene
