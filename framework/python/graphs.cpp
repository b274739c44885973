// Graphs before they are compiled, and the lists of what there is.
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include "fovea/document.h"
#include "framework/python/casters.h"
#include "framework/python/locks.h"
#include "framework/python/module.h"

namespace fovea::python {

namespace nb = nanobind;
using namespace nb::literals;
using graph::Document;

namespace {

std::pair<std::string, std::vector<Diagnostic>> check(const Document& document, graph::PlanForm form,
                                                      glm::uvec2 size, const std::vector<std::string>& set) {
  const nb::gil_scoped_release released;
  const std::lock_guard lock(registryMutex());
  Diagnostics messages;
  std::string plan = graph::check(document, form, {size, set}, messages);
  return {std::move(plan), messages.list()};
}

}  // namespace

void addGraphs(nb::module_& module) {
  nb::enum_<graph::PlanForm>(module, "PlanForm", "How a plan is written.")
      .value("TEXT", graph::PlanForm::Text)
      .value("DOT", graph::PlanForm::Dot)
      .value("JSON", graph::PlanForm::Json);
  nb::class_<Document>(module, "Document", "A graph before it is compiled; use `fovea.Graph`.")
      .def_static("load", &Document::load, "name_or_file"_a)
      .def_static(
          "parse", [](std::string_view text, const std::string& file) { return Document::parse(text, file); },
          "text"_a, "file"_a)
      .def("merged", &Document::merged)
      .def("patched", &Document::patched, "patch"_a, "source"_a)
      .def("text", &Document::text)
      .def(
          "save", [](const Document& d, const std::string& file) { d.save(file); }, "file"_a)
      .def_prop_ro("file", [](const Document& d) { return d.file().string(); });
  module.def("check", &check, "document"_a, "form"_a, "size"_a, "set"_a,
             "The plan of a graph in this form, and warnings.");
}

}  // namespace fovea::python
