#include "framework/graph/resolve.h"

#include <xxhash.h>

#include "framework/graph/expand.h"

namespace fovea::graph {

Symbol SymbolTable::intern(std::string_view text) {
  if (const auto at = index_.find(text); at != index_.end()) return at->second;
  if (strings_.empty()) {  // room for a graph of a hundred passes
    index_.reserve(256);
    strings_.reserve(256);
    hashes_.reserve(256);
  }
  const auto symbol = static_cast<Symbol>(strings_.size());
  const auto at = index_.emplace(std::string(text), symbol).first;
  strings_.push_back(&at->first);
  hashes_.push_back(XXH3_64bits(text.data(), text.size()));
  return symbol;
}

Symbol SymbolTable::find(std::string_view text) const {
  const auto at = index_.find(text);
  return at == index_.end() ? kNone : at->second;
}

Description resolve(json::Value document, const std::filesystem::path& file, const LoadOptions& options,
                    Diagnostics& diagnostics) {
  Description description;
  description.name = file.stem().string();
  document = mergeExtends(std::move(document), file, options, diagnostics);
  detail::Expander expander(description, options, diagnostics);
  expander.expandRoot(std::move(document), file);
  expander.resolveWires();
  expander.reportUnused();
  return description;
}

}  // namespace fovea::graph
