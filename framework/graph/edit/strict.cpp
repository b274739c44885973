#include "framework/graph/edit/strict.h"

#include <fmt/format.h>

#include "framework/graph/resolve/expand.h"

namespace fovea::graph {
namespace {

class Repetition {
 public:
  explicit Repetition(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  // own: what the file says; inherited: what is there without it.
  void compare(const json::Value& own, const json::Value& inherited, const std::string& path) {
    for (const json::Member& member : own.members) {
      const json::Value* before = inherited.find(member.key);
      if (!before || isOfTheFile(path, member.key)) continue;
      const std::string memberPath = json::joinPath(path, member.key);
      if (member.value.isObject() && before->isObject()) {
        const bool another = path == "passes" && detail::replacesWhole(*before, member.value);
        if (!another) compare(member.value, *before, memberPath);
      } else if (json::print(member.value) == json::print(*before)) {
        diagnostics_.warning(member.keyWhere.location(), memberPath,
                             fmt::format("`{}` is {} without this", member.key, member.value.describe()),
                             "leave it out");
      }
    }
  }

 private:
  // A type beside other changes says what the pass is; the version and the schema are of each file.
  static bool isOfTheFile(const std::string& path, const std::string& key) {
    return path.empty() && (key == "$schema" || key == "version" || key == "extends");
  }

  Diagnostics& diagnostics_;
};

}  // namespace

void warnAboutRepetition(const std::filesystem::path& file, const LoadOptions& options,
                         Diagnostics& diagnostics) {
  Diagnostics ignored;
  const json::Value own = detail::readGraphFile(file, ignored);
  const json::Value* base = own.find("extends");
  if (!base) return;
  const std::filesystem::path inherited = findGraphFile(base->string, file, options.searchPaths);
  Repetition(diagnostics).compare(own, loadMerged(inherited.string(), {{}, options.searchPaths}), {});
}

}  // namespace fovea::graph
