// Errors as exceptions: fovea.Error with everything that a Diagnostic says.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <utility>

#include "fovea/error.h"
#include "framework/python/module.h"
#include "framework/python/raised.h"

namespace fovea::python {

namespace nb = nanobind;

namespace {

thread_local nb::python_error* raised = nullptr;

// Raises fovea.Error, with the exception of a pass in Python as its cause if there was one. Ctrl-C stays what it is.
void raise(const Error& error) {
  if (raised && raised->matches(PyExc_KeyboardInterrupt)) {
    raised->restore();
    delete std::exchange(raised, nullptr);
    return;
  }
  const nb::object type = nb::module_::import_("fovea.errors").attr("Error");
  const nb::object made = type(error.what(), error.code(), error.diagnostics());
  if (raised) {
    PyException_SetCause(made.ptr(), nb::borrow(raised->value()).release().ptr());
    delete std::exchange(raised, nullptr);
  }
  PyErr_SetObject(type.ptr(), made.ptr());
}

void translate(const std::exception_ptr& exception, void*) {
  try {
    std::rethrow_exception(exception);
  } catch (const Error& error) {
    raise(error);
  }
}

}  // namespace

void keepRaised(nb::python_error&& error) {
  delete std::exchange(raised, new nb::python_error(std::move(error)));
}

void rethrowRaised() {
  if (!raised) return;
  const std::unique_ptr<nb::python_error> kept(std::exchange(raised, nullptr));
  throw nb::python_error(*kept);
}

void addErrors(nb::module_& module) {
  nb::enum_<ExitCode>(module, "ExitCode", "What kind of error it is: the exit code of the program `fovea`.")
      .value("INTERNAL", ExitCode::Internal, "a defect of fovea itself or of a pass")
      .value("USAGE", ExitCode::Usage, "a wrong argument")
      .value("BAD_INPUT", ExitCode::BadInput, "a graph, scene, image or shader that cannot be used")
      .value("NO_DEVICE", ExitCode::NoDevice, "no Vulkan device, or one that lacks a required feature")
      .value("OUT_OF_MEMORY", ExitCode::OutOfMemory, "device or host memory exhausted")
      .value("DEVICE_LOST", ExitCode::DeviceLost, "the device stopped working")
      .value("CANNOT_WRITE", ExitCode::CannotWrite, "a file could not be written")
      .value("SLOWER", ExitCode::Slower, "something became slower than the baseline")
      .value("INTERRUPTED", ExitCode::Interrupted, "Ctrl-C");
  nb::enum_<Severity>(module, "Severity", "How much a message weighs.")
      .value("NOTE", Severity::Note)
      .value("WARNING", Severity::Warning)
      .value("ERROR", Severity::Error);
  nb::class_<Diagnostic>(module, "Diagnostic", "A message: what is wrong, where, and what to do about it.")
      .def_ro("severity", &Diagnostic::severity)
      .def_prop_ro(
          "file", [](const Diagnostic& d) { return d.where.file; }, "\"\" if there is none")
      .def_prop_ro(
          "line", [](const Diagnostic& d) { return d.where.line; }, "from 1; 0 if unknown")
      .def_prop_ro(
          "column", [](const Diagnostic& d) { return d.where.column; }, "from 1; 0 if unknown")
      .def_ro("path", &Diagnostic::path, "place in the document: \"passes.blur.params.radius\"")
      .def_ro("message", &Diagnostic::message, "what is wrong")
      .def_ro("remedy", &Diagnostic::remedy, "what to do about it, or \"\"")
      .def("__str__", &Diagnostic::format);
  nb::register_exception_translator(translate);
}

}  // namespace fovea::python
