// Reads gaze samples from a scene file, or from a table as written by eye trackers.
#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <map>

#include "framework/base/files.h"
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
  const size_t first = s.find_first_not_of(" \t\r"), last = s.find_last_not_of(" \t\r");
  return first == s.npos ? std::string_view() : s.substr(first, last - first + 1);
}

// Takes what precedes the next `separator` off the front of `rest`, and the separator with it; all of it if there is
// none.
std::string_view taken(std::string_view& rest, char separator) {
  const std::string_view front = rest.substr(0, rest.find(separator));
  rest.remove_prefix(std::min(rest.size(), front.size() + 1));
  return front;
}

std::vector<std::string> cells(std::string_view line) {
  std::vector<std::string> list;
  const bool lastEmpty = line.ends_with(',');
  while (!line.empty()) list.emplace_back(trimmed(taken(line, ',')));
  if (lastEmpty) list.emplace_back();
  return list;
}

const std::vector<std::string> kColumns = {"t", "x", "y", "valid", "left_x", "left_y", "right_x", "right_y"};
constexpr size_t kMaxMistakes = 20;              // any other table has one on every line
constexpr uintmax_t kMaxTableBytes = 64u << 20;  // a day at 40 Hz

class CsvReader {
 public:
  explicit CsvReader(const std::string& file) : file_(file) {}

  std::vector<GazeSample> read(std::string_view rest) {
    while (!rest.empty()) {
      ++line_;
      const std::string_view text = trimmed(taken(rest, '\n'));
      if (text.empty() || text[0] == '#') continue;
      if (columns_.empty())
        header(text);
      else
        row(text);
      if (errors_.list().size() >= kMaxMistakes) break;
    }
    if (columns_.empty()) mistakeAt(1, "the file has no header line", "begin it with t,x,y,valid");
    errors_.throwIfErrors();
    return std::move(samples_);
  }

 private:
  void mistakeAt(int column, const std::string& message, const std::string& remedy = {}) {
    errors_.error({file_, std::max(line_, 1), column}, "", message, remedy);
  }

  void header(std::string_view text) {
    columns_ = cells(text);
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
    double value = 0;
    const char *begin = it->second.data(), *end = begin + it->second.size();
    const auto [rest, error] = std::from_chars(begin, end, value);
    if (error == std::errc() && rest == end && value >= min && value <= max) return value;
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
    const std::vector<std::string> values = cells(text);
    if (values.size() != columns_.size())
      return mistakeAt(
          1, std::to_string(values.size()) + " values in " + std::to_string(columns_.size()) + " columns");
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
