// A graph before it is compiled: read from a file or from text, changed, checked and saved. fovea/session.h runs it.
//
//   graph::Document discs = graph::Document::load("ir_1000").patched(R"({"parameters": {"kernel": "disc"}})");
//   discs.save("discs.json");
//   graph::Session session(discs, scene);
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/error.h"

namespace fovea::graph {

// Its values know the places where they were written, so that messages about a changed graph name them.
class Document {
 public:
  // A file, or the bare name of a stock graph. Throws Error(BadInput) if there is none or it is no JSON.
  static Document load(const std::string& nameOrFile);
  // `file` is its name in messages and need not exist; what the text extends is looked up in its folder first.
  static Document parse(std::string_view text, const std::filesystem::path& file);

  // With everything that it extends merged in. Throws Error(BadInput) with every mistake, as patched() does.
  Document merged() const;
  // merged(), and over it a patch as a file that extends it would be: what the patch names replaces the old, and null
  // removes it. `source` is the patch's name in messages.
  Document patched(std::string_view patch, const std::string& source = "patch") const;

  std::string text() const;  // JSON, indented by two spaces
  // Throws Error(CannotWrite).
  void save(const std::filesystem::path& file) const;
  const std::filesystem::path& file() const;

  struct Contents;  // framework/graph/document/document.h
  const Contents& contents() const { return *contents_; }

 private:
  explicit Document(Contents contents);
  std::shared_ptr<const Contents> contents_;
};

// How a plan is written: order, barriers and memory of the passes for people, as a drawing for Graphviz, or as JSON.
enum class PlanForm { Text, Dot, Json };

struct CheckOptions {
  glm::uvec2 size{1024, 1024};   // pixels
  std::vector<std::string> set;  // parameter values: "bounces=3", "blur.radius=3"
};

// The plan of a graph, made without a device or a scene. Throws Error(BadInput) with every mistake of the graph;
// warnings are added to `messages`.
std::string check(const Document& document, PlanForm form, const CheckOptions& options,
                  Diagnostics& messages);

}  // namespace fovea::graph
