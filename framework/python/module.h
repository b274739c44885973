// The parts of the module `fovea._core`. Each function adds the classes and functions of one file.
#pragma once

#include <nanobind/nanobind.h>

namespace fovea::python {

void addErrors(nanobind::module_& module);
void addGraphs(nanobind::module_& module);
void addScenes(nanobind::module_& module);
void addPasses(nanobind::module_& module);
void addFrames(nanobind::module_& module);
void addSessions(nanobind::module_& module);
void addImages(nanobind::module_& module);

}  // namespace fovea::python
