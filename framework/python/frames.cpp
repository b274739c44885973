// The results of a frame: arrays of its outputs, times and counters.
#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "framework/python/arrays.h"
#include "framework/python/frames.h"
#include "framework/python/module.h"

namespace fovea::python {

namespace nb = nanobind;
using namespace nb::literals;

namespace {

const graph::OutputData& outputOf(const Frame& frame, const std::string& name) {
  const auto found = frame.result.outputs.find(name);
  if (found == frame.result.outputs.end()) throw nb::key_error(name.c_str());
  return found->second;
}

std::vector<std::string> namesOf(const Frame& frame) {
  std::vector<std::string> names;
  for (const auto& [name, output] : frame.result.outputs) names.push_back(name);
  return names;
}

}  // namespace

void addFrames(nb::module_& module) {
  nb::class_<Times>(module, "Times", "What a pass took in a frame, in milliseconds.")
      .def_ro("name", &Times::name, "of the pass")
      .def_ro("gpu_ms", &Times::gpuMs, "between the timestamps around the pass")
      .def_ro("cpu_ms", &Times::cpuMs, "spent on recording it or, for a pass on the CPU, on executing it")
      .def_ro("steps", &Times::steps, "its steps, and the time of each on the device in milliseconds");
  nb::class_<Frame>(module, "FrameResult", "A finished frame; use `fovea.Frame`.")
      .def_prop_ro("index", [](const Frame& f) { return f.result.frame; })
      .def_prop_ro("gpu_ms", [](const Frame& f) { return f.result.gpuMs; })
      .def_prop_ro("cpu_ms", [](const Frame& f) { return f.result.cpuMs; })
      .def_prop_ro("wall_ms", [](const Frame& f) { return f.result.wallMs; })
      .def_ro("passes", &Frame::passes)
      .def_prop_ro("counters", [](const Frame& f) { return f.result.counters; })
      .def("names", &namesOf, "of what was read back")
      .def(
          "element", [](const Frame& f, const std::string& name) { return outputOf(f, name).desc.element; },
          "name"_a, "Type of the elements of a buffer; \"\" for an image.")
      .def(
          "stride", [](const Frame& f, const std::string& name) { return outputOf(f, name).desc.stride; },
          "name"_a, "Bytes of an element of a buffer.")
      .def(
          "beyond_range",
          [](const Frame& f, const std::string& name) { return outputOf(f, name).beyondRange; }, "name"_a,
          "Texels whose light is no number, or too bright for the format in which it is stored.")
      .def(
          "array",
          [](nb::handle self, const std::string& name) {
            const graph::OutputData& output = outputOf(nb::cast<const Frame&>(self), name);
            return floatView(output.desc, output.bytes, self);
          },
          "name"_a, nb::sig("def array(self, name: str) -> numpy.typing.NDArray[typing.Any]"),
          "An output; raises KeyError if it was not read back.");
}

}  // namespace fovea::python
