#include "samples/fovea/author/rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace fovea::cli {

void printRows(const std::string& title, const std::vector<TableRow>& rows) {
  if (rows.empty()) return;
  fmt::print("\n{}\n", title);
  size_t name = 0, properties = 0;
  for (const TableRow& row : rows) {
    name = std::max(name, row[0].size());
    if (row[1].size() <= 44) properties = std::max(properties, row[1].size());
  }
  for (const TableRow& row : rows) {
    std::string text = fmt::format("  {:<{}}  {:<{}}  {}", row[0], name, row[1], properties, row[2]);
    text.erase(text.find_last_not_of(' ') + 1);
    fmt::print("{}\n", text);
  }
}

std::string printValue(const graph::Value& value) {
  if (const bool* b = std::get_if<bool>(&value)) return *b ? "true" : "false";
  if (const int64_t* i = std::get_if<int64_t>(&value)) return std::to_string(*i);
  if (const double* d = std::get_if<double>(&value)) return fmt::format("{:g}", *d);
  const std::string& text = std::get<std::string>(value);
  return text.empty() ? "\"\"" : text;
}

std::string describeValue(std::string text, const graph::ParameterSpec& p) {
  using Type = graph::ParameterSpec::Type;
  if (!p.unit.empty()) text += ' ' + p.unit;
  if (p.type == Type::Bool) return text + " (true or false)";
  if (p.type == Type::Text) return text + " (text)";
  if (!p.choices.empty()) return fmt::format("{} (one of {})", text, fmt::join(p.choices, ", "));
  if (!std::isfinite(p.min) && !std::isfinite(p.max)) return text;
  const char* whole = p.type == Type::Int ? "whole, " : "";
  if (!std::isfinite(p.max)) return fmt::format("{} ({}from {:g})", text, whole, p.min);
  if (!std::isfinite(p.min)) return fmt::format("{} ({}up to {:g})", text, whole, p.max);
  return p.type == Type::Int ? fmt::format("{} ({:.0f} to {:.0f}, whole)", text, p.min, p.max)
                             : fmt::format("{} ({:g} to {:g})", text, p.min, p.max);
}

}  // namespace fovea::cli
