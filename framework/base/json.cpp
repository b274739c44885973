#include "framework/base/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <unordered_set>

#include "framework/base/files.h"
#include "framework/base/text_file.h"

namespace fovea::json {
namespace {

constexpr size_t kMaxValues = 4'000'000;  // of one file; they take far more memory than their text

// Computes line and column of ascending byte offsets.
class LineCounter {
 public:
  LineCounter(std::string_view text, std::shared_ptr<const std::string> file)
      : text_(text), file_(std::move(file)) {}

  Position at(size_t offset) {
    if (offset < offset_) offset_ = 0, line_ = 1, column_ = 1;
    for (; offset_ < offset && offset_ < text_.size(); ++offset_) {
      const auto c = static_cast<unsigned char>(text_[offset_]);
      if (c == '\n') {
        ++line_;
        column_ = 1;
      } else if ((c & 0xC0) != 0x80) {  // not a UTF-8 continuation byte
        ++column_;
      }
    }
    return {file_, line_, column_};
  }

 private:
  std::string_view text_;
  std::shared_ptr<const std::string> file_;
  size_t offset_ = 0;
  int line_ = 1, column_ = 1;
};

// Builds a Value from nlohmann's events. The parser does not tell where a token starts, but it reports every token
// except ',' and ':' in the order of the text. The start of the next token is therefore found by skipping these and
// white space, and its end by the shape of the token.
class Builder : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(std::string_view text, std::shared_ptr<const std::string> file)
      : text_(text), lines_(text, std::move(file)) {}

  Value root;
  Diagnostics diagnostics;

