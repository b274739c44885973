#include "framework/graph/edit/format.h"

#include <algorithm>
#include <initializer_list>

#include "framework/base/json.h"

namespace fovea::graph {
namespace {

// Known keys first, in this order; others stay behind them as they were.
void order(json::Value& object, std::initializer_list<std::string_view> keys) {
  std::ranges::stable_sort(object.members, {}, [&](const json::Member& member) {
    return std::ranges::find(keys, std::string_view(member.key)) - keys.begin();
  });
}

}  // namespace

std::string formatText(std::string_view text, std::string_view file) {
  json::Value document = json::parse(text, file);
  order(document, {"$schema", "version", "description", "extends", "view", "parameters", "inputs", "passes",
                   "outputs"});
  for (json::Member& part : document.members)
    if (part.key == "passes")
      for (json::Member& pass : part.value.members)
        order(pass.value, {"comment", "type", "graph", "view", "parameters", "inputs", "params"});
  return json::print(document);
}

}  // namespace fovea::graph
