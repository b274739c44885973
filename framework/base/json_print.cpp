// JSON as text.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "framework/base/json.h"

namespace fovea::json {
namespace {

constexpr size_t kPrintWidth = 110;

std::string printOnOneLine(const Value& value) {
  switch (value.type) {
    case Value::Type::Null:
      return "null";
    case Value::Type::Bool:
      return value.boolean ? "true" : "false";
    case Value::Type::Int:
      return fmt::format("{}", value.integer);
    case Value::Type::Real:
      return fmt::format("{}", value.real);
    case Value::Type::String:
      return nlohmann::json(value.string).dump();
    case Value::Type::Array: {
      std::string text;
      for (const Value& item : value.items) text += (text.empty() ? "" : ", ") + printOnOneLine(item);
      return "[" + text + "]";
    }
    case Value::Type::Object:
      break;
  }
  std::string text;
  for (const Member& member : value.members)
    text +=
        (text.empty() ? " " : ", ") + nlohmann::json(member.key).dump() + ": " + printOnOneLine(member.value);
  return text.empty() ? "{}" : "{" + text + " }";
}

// `before` and `after` are the numbers of other characters on the first and last line of the value.
void printInto(std::string& out, const Value& value, size_t indent, size_t before, size_t after) {
  const std::string line = printOnOneLine(value);
  const size_t count = value.isObject() ? value.members.size() : value.items.size();
  if (count == 0 || (indent > 0 && indent + before + line.size() + after <= kPrintWidth)) {
    out += line;
    return;
  }
  const std::string inner(indent + 2, ' ');
  out += value.isObject() ? "{\n" : "[\n";
  for (size_t i = 0; i < count; ++i) {
    const std::string key =
        value.isObject() ? nlohmann::json(value.members[i].key).dump() + ": " : std::string();
    out += inner + key;
    printInto(out, value.isObject() ? value.members[i].value : value.items[i], indent + 2, key.size(), 1);
    out += i + 1 < count ? ",\n" : "\n";
  }
  out += std::string(indent, ' ') + (value.isObject() ? "}" : "]");
}

}  // namespace

std::string print(const Value& value) {
  std::string text;
  printInto(text, value, 0, 0, 0);
  return text + "\n";
}

}  // namespace fovea::json
