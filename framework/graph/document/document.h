// What a graph::Document consists of.
#pragma once

#include <filesystem>
#include <memory>

#include "fovea/document.h"
#include "framework/base/json.h"
#include "framework/graph/compile/compile.h"

namespace fovea::graph {

struct Document::Contents {
  std::shared_ptr<const json::Value> value;
  std::filesystem::path file;
  Diagnostics messages{};  // of reading it
};

// Loads a document as load() does a file, with the messages of reading it.
Description resolve(const Document& document, const LoadOptions& options, Diagnostics& messages);

}  // namespace fovea::graph
