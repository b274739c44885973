#include "framework/scene/load.h"

#include "framework/scene/builtin/builtin.h"

namespace fovea::scene {

std::vector<std::string> builtinNames() { return {"cornellbox"}; }

Scene builtin(const std::string& name) {
  if (name == "cornellbox") return cornellBox();
  const std::string nearest = nearestName(name, builtinNames());
  throw Error(ExitCode::BadInput, "there is no built-in scene `" + name + "`",
              nearest.empty() ? "the built-in scenes are: cornellbox" : "did you mean `" + nearest + "`?");
}

}  // namespace fovea::scene
