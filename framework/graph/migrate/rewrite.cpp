// Writes a changed document over the text that it was read from.
#include <map>

#include "framework/graph/migrate/migrate.h"

namespace fovea::graph {
namespace {

using json::Member;
using json::Value;

bool same(const Value& a, const Value& b) {
  if (a.type != b.type || a.boolean != b.boolean || a.string != b.string || a.integer != b.integer ||
      a.real != b.real || a.members.size() != b.members.size() || a.items.size() != b.items.size())
    return false;
  for (size_t i = 0; i < a.members.size(); ++i)
    if (a.members[i].key != b.members[i].key || !same(a.members[i].value, b.members[i].value)) return false;
  for (size_t i = 0; i < a.items.size(); ++i)
    if (!same(a.items[i], b.items[i])) return false;
  return true;
}

class Rewriter {
 public:
  Rewriter(std::string_view text, const Value& before) : text_(text) {
    for (size_t at = 0, line = 1; line == 1 || at != 0; at = text.find('\n', at) + 1, ++line)
      lines_.push_back(at);
    index(before);
    begin_ = offsetOf(before.where);
  }

  std::string run(const Value& after) const {
    return std::string(text_.substr(0, begin_)) + textOf(after) + std::string(text_.substr(endOf(begin_)));
  }

 private:
  using Place = std::pair<int, int>;
  static Place placeOf(const json::Position& where) { return {where.line, where.column}; }

  // Columns count characters.
  size_t offsetOf(const json::Position& where) const {
    size_t at = lines_[static_cast<size_t>(where.line) - 1];
    for (int column = 1; column < where.column; ++column) do
        ++at;
      while (at < text_.size() && (static_cast<unsigned char>(text_[at]) & 0xc0) == 0x80);
    return at;
  }

  size_t endOfString(size_t at) const {
    for (++at; text_[at] != '"'; ++at)
      if (text_[at] == '\\') ++at;
    return at + 1;
  }

  // Of the value that begins at `at`; the text is known to be JSON.
  size_t endOf(size_t at) const {
    if (text_[at] == '"') return endOfString(at);
    if (text_[at] != '{' && text_[at] != '[')
      return std::min(text_.find_first_of(",]} \t\r\n", at), text_.size());
    int depth = 0;
    do {
      if (text_[at] == '"') {
        at = endOfString(at);
        continue;
      }
      if (text_[at] == '{' || text_[at] == '[') ++depth;
      if (text_[at] == '}' || text_[at] == ']') --depth;
      ++at;
    } while (depth > 0);
    return at;
  }

  void index(const Value& value) {
    known_.emplace(placeOf(value.where), &value);
    for (const Member& member : value.members) index(member.value);
    for (const Value& item : value.items) index(item);
  }

  std::string_view between(size_t begin, size_t end) const { return text_.substr(begin, end - begin); }

  // What stands before each key of an object in the text: line ends and spaces.
  std::map<Place, std::string_view> gapsOf(const Value& object) const {
    std::map<Place, std::string_view> gaps;
    size_t end = offsetOf(object.where) + 1;
    for (const Member& member : object.members) {
      const size_t key = offsetOf(member.keyWhere), comma = text_.find(',', end);
      gaps[placeOf(member.keyWhere)] = between(comma < key ? comma + 1 : end, key);
      end = endOf(offsetOf(member.value.where));
    }
    return gaps;
  }

  std::string textOf(const Value& after) const {
    const auto found = known_.find(placeOf(after.where));
    const Value* before = found == known_.end() ? nullptr : found->second;
    if (before && same(*before, after)) {
      const size_t at = offsetOf(after.where);
      return std::string(between(at, endOf(at)));
    }
    if (!before || !before->isObject() || !after.isObject() || before->members.empty())
      return onOneLine(after);
    const std::map<Place, std::string_view> gaps = gapsOf(*before);
    const std::string_view usual = gaps.at(placeOf(before->members.front().keyWhere));
    std::string text;
    for (const Member& member : after.members) {
      const Member* kept = before->findMember(member.key);
      const std::string_view gap = text.empty() || !kept ? usual : gaps.at(placeOf(kept->keyWhere));
      text += text.empty() ? "{" : gap.empty() ? ", " : ",";
      text.append(gap);
      if (kept)
        text.append(between(offsetOf(kept->keyWhere), offsetOf(kept->value.where)));
      else
        text.append(keyOf(member));
      text.append(textOf(member.value));
    }
    if (text.empty()) return "{}";
    const size_t last = endOf(offsetOf(before->members.back().value.where));
    return text.append(between(last, endOf(offsetOf(before->where))));
  }

  static std::string keyOf(const Member& member) {
    Value key;
    key.type = Value::Type::String;
    key.string = member.key;
    std::string text = json::print(key);
    text.back() = ':';
    return text + ' ';
  }

  // A new value, with what was read inside it.
  std::string onOneLine(const Value& value) const {
    std::string text;
    if (!value.isObject()) {
      text = json::print(value);
      text.pop_back();
      return text;
    }
    for (const Member& member : value.members)
      text.append(text.empty() ? "{ " : ", ").append(keyOf(member)).append(textOf(member.value));
    return text.empty() ? "{}" : text + " }";
  }

  std::string_view text_;
  std::vector<size_t> lines_;
  std::map<Place, const Value*> known_;
  size_t begin_ = 0;
};

}  // namespace

std::string migrateText(std::string_view text, std::string_view file, std::vector<Change>& changes) {
  const Value before = json::parse(text, file);
  Value after = before;
  changes = migrate(after);
  return same(before, after) ? std::string(text) : Rewriter(text, before).run(after);
}

}  // namespace fovea::graph
