#include <fnmatch.h>

#include <filesystem>

#include "benchmarks/runner/suite.h"

namespace fovea::bench {

std::string Job::name() const {
  std::string text = sweep + "-" + std::filesystem::path(scene).stem().string() + "-" + label;
  for (const auto& [key, value] : varied) text += "-" + key + "=" + value;
  for (char& c : text)
    if (c == '/' || c == ' ' || c == '*' || c == '?') c = '_';
  return text + "-s" + std::to_string(seed);
}

nlohmann::ordered_json Job::json() const {
  nlohmann::ordered_json parameters = nlohmann::ordered_json::object(), axes = parameters;
  for (const auto& [key, value] : set) parameters[key] = value;
  for (const auto& [key, value] : varied) axes[key] = value;
  nlohmann::ordered_json measures = nlohmann::ordered_json::array({"time"});
  if (error) measures.push_back("error");
  if (temporal) measures.push_back("temporal");
  if (eyes) measures.push_back("eyes");
  if (pictures) measures.push_back("pictures");
  nlohmann::ordered_json all = {{"sweep", sweep},           {"scene", scene},    {"graph", graph},
                                {"label", label},           {"set", parameters}, {"varied", axes},
                                {"size", {size.x, size.y}}, {"first", first},    {"frames", frames},
                                {"warmup", warmup},         {"seed", seed},      {"frame_rate", frameRate},
                                {"measures", measures}};
  if (needsReference()) all["reference"] = {{"spp", spp}, {"depth", depth}};
  if (layer != "radiance") all["layer"] = layer;
  if (match)
    all["match"] = {{"parameter", match->parameter}, {"like", match->like}, {"like_set", match->likeSet},
                    {"measure", match->measure},     {"from", match->from}, {"to", match->to}};
  return all;
}

bool matchesGlob(std::string_view pattern, std::string_view name) {
  if (pattern.find_first_of("*?") == pattern.npos) return name.find(pattern) != name.npos;
  return fnmatch(std::string(pattern).c_str(), std::string(name).c_str(), FNM_NOESCAPE) == 0;
}

}  // namespace fovea::bench
