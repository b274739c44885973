// The module `fovea._core`: the facade as Python sees it. The package around it, in the folder `fovea`, is what users
// import.
#include "framework/python/module.h"

#include "fovea/passes.h"
#include "fovea/registration.h"
#include "fovea/scenes.h"

NB_MODULE(_core, module) {
  module.doc() = "The facade of fovea in C++; import `fovea` instead.";
  module.attr("version") = std::string(fovea::kVersion).c_str();
  fovea::passes::registerAll();
  fovea::scenes::registerAll();
  fovea::python::addErrors(module);
  fovea::python::addGraphs(module);
  fovea::python::addScenes(module);
  fovea::python::addPasses(module);
  fovea::python::addFrames(module);
  fovea::python::addSessions(module);
  fovea::python::addImages(module);
}