  bool null() override {
    return scalar(Value::Type::Null, [](Value&) {});
  }
  bool boolean(bool v) override {
    return scalar(Value::Type::Bool, [&](Value& value) { value.boolean = v; });
  }
  bool number_integer(number_integer_t v) override { return integer(v); }
  bool number_unsigned(number_unsigned_t v) override {
    if (v <= static_cast<uint64_t>(std::numeric_limits<int64_t>::max()))
      return integer(static_cast<int64_t>(v));
    return number_float(static_cast<double>(v), {});
  }
  bool number_float(number_float_t v, const string_t&) override {
    return scalar(Value::Type::Real, [&](Value& value) { value.setReal(v); });
  }
  bool string(string_t& v) override {
    return scalar(Value::Type::String, [&](Value& value) { value.string = std::move(v); });
  }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Value::Type::Object); }
  bool start_array(std::size_t) override { return open(Value::Type::Array); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& v) override {
    const Position where = nextToken();
    if (!keys_.back().insert(v).second)
      diagnostics.error(where.location(), {}, fmt::format("the key \"{}\" occurs twice in this object", v),
                        "remove or rename one of them");
    open_.back()->members.push_back({std::move(v), {}, where});
    return true;
  }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& e) override {
    std::string reason = e.what();
    // "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error while ..."
    if (const size_t colon = reason.find(": "); colon != std::string::npos)
      reason = reason.substr(colon + 2);
    else if (const size_t bracket = reason.find("] "); bracket != std::string::npos)
      reason = reason.substr(bracket + 2);
    if (const size_t read = reason.find("; last read:"); read != std::string::npos) reason.resize(read);
    size_t start = skipSeparators(end_);
    if (reason.find("unexpected ','") != std::string::npos ||
        reason.find("unexpected ':'") != std::string::npos)
      start = position - 1;
    diagnostics.error(lines_.at(std::min(start, text_.size())).location(), {}, "not valid JSON: " + reason);
    return false;
  }

 private:
  bool integer(int64_t v) {
    return scalar(Value::Type::Int, [&](Value& value) {
      value.integer = v;
      value.real = static_cast<double>(v);
    });
  }

  size_t skipSeparators(size_t at) const {
    while (at < text_.size() && std::string_view(" \t\r\n,:").find(text_[at]) != std::string_view::npos) ++at;
    return at;
  }

  // Skips a number as defined by RFC 8259; "01" is two of them.
  size_t skipNumber(size_t at) const {
    auto digits = [&] {
      while (at < text_.size() && text_[at] >= '0' && text_[at] <= '9') ++at;
    };
    auto is = [&](std::string_view any) {
      return at < text_.size() && any.find(text_[at]) != std::string_view::npos;
    };
    if (is("-")) ++at;
    is("0") ? void(++at) : digits();
    if (is(".")) {
      ++at;
      digits();
    }
    if (is("eE")) {
      ++at;
      if (is("+-")) ++at;
      digits();
    }
    return at;
  }

  // The start of the next token; moves end_ past it.
  Position nextToken() {
    const size_t start = skipSeparators(end_);
    size_t at = start;
    if (at < text_.size() && text_[at] == '"') {
      for (++at; at < text_.size() && text_[at] != '"'; ++at)
        if (text_[at] == '\\') ++at;
      ++at;
    } else if (at < text_.size() && std::string_view("{}[]").find(text_[at]) != std::string_view::npos) {
      ++at;
    } else if (at < text_.size() && (text_[at] == 't' || text_[at] == 'n')) {
      at += 4;
    } else if (at < text_.size() && text_[at] == 'f') {
      at += 5;
    } else {
      at = skipNumber(at);
    }
    end_ = at;
    return lines_.at(start);
  }

  Value& place() {
    if (open_.empty()) return root;
    Value& parent = *open_.back();
    if (parent.type == Value::Type::Array) return parent.items.emplace_back();
    return parent.members.back().value;
  }

  template <class Set>
  bool scalar(Value::Type type, const Set& set) {
    const Position where = nextToken();
    if (tooMany(where)) return false;
    Value& value = place();
    value.type = type;
    value.where = where;
    set(value);
    return true;
  }

  bool tooMany(const Position& where) {
    if (++values_ <= kMaxValues) return false;
    diagnostics.error(where.location(), {}, fmt::format("more than {} values in one file", kMaxValues),
                      "divide the file, or put numbers into a binary one");
    return true;
  }

  bool open(Value::Type type) {
    const Position where = nextToken();
    if (open_.size() >= static_cast<size_t>(kMaxDepth)) {
      diagnostics.error(where.location(), {}, fmt::format("nested deeper than {} levels", kMaxDepth));
      return false;
    }
    if (tooMany(where)) return false;
    Value& value = place();
    value.type = type;
    value.where = where;
    open_.push_back(&value);  // stays valid, because the parent grows only after this one is closed
    keys_.emplace_back();
    return true;
  }

  // No list keeps room to grow. Otherwise resolving a graph of thousands of passes, whose document then lies scattered
  // in memory, takes up to twice as long.
  bool close() {
    nextToken();
    open_.back()->items.shrink_to_fit();
    open_.back()->members.shrink_to_fit();
    open_.pop_back();
    keys_.pop_back();
    return true;
  }

  std::string_view text_;
  LineCounter lines_;
  size_t end_ = 0, values_ = 0;
  std::vector<Value*> open_;
  std::vector<std::unordered_set<std::string>> keys_;
};

}  // namespace

void Value::setReal(double number) {
  type = Type::Real;
  real = number;
  integer = std::abs(number) < 0x1p63 && number == std::trunc(number) ? static_cast<int64_t>(number) : 0;
}

std::string Value::describe() const {
  switch (type) {
    case Type::Null:
      return "null";
    case Type::Bool:
      return boolean ? "true" : "false";
    case Type::Int:
      return fmt::format("the number {}", integer);
    case Type::Real:
      return fmt::format("the number {}", real);
    case Type::String:
      if (string.size() > 60) return fmt::format("the text \"{}...\"", string.substr(0, 57));
      return fmt::format("the text \"{}\"", string);
    case Type::Array:
      return "an array";
    case Type::Object:
      return "an object";
  }
  return "?";
}

