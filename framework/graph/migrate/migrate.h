// Graph files of earlier versions: what has other names or another place since then.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "framework/base/json.h"

namespace fovea::graph {

// The version of the graph files that this program writes and reads. A file says its own under `version`; one without is
// of version 1.
inline constexpr int64_t kGraphVersion = 2;

// Something that a migration changed or could not change, in words.
struct Change {
  json::Position where;
  std::string what;
  bool isDefault =
      false;  // the file says nothing of it: a default has changed, and the file now says what it was
};

// Brings a document to kGraphVersion, its `version` included. Values that stay keep their positions, and new ones have
// that of what they replace. Empty if the file has nothing that changed since its version, or none that is known.
std::vector<Change> migrate(json::Value& document);

// The text of a graph file with the same changes. All that they leave alone stays as it is written. Throws
// Error(BadInput) if the text is no JSON. `file`: its name in messages.
std::string migrateText(std::string_view text, std::string_view file, std::vector<Change>& changes);

// Brings a document to kGraphVersion, with a warning if it uses what has changed since its version. Reports a version that
// this program does not know.
void migrateLoaded(json::Value& document, Diagnostics& diagnostics);

}  // namespace fovea::graph
