#include "framework/graph/compile/resolve.h"

#define XXH_INLINE_ALL  // names are short, so a call of the library would cost more than the hash
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "framework/base/same_text.h"
#include "framework/graph/compile/expand.h"

namespace fovea::graph {
namespace {

constexpr size_t kShort = 16;  // texts up to this many bytes are hashed and compared without a call

inline uint64_t hashOf(std::string_view text) { return XXH3_64bits(text.data(), text.size()); }

// The same as file.stem(), which would first split the path.
std::string stemOf(const std::filesystem::path& file) {
  std::string_view name = file.native();
  name.remove_prefix(name.rfind('/') + 1);
  const size_t dot = name.rfind('.');
  return std::string(dot == 0 || name == ".." ? name : name.substr(0, dot));
}

}  // namespace

void SymbolTable::reserve(size_t count) {
  entries_.reserve(count);
  if (slots_.size() >= 2 * count) return;
  slots_.assign(std::bit_ceil(2 * count), {});
  for (Symbol symbol = 0; symbol < entries_.size(); ++symbol) {
    const auto& [text, hash] = entries_[symbol];
    slots_[slotOf(text, hash)] = {tagOf(hash), symbol};
  }
}

inline size_t SymbolTable::slotOf(std::string_view text, uint64_t hash) const {
  const size_t mask = slots_.size() - 1;
  for (size_t slot = hash & mask;; slot = (slot + 1) & mask) {
    const auto [tag, symbol] = slots_[slot];
    if (symbol == kNone || (tag == tagOf(hash) && sameText(entries_[symbol].text, text))) return slot;
  }
}

void SymbolTable::addBlock(size_t least) {
  const size_t size = std::max<size_t>(1024, least);
  blocks_.push_back({std::make_unique_for_overwrite<char[]>(size), size, 0});
}

Symbol SymbolTable::intern(std::string_view text) {
  return slots_.empty() || text.size() > kShort ? internAny(text) : internHere(text);
}

Symbol SymbolTable::find(std::string_view text) const {
  if (slots_.empty()) return kNone;
  return text.size() > kShort ? findLong(text) : findHere(text);
}

inline Symbol SymbolTable::internHere(std::string_view text) {
  const uint64_t hash = hashOf(text);
  const size_t slot = slotOf(text, hash);
  const Symbol known = slots_[slot].symbol;
  return known != kNone ? known : add(text, hash, slot);
}

inline Symbol SymbolTable::findHere(std::string_view text) const {
  return slots_[slotOf(text, hashOf(text))].symbol;
}

Symbol SymbolTable::internAny(std::string_view text) {
  if (slots_.empty()) reserve(32);
  return internHere(text);
}

Symbol SymbolTable::findLong(std::string_view text) const { return findHere(text); }

// Adds a new text at the free slot where it belongs.
Symbol SymbolTable::add(std::string_view text, uint64_t hash, size_t slot) {
  if (slots_.size() < 2 * (entries_.size() + 1)) {
    reserve(2 * entries_.size());
    slot = slotOf(text, hash);
  }
  const auto symbol = static_cast<Symbol>(entries_.size());
  slots_[slot] = {tagOf(hash), symbol};
  entries_.push_back({keep(text), hash});
  return symbol;
}

Description resolve(const json::Value& document, const std::filesystem::path& file,
                    const LoadOptions& options, Diagnostics& diagnostics) {
  Description description;
  description.name = stemOf(file);
  json::Value merged;
  detail::Expander expander(description, options, diagnostics);
  expander.expandRoot(mergeExtends(document, file, options, diagnostics, merged), file);
  expander.resolveWires();
  expander.reportUnused();
  return description;
}

}  // namespace fovea::graph
