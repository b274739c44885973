// The pass types that there are, and passes on the CPU that are written in Python.
#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include "fovea/graph.h"
#include "fovea/scene.h"
#include "framework/python/arrays.h"
#include "framework/python/casters.h"
#include "framework/python/locks.h"
#include "framework/python/module.h"
#include "framework/python/raised.h"

namespace fovea::python {

namespace nb = nanobind;
using namespace nb::literals;

namespace {

// The argument of execute() of a pass in Python, which is valid only while that runs.
class PassFrame {
 public:
  PassFrame(graph::HostContext& context, const std::vector<std::string>& parameters)
      : context_(&context), parameters_(parameters) {}
  void end() { context_ = nullptr; }

  graph::HostContext& context() const {
    if (!context_)
      throw Error(ExitCode::Usage, "the frame of a pass is used after its execute() has returned",
                  "keep copies of what is needed later");
    return *context_;
  }
  const scene::Frame& frame() const { return context().frame(); }
  std::map<std::string, graph::Value> parameters() const {
    std::map<std::string, graph::Value> values;
    for (const std::string& name : parameters_) values.emplace(name, *context().parameters().find(name));
    return values;
  }

 private:
  graph::HostContext* context_;
  const std::vector<std::string>& parameters_;
};

// Where an exception of Python was raised: the innermost line of its traceback.
SourceLocation placeOf(const nb::python_error& error) {
  SourceLocation place;
  for (nb::object step = nb::borrow(error.traceback()); step.is_valid() && !step.is_none();
       step = step.attr("tb_next")) {
    place.file = nb::cast<std::string>(step.attr("tb_frame").attr("f_code").attr("co_filename"));
    place.line = nb::cast<int>(step.attr("tb_lineno"));
  }
  return place;
}

// An object of a class in Python, made by the framework.
class PythonPass : public graph::Pass {
 public:
  PythonPass(const std::string& type, std::vector<std::string> parameters)
      : parameters_(std::move(parameters)) {
    const nb::gil_scoped_acquire acquired;
    guarded([&] { object_ = nb::module_::import_("fovea.host_pass").attr("classes")[type.c_str()](); });
  }
  ~PythonPass() override {
    const nb::gil_scoped_acquire acquired;
    object_.reset();
  }

  void execute(graph::HostContext& context) override {
    const nb::gil_scoped_acquire acquired;
    const auto frame = nb::cast(new PassFrame(context, parameters_), nb::rv_policy::take_ownership);
    guarded([&] { object_.attr("execute")(frame); });
    nb::cast<PassFrame&>(frame).end();
  }

 private:
  template <class Work>
  static void guarded(const Work& work) {
    try {
      work();
    } catch (nb::python_error& error) {
      std::string message = nb::cast<std::string>(nb::str(error.value()));
      message =
          nb::cast<std::string>(error.type().attr("__name__")) + (message.empty() ? "" : ": ") + message;
      std::vector<Diagnostic> list{{Severity::Error, placeOf(error), "", std::move(message), ""}};
      keepRaised(std::move(error));
      throw Error(ExitCode::BadInput, std::move(list));
    }
  }

