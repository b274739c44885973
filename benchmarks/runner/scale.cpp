#include "benchmarks/runner/scale.h"

#include <algorithm>

#include "framework/session/inputs.h"

namespace fovea::bench {
namespace {

using json::ObjectReader;
using json::Value;

Scale readScale(const Value& value, const std::string& path, Diagnostics& messages) {
  Scale scale;
  ObjectReader r(value, path, messages);
  if (const Value* size = r.find("size")) {
    try {
      if (size->isString()) session::parseSize(size->string), scale.size = size->string;
    } catch (const Error&) {  // reported below, with its place
    }
    if (!scale.size)
      messages.error(size->where.location(), r.pathOf("size"),
                     "expected a size like \"256x256\", found " + size->describe());
  }
  const auto count = [&](const char* key, int64_t min, int64_t max) {
    return r.find(key) ? std::optional(uint32_t(r.integer(key, min, min, max))) : std::nullopt;
  };
  scale.seeds = count("seeds", 1, 1000);
  scale.spp = count("spp", 2, 1'000'000);
  scale.maxFrames = count("max_frames", 2, 1'000'000).value_or(Scale::kNoLimit);
  scale.maxWarmup = count("max_warmup", 0, 1'000'000).value_or(Scale::kNoLimit);
  scale.maxValues = count("max_values", 2, 1000).value_or(Scale::kNoLimit);
  if (const Value* scenes = r.array("scenes"))
    for (const Value& scene : scenes->items) {
      if (scene.isString() && !scene.string.empty()) {
        scale.scenes.push_back(scene.string);
      } else {
        messages.error(scene.where.location(), r.pathOf("scenes"),
                       "expected a name, found " + scene.describe());
      }
    }
  r.finish();
  return scale;
}

}  // namespace

std::vector<std::pair<std::string, Scale>> readScales(ObjectReader& suite, Diagnostics& messages) {
  std::vector<std::pair<std::string, Scale>> scales;
  const Value* object = suite.object("scales");
  if (!object) return scales;
  for (const json::Member& member : object->members) {
    const std::string path = suite.pathOf("scales") + "." + member.key;
    if (member.value.isObject()) {
      scales.emplace_back(member.key, readScale(member.value, path, messages));
    } else {
      messages.error(member.value.where.location(), path,
                     "expected an object, found " + member.value.describe());
    }
  }
  return scales;
}

void checkScale(const std::string& scale, const std::vector<std::string>& known, const std::string& suite) {
  if (std::find(known.begin(), known.end(), scale) != known.end()) return;
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  throw Error(ExitCode::Usage, "the suite `" + suite + "` has no scale `" + scale + "`",
              list.empty() ? "it has no scales; leave out --scale" : "its scales are " + list);
}

}  // namespace fovea::bench
