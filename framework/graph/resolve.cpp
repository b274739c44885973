#include "framework/graph/resolve.h"

#define XXH_INLINE_ALL  // names are short: calling the library would cost more than the hash
#include <xxhash.h>

#include <algorithm>
#include <bit>

#include "framework/base/same_text.h"
#include "framework/graph/expand.h"

namespace fovea::graph {

void SymbolTable::reserve(size_t count) {
  hashes_.reserve(count);
  if (slots_.size() >= 2 * count) return;
  slots_.assign(std::bit_ceil(2 * count), {});
  for (Symbol symbol = 0; symbol < strings_.size(); ++symbol)
    slots_[slotOf(strings_[symbol], hashes_[symbol])] = {tagOf(hashes_[symbol]), symbol};
}

inline size_t SymbolTable::slotOf(std::string_view text, uint64_t hash) const {
  const size_t mask = slots_.size() - 1;
  for (size_t slot = hash & mask;; slot = (slot + 1) & mask) {
    const auto [tag, symbol] = slots_[slot];
    if (symbol == kNone || (tag == tagOf(hash) && sameText(strings_[symbol], text))) return slot;
  }
}

Symbol SymbolTable::intern(std::string_view text) {
  if (slots_.size() < 2 * (strings_.size() + 1)) reserve(std::max<size_t>(32, 2 * strings_.size()));
  const uint64_t hash = XXH3_64bits(text.data(), text.size());
  Slot& slot = slots_[slotOf(text, hash)];
  if (slot.symbol != kNone) return slot.symbol;
  slot = {tagOf(hash), static_cast<Symbol>(strings_.size())};
  strings_.emplace_back(text);
  hashes_.push_back(hash);
  return slot.symbol;
}

Symbol SymbolTable::find(std::string_view text) const {
  return slots_.empty() ? kNone : slots_[slotOf(text, XXH3_64bits(text.data(), text.size()))].symbol;
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