  std::vector<std::string> parameters_;
  nb::object object_;
};

void addHostPass(const std::string& type, const std::string& declaration, const std::string& source) {
  graph::PassDeclaration declared = graph::hostPass(type, declaration, source);
  std::vector<std::string> parameters;
  for (const graph::ParameterSpec& p : declared.parameters) parameters.push_back(p.name);
  const std::lock_guard lock(registryMutex());
  graph::addPass(std::move(declared),
                 [type, parameters] { return std::make_unique<PythonPass>(type, parameters); });
}

std::string directionOf(const graph::PortSpec& port) {
  switch (port.direction) {
    case graph::Direction::Input:
      return port.optional ? "optional input" : "input";
    case graph::Direction::InOut:
      return "updated";
    case graph::Direction::Output:
      return "output";
    case graph::Direction::Scratch:
      return "scratch";
  }
  return {};
}

}  // namespace

void addPasses(nb::module_& module) {
  nb::class_<graph::PassDeclaration>(module, "PassType", "What a pass type is; `fovea.passes()` lists them.")
      .def_ro("type", &graph::PassDeclaration::type)
      .def_ro("doc", &graph::PassDeclaration::doc)
      .def_prop_ro(
          "host", [](const graph::PassDeclaration& d) { return d.kind == graph::PassKind::Host; },
          "whether it runs on the CPU")
      .def_prop_ro(
          "ports",
          [](const graph::PassDeclaration& d) {
            std::vector<std::tuple<std::string, std::string, std::string>> ports;
            for (const graph::PortSpec& port : d.ports)
              ports.emplace_back(port.name, directionOf(port), port.doc);
            return ports;
          },
          "name, direction and documentation of each port")
      .def_prop_ro(
          "parameters",
          [](const graph::PassDeclaration& d) {
            std::vector<std::tuple<std::string, graph::Value, std::string>> parameters;
            for (const graph::ParameterSpec& p : d.parameters)
              parameters.emplace_back(p.name, p.defaultValue, p.doc);
            return parameters;
          },
          "name, default and documentation of each parameter")
      .def_prop_ro(
          "counters",
          [](const graph::PassDeclaration& d) {
            std::vector<std::pair<std::string, std::string>> counters;
            for (const graph::CounterSpec& c : d.counters) counters.emplace_back(c.name, c.doc);
            return counters;
          },
          "name and documentation of each counter")
      .def("__repr__",
           [](const graph::PassDeclaration& d) { return "<pass " + d.type + ": " + d.doc + ">"; });
  module.def(
      "passes",
      [] {
        const std::lock_guard lock(registryMutex());
        return graph::passTypes();
      },
      nb::rv_policy::reference, "Every pass type, sorted by name.");
  module.def(
      "add_passes",
      [](const std::string& folder) {
        const std::lock_guard lock(registryMutex());
        graph::addPasses(folder);
        graph::rereadPasses();
        Device::rereadShaders();
      },
      "folder"_a, nb::call_guard<nb::gil_scoped_release>());
  module.def(
      "load_plugin",
      [](const std::string& file) {
        const std::lock_guard lock(registryMutex());
        graph::loadPlugin(file);
      },
      "file"_a, nb::call_guard<nb::gil_scoped_release>());
  module.def("add_host_pass", &addHostPass, "type"_a, "declaration"_a, "source"_a,
             nb::call_guard<nb::gil_scoped_release>());

  nb::class_<PassFrame>(module, "PassFrame",
                        "A frame as a pass on the CPU sees it, while its `execute` runs.")
      .def(
          "input",
          [](nb::handle self, const std::string& port) {
            graph::HostContext& context = nb::cast<PassFrame&>(self).context();
            return readView(context.desc(port), context.input(port), self);
          },
          "port"_a, nb::sig("def input(self, port: str) -> numpy.typing.NDArray[typing.Any]"),
          "An input: (layers,) height x width x channels in the type of its texels, or the bytes of a "
          "buffer. It is a\n"
          "view of memory that is used again after `execute`: copy what is needed later. Light is as passes "
          "store it,\n"
          "`pre_exposure` times as bright as in the scene.")
      .def(
          "output",
          [](nb::handle self, const std::string& port) {
            graph::HostContext& context = nb::cast<PassFrame&>(self).context();
            return writeView(context.desc(port), context.output(port), self);
          },
          "port"_a, nb::sig("def output(self, port: str) -> numpy.typing.NDArray[typing.Any]"),
          "An output, to be filled as a whole; otherwise as `input`.")
      .def(
          "has", [](const PassFrame& f, const std::string& port) { return f.context().has(port); }, "port"_a,
          "Whether an optional input is wired.")
      .def(
          "counter",
          [](PassFrame& f, const std::string& name, double value) { f.context().counter(name, value); },
          "name"_a, "value"_a, "Sets a counter of the pass.")
      .def(
          "progress", [](PassFrame& f, double share) { return f.context().progress(share); }, "share"_a,
          "Reports the share of the work that is done, 0 to 1. If it returns False, finish soon with what "
          "there is.")
      .def_prop_ro("parameters", &PassFrame::parameters, "values by name")
      .def_prop_ro(
          "index", [](const PassFrame& f) { return f.frame().index; }, "number of the frame")
      .def_prop_ro(
          "time", [](const PassFrame& f) { return f.frame().time; }, "of the scene, in seconds")
      .def_prop_ro("seed", [](const PassFrame& f) { return f.frame().seed; })
      .def_prop_ro(
          "first", [](const PassFrame& f) { return f.context().firstFrame(); },
          "whether what is kept was just zeroed")
      .def_prop_ro(
          "gaze", [](const PassFrame& f) { return f.context().view().gaze; },
          "normalised image coordinates, origin top-left")
      .def_prop_ro(
          "exposure", [](const PassFrame& f) { return f.frame().storedExposure(); },
          "factor from light as passes store it to what is displayed")
      .def_prop_ro(
          "pre_exposure", [](const PassFrame& f) { return f.frame().preExposure; },
          "factor from radiance to light as passes store it");
}

}  // namespace fovea::python