Value parse(std::string_view text, std::string_view file) {
  text = withoutByteOrderMark(text);
  auto name = std::make_shared<const std::string>(file);
  LineCounter lines(text, name);
  auto fail = [&](size_t offset, std::string message, std::string remedy) {
    throw Error(
        ExitCode::BadInput,
        std::vector<Diagnostic>{
            {Severity::Error, lines.at(offset).location(), {}, std::move(message), std::move(remedy)}});
  };
  if (isUtf16(text)) fail(0, "the file is UTF-16", "save it as UTF-8");
  // nlohmann would skip a second mark, and takes a NUL for the end of the text; either would hide something.
  if (text.starts_with(kByteOrderMark))
    fail(0, "the file has two byte-order marks", "save it as UTF-8 without BOM");
  if (const size_t nul = text.find('\0'); nul != std::string_view::npos)
    fail(nul, "the file contains a NUL byte", "is this a text file?");
  Builder builder(text, name);
  const bool ok = nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
  builder.diagnostics.throwIfErrors();
  if (!ok) fail(text.size(), "not valid JSON", {});
  return std::move(builder.root);
}

Value parseFile(const std::filesystem::path& file) {
  if (const std::string reason = whyUnreadable(file); !reason.empty())
    throw Error(ExitCode::BadInput, fmt::format("cannot read {}: {}", file.string(), reason));
  noteRead(file);
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw Error(ExitCode::BadInput, fmt::format("cannot read {}: {}", file.string(), std::strerror(errno)));
  std::string text;
  char block[65536];
  while (in.read(block, sizeof block) || in.gcount() > 0) {
    text.append(block, static_cast<size_t>(in.gcount()));
    if (text.size() > kMaxBytes)
      throw Error(ExitCode::BadInput,
                  fmt::format("{} is larger than {} MiB", file.string(), kMaxBytes >> 20));
  }
  if (in.bad())
    throw Error(ExitCode::BadInput, fmt::format("cannot read {}: input/output error", file.string()));
  return parse(text, file.string());
}

std::string joinPath(std::string_view path, std::string_view key) {
  std::string joined;
  joined.reserve(path.size() + 1 + key.size());
  joined.append(path);
  if (!path.empty()) joined.push_back('.');
  return joined.append(key);
}

// ---- ObjectReader ------------------------------------------------------------------------------------

ObjectReader::ObjectReader(const Value& value, std::string path, Diagnostics& diagnostics)
    : value_(value), path_(std::move(path)), diagnostics_(diagnostics) {
  if (!value.isObject()) reportKind();
}

ObjectReader::ObjectReader(const Value& value, std::string_view parent, std::string_view key,
                           Diagnostics& diagnostics)
    : value_(value), parent_(parent), key_(key), diagnostics_(diagnostics) {
  if (!value.isObject()) reportKind();
}

void ObjectReader::reportKind() {
  diagnostics_.error(value_.where.location(), path(),
                     fmt::format("expected an object, found {}", value_.describe()));
}

std::string ObjectReader::path() const { return key_.empty() ? path_ : joinPath(parent_, key_); }

std::string ObjectReader::pathOf(std::string_view key) const { return joinPath(path(), key); }

void ObjectReader::wrong(std::string_view key, const Value& value, const std::string& expected) {
  diagnostics_.error(value.where.location(), pathOf(key),
                     fmt::format("`{}`: expected {}, found {}", key, expected, value.describe()));
}

const Value* ObjectReader::find(std::string_view key) {
  if (known_.empty()) known_.reserve(8);
  known_.push_back(key);
  const Member* member = value_.findMember(key);
  if (!member) return nullptr;
  const auto index = static_cast<size_t>(member - value_.members.data());
  if (index < 64) asked_ |= uint64_t(1) << index;
  return &member->value;
}

const Value* ObjectReader::require(std::string_view key) {
  const Value* value = find(key);
  if (!value && value_.isObject())
    diagnostics_.error(value_.where.location(), path(), fmt::format("`{}` is missing", key));
  return value;
}

const Value* ObjectReader::object(std::string_view key) {
  const Value* value = find(key);
  if (value && !value->isObject()) return wrong(key, *value, "an object"), nullptr;
  return value;
}

