#include "framework/graph/resolve.h"

#define XXH_INLINE_ALL  // names are short: calling the library would cost more than the hash
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "framework/base/same_text.h"
#include "framework/graph/expand.h"

namespace fovea::graph {
namespace {

inline uint64_t hashOf(std::string_view text) { return XXH3_64bits(text.data(), text.size()); }

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

std::string_view SymbolTable::keep(std::string_view text) {
  if (blocks_.empty() || blocks_.back().size - blocks_.back().used < text.size()) {
    const size_t size = std::max<size_t>(1024, text.size());
    blocks_.push_back({std::make_unique_for_overwrite<char[]>(size), size, 0});
  }
  Block& block = blocks_.back();
  char* kept = block.characters.get() + std::exchange(block.used, block.used + text.size());
  std::copy(text.begin(), text.end(), kept);
  return {kept, text.size()};
}

Symbol SymbolTable::intern(std::string_view text) {
  if (slots_.empty()) reserve(32);
  const uint64_t hash = hashOf(text);
  const size_t slot = slotOf(text, hash);
  const Symbol known = slots_[slot].symbol;
  return known != kNone ? known : add(text, hash, slot);
}

// A text that is not there yet, at the free slot where it belongs.
Symbol SymbolTable::add(std::string_view text, uint64_t hash, size_t slot) {
  if (slots_.size() < 2 * (entries_.size() + 1)) {
    reserve(2 * entries_.size());
    slot = slotOf(text, hash);
  }
  const auto symbol = static_cast<Symbol>(entries_.size());
  slots_[slot] = {tagOf(hash), symbol};
  entries_.emplace_back(keep(text), hash);
  return symbol;
}

Symbol SymbolTable::find(std::string_view text) const {
  return slots_.empty() ? kNone : slots_[slotOf(text, hashOf(text))].symbol;
}

Description resolve(const json::Value& document, const std::filesystem::path& file,
                    const LoadOptions& options, Diagnostics& diagnostics) {
  Description description;
  description.name = file.stem().string();
  json::Value merged;
  detail::Expander expander(description, options, diagnostics);
  expander.expandRoot(mergeExtends(document, file, options, diagnostics, merged), file);
  expander.resolveWires();
  expander.reportUnused();
  return description;
}

}  // namespace fovea::graph
