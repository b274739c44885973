// JSON with source positions: every value and key knows its file, line and column, so that a wrong value can be
// reported where the user wrote it. Nothing here depends on the meaning of a document; graph files and scene files
// are both read through it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fovea/error.h"

namespace fovea::json {

// Lines and columns count from 1, columns in characters (UTF-8 code points). Line 0 means unknown.
struct Position {
  std::shared_ptr<const std::string> file;
  int line = 0;
  int column = 0;

  SourceLocation location() const { return {file ? *file : std::string(), line, column}; }
};

struct Member;

struct Value {
  enum class Type : uint8_t { Null, Bool, Int, Real, String, Array, Object };

  Type type = Type::Null;
  bool boolean = false;
  std::string string;           // String
  std::vector<Member> members;  // Object, in the order of the file; keys are unique
  int64_t integer = 0;          // Int, and Real if it is whole; otherwise 0
  double real = 0;              // Real and Int; always finite
  std::vector<Value> items;     // Array
  Position where;               // first character of the value

  bool isNull() const { return type == Type::Null; }
  bool isBool() const { return type == Type::Bool; }
  // A whole number, however it is written: 4, 4.0 and 4e0 are the same number. `type` keeps the spelling.
  bool isInt() const {
    return type == Type::Int || (type == Type::Real && real == static_cast<double>(integer));
  }
  bool isNumber() const { return type == Type::Int || type == Type::Real; }
  bool isString() const { return type == Type::String; }
  bool isArray() const { return type == Type::Array; }
  bool isObject() const { return type == Type::Object; }

  const Member* findMember(std::string_view key) const;  // nullptr also if this is not an object
  const Value* find(std::string_view key) const;
  // Makes it a number of type Real.
  void setReal(double number);
  // For messages that say what was found: "an object", "the number 3.5", "the text \"abc\"".
  std::string describe() const;
};

struct Member {
  std::string key;
  Value value;
  Position keyWhere;
};

inline const Member* Value::findMember(std::string_view key) const {
  for (const Member& member : members)
    if (member.key == key) return &member;
  return nullptr;
}

inline const Value* Value::find(std::string_view key) const {
  const Member* member = findMember(key);
  return member ? &member->value : nullptr;
}

inline constexpr int kMaxDepth = 64;                   // nesting of arrays and objects
inline constexpr size_t kMaxBytes = size_t(64) << 20;  // of one file

// Parses strict RFC 8259, after a byte-order mark of UTF-8 if there is one. `file` is the name used in messages.
// Throws Error(BadInput) with the place of a syntax error, text after the document, UTF-16, a NUL, invalid UTF-8, a
// number that no double holds, nesting deeper than kMaxDepth, or keys that occur twice in one object (all of these at
// once).
Value parse(std::string_view text, std::string_view file);
// Also throws Error(BadInput) if the file cannot be read or is larger than kMaxBytes.
Value parseFile(const std::filesystem::path& file);
// The text of a value, indented by two spaces; whatever fits into 110 characters is on one line. Ends with a newline.
std::string print(const Value& value);

// Reads an object member by member. A value of a wrong type or out of range is reported and replaced by the fallback
// (or nothing). finish() reports every member that was not asked for, with the nearest name that was. Keys must be
// literals, because the reader keeps references to them.
//   ObjectReader r(value, "camera", diagnostics);
//   camera.fov = r.number("fov_degrees", 60, 1, 179);
//   r.finish();
class ObjectReader {
 public:
  // Reports a `value` that is not an object; every member is then absent. `path` is the place inside the document.
  ObjectReader(const Value& value, std::string path, Diagnostics& diagnostics);
  // The same at "parent.key". Both strings are kept by reference.
  ObjectReader(const Value& value, std::string_view parent, std::string_view key, Diagnostics& diagnostics);

  const Value* find(std::string_view key);     // any type; nullptr if absent
  const Value* require(std::string_view key);  // reports an absent member
  const Value* object(std::string_view key);   // nullptr if absent or wrong
  const Value* array(std::string_view key);
  bool has(std::string_view key) const { return value_.find(key) != nullptr; }

  double number(std::string_view key, double fallback, double min = -std::numeric_limits<double>::infinity(),
                double max = std::numeric_limits<double>::infinity());
  int64_t integer(std::string_view key, int64_t fallback, int64_t min = std::numeric_limits<int64_t>::min(),
                  int64_t max = std::numeric_limits<int64_t>::max());
  bool boolean(std::string_view key, bool fallback);
  std::string text(std::string_view key, std::string fallback = {});
  std::string choice(std::string_view key, std::string fallback, const std::vector<std::string>& choices);
  // An array of exactly `count` numbers; nullopt if absent or wrong.
  std::optional<std::vector<double>> numbers(std::string_view key, size_t count);

  void finish();

  std::string pathOf(std::string_view key) const;  // "camera.fov_degrees"
  std::string path() const;
  const Value& value() const { return value_; }
  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  void wrong(std::string_view key, const Value& value, const std::string& expected);
  void reportKind();
  const Value& value_;
  std::string path_;  // used if there is no key
  std::string_view parent_, key_;
  Diagnostics& diagnostics_;
  std::vector<std::string_view> known_;  // the keys that were asked for
  uint64_t asked_ = 0;                   // a bit for each of the first 64 members that was asked for
};

// "a.b", or "b" if `path` is empty.
std::string joinPath(std::string_view path, std::string_view key);

}  // namespace fovea::json