const Value* ObjectReader::array(std::string_view key) {
  const Value* value = find(key);
  if (value && !value->isArray()) return wrong(key, *value, "an array"), nullptr;
  return value;
}

double ObjectReader::number(std::string_view key, double fallback, double min, double max) {
  const Value* value = find(key);
  if (!value) return fallback;
  if (value->isNumber() && value->real >= min && value->real <= max) return value->real;
  if (!value->isNumber() || (std::isinf(min) && std::isinf(max)))
    return wrong(key, *value, "a number"), fallback;
  if (std::isinf(max))
    wrong(key, *value, fmt::format("a number of at least {}", min));
  else if (std::isinf(min))
    wrong(key, *value, fmt::format("a number of at most {}", max));
  else
    wrong(key, *value, fmt::format("a number from {} to {}", min, max));
  return fallback;
}

int64_t ObjectReader::integer(std::string_view key, int64_t fallback, int64_t min, int64_t max) {
  const Value* value = find(key);
  if (!value) return fallback;
  if (value->isInt() && value->integer >= min && value->integer <= max) return value->integer;
  const bool below = min != std::numeric_limits<int64_t>::min(),
             above = max != std::numeric_limits<int64_t>::max();
  if (!value->isInt() || (!below && !above))
    wrong(key, *value, "a whole number");
  else if (!above)
    wrong(key, *value, fmt::format("a whole number of at least {}", min));
  else
    wrong(key, *value, fmt::format("a whole number from {} to {}", min, max));
  return fallback;
}

bool ObjectReader::boolean(std::string_view key, bool fallback) {
  const Value* value = find(key);
  if (value && !value->isBool()) wrong(key, *value, "true or false");
  return value && value->isBool() ? value->boolean : fallback;
}

std::string ObjectReader::text(std::string_view key, std::string fallback) {
  const Value* value = find(key);
  if (value && value->isString()) return value->string;
  if (value) wrong(key, *value, "a text");
  return fallback;
}

std::string ObjectReader::choice(std::string_view key, std::string fallback,
                                 const std::vector<std::string>& choices) {
  const Value* value = find(key);
  if (!value) return fallback;
  if (value->isString() && std::find(choices.begin(), choices.end(), value->string) != choices.end())
    return value->string;
  const std::string nearest = value->isString() ? nearestName(value->string, choices) : std::string();
  diagnostics_.error(
      value->where.location(), pathOf(key),
      fmt::format("`{}`: expected one of {}, found {}", key, fmt::join(choices, ", "), value->describe()),
      nearest.empty() ? std::string() : fmt::format("did you mean `{}`?", nearest));
  return fallback;
}

std::optional<std::vector<double>> ObjectReader::numbers(std::string_view key, size_t count) {
  const Value* value = find(key);
  if (!value) return std::nullopt;
  bool good = value->isArray() && value->items.size() == count;
  std::vector<double> result;
  for (const Value& item : value->items) {
    good = good && item.isNumber();
    result.push_back(item.real);
  }
  if (good) return result;
  wrong(key, *value, fmt::format("an array of {} numbers", count));
  return std::nullopt;
}

void ObjectReader::finish() {
  if (value_.members.size() == static_cast<size_t>(std::popcount(asked_))) return;
  std::vector<std::string> known;  // some are asked for twice
  for (const std::string_view key : known_)
    if (std::find(known.begin(), known.end(), key) == known.end()) known.emplace_back(key);
  for (const Member& member : value_.members) {
    if (std::find(known.begin(), known.end(), member.key) != known.end()) continue;
    const std::string nearest = nearestName(member.key, known);
    std::string remedy = known.empty()     ? std::string()
                         : nearest.empty() ? fmt::format("known here: {}", fmt::join(known, ", "))
                                           : fmt::format("did you mean `{}`?", nearest);
    diagnostics_.error(member.keyWhere.location(), pathOf(member.key),
                       fmt::format("unknown key `{}`", member.key), std::move(remedy));
  }
}

}  // namespace fovea::json
