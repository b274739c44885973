// JSON with source positions: every value and key knows its file, line and column, so that a wrong value can be
// reported where the user wrote it. Nothing here depends on the meaning of a document; graph files and scene files
// are both read through it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fovea/error.h"
#include "framework/base/same_text.h"
#include "framework/base/small_vector.h"

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
  int64_t integer = 0;          // Int
  double real = 0;              // Real and Int; always finite
  std::string string;           // String
  std::vector<Value> items;     // Array
  std::vector<Member> members;  // Object, in the order of the file; keys are unique
  Position where;               // first character of the value

  bool isNull() const { return type == Type::Null; }
  bool isBool() const { return type == Type::Bool; }
  bool isInt() const { return type == Type::Int; }
  bool isNumber() const { return type == Type::Int || type == Type::Real; }
  bool isString() const { return type == Type::String; }
  bool isArray() const { return type == Type::Array; }
  bool isObject() const { return type == Type::Object; }

  const Member* findMember(std::string_view key) const;  // nullptr also if this is not an object
  const Value* find(std::string_view key) const;
  // For messages that say what was found: "an object", "the number 3.5", "the text \"abc\"".
  std::string describe() const;
};

struct Member {
  std::string key;
  Position keyWhere;
  Value value;
};

// Most keys are literals. Inlined, each costs a comparison or two of whole words.
[[gnu::always_inline]] inline const Member* Value::findMember(std::string_view key) const {
  for (const Member& member : members)
    if (sameText(member.key, key)) return &member;
  return nullptr;
}

[[gnu::always_inline]] inline const Value* Value::find(std::string_view key) const {
  const Member* member = findMember(key);
  return member ? &member->value : nullptr;
}

inline constexpr int kMaxDepth = 64;                   // nesting of arrays and objects
inline constexpr size_t kMaxBytes = size_t(64) << 20;  // of one file

// Parses strict RFC 8259. `file` is the name used in messages. Throws Error(BadInput) with the place of a syntax
// error, text after the document, a byte-order mark, a NUL, invalid UTF-8, a number that no double holds, nesting
// deeper than kMaxDepth, or keys that occur twice in one object (all of these at once).
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
  ObjectReader(const Value& value, std::string_view parent, std::string_view key, Diagnostics& diagnostics)
      : value_(value), parent_(parent), key_(key), diagnostics_(diagnostics) {
    if (!value.isObject()) reportKind();
  }

  [[gnu::always_inline]] const Value* find(std::string_view key) {  // any type; nullptr if absent
    known_.push_back(key);
    const Member* member = value_.findMember(key);
    if (!member) return nullptr;
    const size_t index = static_cast<size_t>(member - value_.members.data());
    if (index < 64) asked_ |= uint64_t(1) << index;
    return &member->value;
  }
  [[gnu::always_inline]] const Value* require(std::string_view key) {  // reports an absent member
    const Value* value = find(key);
    if (!value) reportMissing(key);
    return value;
  }
  [[gnu::always_inline]] const Value* object(std::string_view key) {  // nullptr if absent or wrong
    return object(key, find(key));
  }
  const Value* array(std::string_view key);
  // Looks up several keys, a constant array, in one walk over the members. Returns their values, nullptr where absent.
  template <const auto& keys>
  [[gnu::always_inline]] auto findAll() {
    listed_ = keys;
    std::array<const Value*, std::size(keys)> found = {};
    uint64_t bit = 1;
    for (const Member& member : value_.members) {
      const auto isAny = [&]<size_t... I>(std::index_sequence<I...>) {
        return ((sameText(member.key, keys[I]) && (found[I] = &member.value)) || ...);
      };
      if (isAny(std::make_index_sequence<std::size(keys)>())) asked_ |= bit;
      bit <<= 1;
    }
    return found;
  }
  // Takes a value that findAll() returned; a value of another type is reported.
  const Value* object(std::string_view key, const Value* value) {
    return !value || value->isObject() ? value : notObject(key, *value);
  }
  void expectText(std::string_view key, const Value* value) {
    if (value && !value->isString()) textOf(key, *value, {});
  }
  [[gnu::cold]] void reportMissing(std::string_view key);
  [[gnu::always_inline]] bool has(std::string_view key) const { return value_.find(key) != nullptr; }

  double number(std::string_view key, double fallback, double min = -std::numeric_limits<double>::infinity(),
                double max = std::numeric_limits<double>::infinity());
  int64_t integer(std::string_view key, int64_t fallback, int64_t min = std::numeric_limits<int64_t>::min(),
                  int64_t max = std::numeric_limits<int64_t>::max());
  bool boolean(std::string_view key, bool fallback);
  [[gnu::always_inline]] std::string text(std::string_view key, std::string fallback = {}) {
    const Value* value = find(key);
    return value ? textOf(key, *value, std::move(fallback)) : fallback;
  }
  std::string choice(std::string_view key, std::string fallback, const std::vector<std::string>& choices);
  // An array of exactly `count` numbers; nullopt if absent or wrong.
  std::optional<std::vector<double>> numbers(std::string_view key, size_t count);

  void finish() {
    const size_t count = value_.members.size();
    if (count > 64 || (count > 0 && asked_ != ~uint64_t(0) >> (64 - count))) reportUnknown();
  }

  std::string pathOf(std::string_view key) const;  // "camera.fov_degrees"
  std::string path() const;
  const Value& value() const { return value_; }
  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  [[gnu::cold]] void wrong(std::string_view key, const Value& value, const std::string& expected);
  [[gnu::cold]] const Value* notObject(std::string_view key, const Value& value);
  std::string textOf(std::string_view key, const Value& value, std::string fallback);
  [[gnu::cold]] void reportKind();
  [[gnu::cold]] void reportUnknown();
  const Value& value_;
  std::string path_;  // used if there is no key
  std::string_view parent_, key_;
  Diagnostics& diagnostics_;
  SmallVector<std::string_view, 8> known_;
  std::span<const std::string_view> listed_;  // known as well
  uint64_t asked_ = 0;                        // a bit for each of the first 64 members that was asked for
};

// "a.b", or "b" if `path` is empty.
std::string joinPath(std::string_view path, std::string_view key);

}  // namespace fovea::json
