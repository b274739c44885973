#include "framework/graph/document/document.h"

#include <algorithm>

#include "framework/base/paths.h"
#include "framework/base/text_file.h"
#include "framework/graph/migrate/migrate.h"
#include "framework/graph/resolve/expand.h"

namespace fovea::graph {
namespace {

LoadOptions stockFolders() { return {{}, dataFolders("graphs")}; }

Document::Contents migrated(json::Value value, const std::filesystem::path& file) {
  Document::Contents contents{nullptr, file};
  migrateLoaded(value, contents.messages);
  contents.value = std::make_shared<const json::Value>(std::move(value));
  return contents;
}

}  // namespace

Document::Document(Contents contents) : contents_(std::make_shared<const Contents>(std::move(contents))) {}

Document Document::load(const std::string& nameOrFile) {
  const std::filesystem::path file = findGraph(nameOrFile, stockFolders().searchPaths);
  Contents contents{nullptr, file};
  contents.value = std::make_shared<const json::Value>(detail::readGraphFile(file, contents.messages));
  return Document(std::move(contents));
}

Document Document::parse(std::string_view text, const std::filesystem::path& file) {
  return Document(migrated(json::parse(text, file.string()), file));
}

Document Document::merged() const {
  Contents merged = *contents_;
  json::Value value = *mergeExtends(merged.value, merged.file, stockFolders(), merged.messages).document;
  merged.messages.throwIfErrors();
  std::erase_if(value.members, [](const json::Member& member) { return member.key == "extends"; });
  merged.value = std::make_shared<const json::Value>(std::move(value));
  return Document(std::move(merged));
}

Document Document::patched(std::string_view patch, const std::string& source) const {
  Contents base = *merged().contents_;
  const json::Value changes = json::parse(patch, source);
  if (!changes.isObject())
    base.messages.error(changes.where.location(), {},
                        "a patch of a graph is an object, this is " + changes.describe());
  json::Value value = mergeDocuments(*base.value, changes, base.messages);
  base.messages.throwIfErrors();
  base.value = std::make_shared<const json::Value>(std::move(value));
  return Document(std::move(base));
}

std::string Document::text() const { return json::print(*contents_->value); }

void Document::save(const std::filesystem::path& file) const { writeText(file, text()); }

const std::filesystem::path& Document::file() const { return contents_->file; }

Description resolve(const Document& document, const LoadOptions& options, Diagnostics& messages) {
  const Document::Contents& contents = document.contents();
  for (const Diagnostic& message : contents.messages.list()) messages.add(message);
  return resolve(contents.value, contents.file, options, messages);
}

}  // namespace fovea::graph
