// The built-in scenes that the process knows.
#include <algorithm>

#include "fovea/scene.h"

namespace fovea::scene {

namespace {

struct Generator {
  std::string name;
  Scene (*make)();
};

// Inside a function because registrations run before main() in an unspecified order.
std::vector<Generator>& generators() {
  static std::vector<Generator> list;
  return list;
}

}  // namespace

Registration::Registration(const char* name, Scene (*make)()) {
  std::vector<Generator>& list = generators();
  const auto place = std::lower_bound(list.begin(), list.end(), std::string_view(name),
                                      [](const Generator& g, std::string_view n) { return g.name < n; });
  list.insert(place, {name, make});
}

std::vector<std::string> builtinNames() {
  std::vector<std::string> names;
  for (const Generator& g : generators()) names.push_back(g.name);
  return names;
}

Scene builtin(const std::string& name) {
  std::string list;
  for (const Generator& g : generators()) {
    if (name == g.name) return g.make();
    list += (list.empty() ? "" : ", ") + g.name;
  }
  if (list.empty()) list = "none, as the program does not call fovea::scenes::registerAll()";
  const std::string nearest = nearestName(name, builtinNames());
  throw Error(ExitCode::BadInput, "there is no built-in scene `" + name + "`",
              nearest.empty() ? "the built-in scenes are: " + list : "did you mean `" + nearest + "`?");
}

}  // namespace fovea::scene
