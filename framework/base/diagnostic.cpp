#include "fovea/error.h"

#include <algorithm>
#include <numeric>

#include "framework/base/legible.h"

namespace fovea {
namespace {

const char* severityName(Severity s) {
  switch (s) {
    case Severity::Note:
      return "note";
    case Severity::Warning:
      return "warning";
    case Severity::Error:
      return "error";
  }
  return "error";
}

// A file of another kind can have a million mistakes.
constexpr size_t kMostErrors = 20;

// The first errors, without the warnings, if there are too many to read.
std::vector<Diagnostic> firstErrors(std::vector<Diagnostic> list) {
  if (list.size() <= kMostErrors) return list;
  std::erase_if(list, [](const Diagnostic& d) { return d.severity != Severity::Error; });
  if (list.size() <= kMostErrors) return list;
  const size_t more = list.size() - kMostErrors;
  list.resize(kMostErrors);
  list.push_back(
      {Severity::Error, {list[0].where.file, 0, 0}, {}, std::to_string(more) + " more mistakes", {}});
  return list;
}

std::string formatAll(const std::vector<Diagnostic>& list) {
  std::string text;
  for (const Diagnostic& d : list) {
    if (!text.empty()) text += '\n';
    text += d.format();
  }
  return text;
}

// Optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbours cost 1.
size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    for (size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

// A file that is used twice, such as that of a sub-graph, would tell each of its mistakes twice.
bool isTold(const std::vector<Diagnostic>& list, const Diagnostic& d) {
  return std::any_of(list.begin(), list.end(), [&](const Diagnostic& other) {
    return other.where.line == d.where.line && other.where.column == d.where.column &&
           other.message == d.message && other.path == d.path && other.where.file == d.where.file;
  });
}

void addOnce(std::vector<Diagnostic>& list, Diagnostic d) {
  if (!isTold(list, d)) list.push_back(std::move(d));
}

}  // namespace

std::string Diagnostic::format() const {
  std::string text;
  if (!where.file.empty()) {
    text += where.file;
    if (where.line > 0) text += ':' + std::to_string(where.line);
    if (where.line > 0 && where.column > 0) text += ':' + std::to_string(where.column);
    text += ": ";
  }
  text += severityName(severity);
  text += ": ";
  text += message;
  if (!path.empty()) text += " (at " + path + ")";
  if (!remedy.empty()) text += "\n  -> " + remedy;
  return legible(text);
}

void Diagnostics::error(SourceLocation where, std::string path, std::string message, std::string remedy) {
  addOnce(list_, {Severity::Error, std::move(where), std::move(path), std::move(message), std::move(remedy)});
}

void Diagnostics::warning(SourceLocation where, std::string path, std::string message, std::string remedy) {
  addOnce(list_,
          {Severity::Warning, std::move(where), std::move(path), std::move(message), std::move(remedy)});
}

bool Diagnostics::hasErrors() const {
  return std::any_of(list_.begin(), list_.end(),
                     [](const Diagnostic& d) { return d.severity == Severity::Error; });
}

std::string Diagnostics::format() const { return formatAll(list_); }

void Diagnostics::throwIfErrors(ExitCode code) const {
  if (hasErrors()) throw Error(code, list_);
}

Error::Error(ExitCode code, std::string message, std::string remedy)
    : Error(code, std::vector<Diagnostic>{{Severity::Error, {}, {}, std::move(message), std::move(remedy)}}) {
}

Error::Error(ExitCode code, std::vector<Diagnostic> diagnostics)
    : code_(code), diagnostics_(firstErrors(std::move(diagnostics))), text_(formatAll(diagnostics_)) {}

std::string nearestName(std::string_view word, const std::vector<std::string>& candidates) {
  word = word.substr(0, 64);
  const size_t limit = std::max<size_t>(1, word.size() / 3);
  std::string best;
  size_t bestDistance = limit + 1;
  for (const std::string& candidate : candidates) {
    const std::string_view name = std::string_view(candidate).substr(0, 64);
    // The difference of the lengths has to be inserted or removed, so the distance is at least that.
    if (std::max(word.size(), name.size()) - std::min(word.size(), name.size()) >= bestDistance) continue;
    const size_t distance = editDistance(word, name);
    if (distance < bestDistance) {
      bestDistance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace fovea
