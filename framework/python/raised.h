// Exceptions of Python that pass through the framework, which knows only its own.
#pragma once

#include <nanobind/nanobind.h>

namespace fovea::python {

// Keeps an exception until the Error to which it leads reaches Python, whose cause it becomes. Needs the GIL.
void keepRaised(nanobind::python_error&& error);
// Throws the exception that was kept on this thread, if a frame has finished in spite of it. Needs the GIL.
void rethrowRaised();

}  // namespace fovea::python
