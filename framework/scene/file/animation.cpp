// The part of scene files that selects which of a model's animations plays, how fast, and what comes after its end.
#include <algorithm>

#include "framework/scene/file/reader.h"

namespace fovea::scene {

using json::ObjectReader;
using json::Value;

namespace {

void readWhich(ObjectReader& r, std::string_view key, AnimationChoice& choice) {
  const Value* v = r.find(key);
  if (!v) return;
  if (v->isBool() && !v->boolean)
    choice.none = true;
  else if (v->isInt())
    choice.index = r.integer(key, 0, 0, 1 << 20);
  else if (v->isString())
    choice.name = r.text(key);
  else
    mistake(r, key, "expected the name or the number of an animation, or false for none");
}

}  // namespace

void readAnimation(ObjectReader& r, AnimationChoice& choice) {
  const Value* v = r.find("animation");
  if (!v) return;
  choice.where = v->where.location();
  choice.path = r.pathOf("animation");
  if (!v->isObject()) return readWhich(r, "animation", choice);
  ObjectReader a(*v, choice.path, r.diagnostics());
  readWhich(a, "name", choice);
  choice.speed = float(a.number("speed", 1, 1e-3, 1e3));
  const std::string repeat = a.choice("repeat", "loop", {"once", "loop", "back_and_forth"});
  choice.repeat = repeat == "once"             ? Repeat::Once
                  : repeat == "back_and_forth" ? Repeat::PingPong
                                               : Repeat::Loop;
  a.finish();
}

void chooseAnimation(Scene& model, const AnimationChoice& choice, Diagnostics& errors) {
  if (choice.path.empty()) return;
  std::vector<Animation>& list = model.animations;
  for (Animation& a : list) a.plays = false;
  if (choice.none) return;
  size_t found = size_t(choice.index.value_or(0));
  if (!choice.name.empty()) {
    std::vector<std::string> names;
    for (const Animation& a : list) names.push_back(a.name);
    found = size_t(std::find(names.begin(), names.end(), choice.name) - names.begin());
    if (found == names.size()) {
      const std::string nearest = nearestName(choice.name, names);
      std::string all;
      for (const std::string& n : names) all += (all.empty() ? "it has: " : ", ") + n;
      return errors.error(choice.where, choice.path, "the model has no animation `" + choice.name + "`",
                          nearest.empty() ? all : "did you mean `" + nearest + "`?");
    }
  }
  if (found >= list.size())
    return errors.error(choice.where, choice.path,
                        "the model has " + std::to_string(list.size()) + " animations; they count from 0");
  list[found].plays = true;
  list[found].speed = choice.speed;
  list[found].repeat = choice.repeat;
}

}  // namespace fovea::scene
