// Errors as data: one type serves everything from the JSON parser to the command line.
#pragma once

#include <exception>
#include <string>
#include <string_view>
#include <vector>

namespace fovea {

// Exit codes of the program. samples/fovea/README.md documents them, and they are never renumbered.
enum class ExitCode : int {
  Ok = 0,
  Internal = 1,     // a defect of fovea itself or of a pass
  Usage = 2,        // wrong command line
  BadInput = 3,     // graph, scene, image or shader that cannot be used
  NoDevice = 4,     // no Vulkan device, or one that lacks a required feature
  OutOfMemory = 5,  // device or host memory exhausted
  DeviceLost = 6,
  CannotWrite = 7,    // an output file could not be written
  Slower = 8,         // `fovea bench passes`: something became slower than the baseline beyond the noise
  Interrupted = 130,  // Ctrl-C
};

// A position in a text file. Line and column count from 1; 0 means unknown.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
};

enum class Severity { Note, Warning, Error };

// A message to the user: what is wrong, where, and what to do about it.
struct Diagnostic {
  Severity severity = Severity::Error;
  SourceLocation where;
  std::string path;     // place inside the document, e.g. "passes.blur.params.radius"
  std::string message;  // what is wrong, naming the object and the limit
  std::string remedy;   // what the user can do; may be empty

  // "file.json:12:7: error: message (at passes.blur)"; the remedy follows on a line of its own.
  std::string format() const;
};

// All messages of one phase. A phase adds its messages and continues, so that every mistake of a
// file is reported at once.
class Diagnostics {
 public:
  void add(Diagnostic d) { list_.push_back(std::move(d)); }
  [[gnu::cold]] void error(SourceLocation where, std::string path, std::string message,
                           std::string remedy = {});
  [[gnu::cold]] void warning(SourceLocation where, std::string path, std::string message,
                             std::string remedy = {});
  bool hasErrors() const;
  const std::vector<Diagnostic>& list() const { return list_; }
  std::string format() const;  // one message per line
  // Throws Error(code) if there is an error among the messages.
  void throwIfErrors(ExitCode code = ExitCode::BadInput) const;

 private:
  std::vector<Diagnostic> list_;
};

// The exception type of fovea. what() returns the formatted diagnostics.
class Error : public std::exception {
 public:
  Error(ExitCode code, std::string message, std::string remedy = {});
  Error(ExitCode code, std::vector<Diagnostic> diagnostics);
  const char* what() const noexcept override { return text_.c_str(); }
  ExitCode code() const { return code_; }
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  ExitCode code_;
  std::vector<Diagnostic> diagnostics_;
  std::string text_;
};

// The candidate nearest to `word` by edit distance, or "" if none is close enough for `word`
// to be a likely misspelling.
std::string nearestName(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace fovea
